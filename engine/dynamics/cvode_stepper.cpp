#include "engine/dynamics/stepper.hpp"
#include "engine/dynamics/sundials.hpp"

#include <cvode/cvode_ls.h>
#include <cvode/cvode_proj.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <utility>

namespace flyball {
namespace {

// The matrix of the implicit steps is the Ode's own; SUNDIALS is given an empty shell in its place.
int set_up(sundials::Real t, N_Vector y, N_Vector rate, SUNMatrix, sundials::Boolean keep,
           sundials::Boolean* taken, sundials::Real gamma, void* data, N_Vector, N_Vector, N_Vector) {
  Ode& ode = sundials::ode_of(data);
  *taken = keep ? SUNFALSE : SUNTRUE;
  if (!keep && !ode.linearise(t, sundials::data(y), sundials::data(rate))) return sundials::failure(ode);
  return ode.factor(gamma) ? 0 : sundials::failure(ode);
}

SUNMatrix_ID matrix_kind(SUNMatrix) {
  return SUNMATRIX_CUSTOM;
}
SUNLinearSolver_Type solver_type(SUNLinearSolver) {
  return SUNLINEARSOLVER_DIRECT;
}
SUNLinearSolver_ID solver_kind(SUNLinearSolver) {
  return SUNLINEARSOLVER_CUSTOM;
}
int solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, sundials::Real) {
  N_VScale(1, b, x);
  sundials::ode_of(solver->content).solve(sundials::data(x));
  return 0;
}

int project(sundials::Real t, N_Vector y, N_Vector correction, sundials::Real, N_Vector, void* data) {
  Ode& ode = sundials::ode_of(data);
  N_VScale(1, y, correction);
  if (!ode.project(t, sundials::data(correction))) return sundials::failure(ode);
  N_VLinearSum(1, correction, -1, y, correction);
  return 0;
}

std::string cvode_clause(int flag) {
  switch (flag) {
  case CV_ERR_FAILURE: return "no step is short enough for the tolerance";
  case CV_CONV_FAILURE: return "the implicit step finds no solution, however short";
  case CV_RHSFUNC_FAIL:
  case CV_FIRST_RHSFUNC_ERR:
  case CV_REPTD_RHSFUNC_ERR:
  case CV_UNREC_RHSFUNC_ERR: return "the equations of motion have no solution there";
  case CV_PROJFUNC_FAIL:
  case CV_REPTD_PROJFUNC_ERR: return "the loops cannot be kept closed";
  case CV_LSETUP_FAIL: return "the motion's Jacobian is not finite";
  default: return "the integrator stopped (" + std::string(CVodeGetReturnFlagName(flag)) + ")";
  }
}

class CvodeStepper : public Stepper {
 public:
  CvodeStepper(Ode& ode, Integrator method)
      : ode_(ode), adams_(method == Integrator::adams), y_(ode.size(), context_),
        between_(ode.size(), context_), memory_(CVodeCreate(adams_ ? CV_ADAMS : CV_BDF, context_)) {
    if (!memory_) throw std::bad_alloc();
  }
  ~CvodeStepper() override {
    CVodeFree(&memory_);
    if (nonlinear_) SUNNonlinSolFree(nonlinear_);
    if (linear_) SUNLinSolFreeEmpty(linear_);
    if (matrix_) SUNMatFreeEmpty(matrix_);
  }

  void start(double t, const Eigen::VectorXd& y) override {
    y_.view() = y;
    time_ = t;
    if (started_) {
      keep_counts();
      CVodeReInit(memory_, t, y_);
      seen_ = {}; // its counters begin again
      return;
    }
    started_ = true;
    CVodeInit(memory_, sundials::rate, t, y_);
    CVodeSetUserData(memory_, &ode_);
    sundials::silence_cvode(memory_);
    CVodeWFtolerances(memory_, sundials::weights);
    CVodeSetMaxNumSteps(memory_, -1);
    CVodeSetMaxHnilWarns(memory_, -1);
    CVodeSetMaxErrTestFails(memory_, 20);
    CVodeSetMaxConvFails(memory_, 20);
    if (adams_) {
      nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      CVodeSetNonlinearSolver(memory_, nonlinear_);
      CVodeSetMaxNonlinIters(memory_, 10);
    } else {
      matrix_ = SUNMatNewEmpty(context_);
      linear_ = SUNLinSolNewEmpty(context_);
      if (!matrix_ || !linear_) throw std::bad_alloc();
      matrix_->ops->getid = matrix_kind;
      linear_->ops->gettype = solver_type;
      linear_->ops->getid = solver_kind;
      linear_->ops->solve = solve;
      linear_->content = &ode_;
      CVodeSetLinearSolver(memory_, linear_, matrix_);
      CVodeSetLinSysFn(memory_, set_up);
      CVodeSetStabLimDet(memory_, SUNTRUE);
      if (ode_.has_manifold()) {
        CVodeSetProjFn(memory_, project);
        CVodeSetProjErrEst(memory_, SUNFALSE);
      }
    }
    if (ode_.events() > 0) {
      CVodeRootInit(memory_, ode_.events(), sundials::event_values);
      CVodeSetNoInactiveRootWarn(memory_);
    }
  }

  StepOutcome step(double) override {
    // The direction is all that CVODE takes from the time asked for; it must not be too near.
    const double ahead = time_ + 1 + std::abs(time_);
    const int flag = CVode(memory_, ahead, y_, &time_, CV_ONE_STEP);
    StepOutcome out;
    out.time = time_;
    if (flag == CV_ROOT_RETURN) {
      out.kind = StepOutcome::event;
      std::vector<int> found(static_cast<std::size_t>(ode_.events()));
      CVodeGetRootInfo(memory_, found.data());
      for (int i = 0; i < ode_.events(); ++i)
        if (found[static_cast<std::size_t>(i)] != 0) out.events.push_back(i);
    } else if (flag < 0) {
      out.kind = StepOutcome::failed;
      out.message = cvode_clause(flag);
    }
    return out;
  }

  void state_at(double t, Eigen::VectorXd& y) override {
    if (t == time_) {
      y = y_.view();
    } else {
      CVodeGetDky(memory_, t, 0, between_);
      y = between_.view();
    }
  }

  void count(RunStatistics& s) override {
    keep_counts();
    s.steps += counts_.steps;
    s.evaluations += counts_.evaluations;
    s.jacobians += counts_.jacobians;
    s.rejected += counts_.rejected;
    counts_ = {};
  }

 private:
  void keep_counts() {
    if (!started_) return;
    long steps = 0, evaluations = 0, failures = 0, jacobians = 0, unsolved = 0;
    CVodeGetNumSteps(memory_, &steps);
    CVodeGetNumRhsEvals(memory_, &evaluations);
    CVodeGetNumErrTestFails(memory_, &failures);
    CVodeGetNumStepSolveFails(memory_, &unsolved);
    if (!adams_) CVodeGetNumJacEvals(memory_, &jacobians);
    const auto since = [](long now, long& seen) { return now - std::exchange(seen, now); };
    counts_.steps += since(steps, seen_.steps);
    counts_.evaluations += since(evaluations, seen_.evaluations);
    counts_.rejected += since(failures + unsolved, seen_.rejected);
    counts_.jacobians += since(jacobians, seen_.jacobians);
  }

  Ode& ode_;
  bool adams_, started_ = false;
  sundials::Context context_;
  sundials::Vector y_, between_;
  void* memory_;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  double time_ = 0;
  RunStatistics counts_, seen_;
};

} // namespace

std::unique_ptr<Stepper> make_cvode_stepper(Ode& ode, Integrator method) {
  return std::make_unique<CvodeStepper>(ode, method);
}

} // namespace flyball
