#include "engine/dynamics/dormand_prince.hpp"
#include "engine/dynamics/stepper.hpp"
#include "engine/dynamics/sundials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

namespace erk = sundials::erk;

int project(sundials::Real t, N_Vector y, void* data) {
  Ode& ode = sundials::ode_of(data);
  return ode.project(t, sundials::data(y)) ? 0 : sundials::failure(ode);
}

std::string runge_kutta_clause(int flag) {
  switch (flag) {
  case ARK_ERR_FAILURE: return "no step is short enough for the tolerance";
  case ARK_RHSFUNC_FAIL:
  case ARK_FIRST_RHSFUNC_ERR:
  case ARK_REPTD_RHSFUNC_ERR:
  case ARK_UNREC_RHSFUNC_ERR: return "the equations of motion have no solution there";
  case ARK_POSTPROCESS_STEP_FAIL: return "the loops cannot be kept closed";
  default: return "the integrator stopped (" + std::string(erk::flag_name(flag)) + ")";
  }
}

// With a stage more: the state at the end of the step, with which the next one begins. ERKStep of
// SUNDIALS 6.4 takes every method whose last stage is at the end of the step for one where that stage is the
// end, and loses an order with those for which it is not.
void set_method(void* memory) {
  namespace pair = dormand_prince;
  using Table = std::unique_ptr<ARKodeButcherTableMem, decltype(&ARKodeButcherTable_Free)>;
  const Table table(ARKodeButcherTable_Alloc(pair::stages + 1, SUNTRUE), &ARKodeButcherTable_Free);
  if (!table) throw std::bad_alloc();
  table->q = pair::order;
  table->p = pair::order_beside;
  for (std::size_t i = 0; i < pair::stages; ++i) {
    std::ranges::copy(pair::take[i], table->A[i]);
    table->A[pair::stages][i] = table->b[i] = pair::step[i];
    table->c[i] = pair::when[i];
    table->d[i] = pair::step_beside[i];
  }
  table->c[pair::stages] = 1;
  ERKStepSetTable(memory, table.get());
}

class RungeKuttaStepper : public Stepper {
 public:
  RungeKuttaStepper(Ode& ode, double fixed_step)
      : ode_(ode), fixed_(fixed_step), y_(ode.size(), context_), before_(ode.size(), context_) {}
  ~RungeKuttaStepper() override { release(); }

  void start(double t, const Eigen::VectorXd& y) override {
    y_.view() = y;
    if (memory_) {
      erk::reset(memory_, t, y_);
    } else {
      memory_ = ERKStepCreate(sundials::rate, t, y_, context_);
      if (!memory_) throw std::bad_alloc();
      erk::set_user_data(memory_, &ode_);
      sundials::silence_erk(memory_);
      erk::set_weights(memory_, sundials::weights);
      set_method(memory_);
      // The interpolant only finds events; that of degree 3 costs no evaluations.
      if (ode_.events() == 0) erk::set_interpolant_degree(memory_, 3);
      erk::set_most_steps(memory_, -1);
      erk::set_most_warnings(memory_, -1);
      erk::set_most_error_failures(memory_, 30);
      if (fixed_ > 0) erk::set_fixed_step(memory_, fixed_);
      if (ode_.has_manifold()) erk::set_postprocess(memory_, project);
      if (ode_.events() > 0) {
        erk::init_roots(memory_, ode_.events(), sundials::event_values);
        erk::set_no_root_warning(memory_);
      }
    }
    time_ = t;
  }

  StepOutcome step(double stop) override {
    StepOutcome out;
    // Its interpolant is of lower order than its steps, so an event is found with it and then stepped to.
    double end = stop;
    bool landing = false;
    for (;;) {
      const double from = time_;
      if (!landing) before_.view() = y_.view();
      erk::set_stop_time(memory_, end);
      const int flag = erk::evolve(memory_, end, y_, &time_, ARK_ONE_STEP);
      out.time = time_;
      if (flag < 0) {
        out.kind = StepOutcome::failed;
        out.message = runge_kutta_clause(flag);
        return out;
      }
      if (flag == ARK_ROOT_RETURN) {
        std::vector<int> found(static_cast<std::size_t>(ode_.events()));
        erk::roots_found(memory_, found.data());
        out.events.clear();
        for (int i = 0; i < ode_.events(); ++i)
          if (found[static_cast<std::size_t>(i)] != 0) out.events.push_back(i);
        out.kind = StepOutcome::event;
        const bool apart = time_ - from > 4 * std::numeric_limits<double>::epsilon() * std::abs(time_);
        if (landing || !apart) return out;
        landing = true;
        end = time_;
        time_ = from;
        erk::reset(memory_, from, before_);
        continue;
      }
      if (!landing || time_ >= end) return out;
    }
  }

  void state_at(double, Eigen::VectorXd& y) override { y = y_.view(); }

  void count(RunStatistics& s) override {
    if (!memory_) return;
    RunStatistics now;
    erk::steps(memory_, &now.steps);
    ERKStepGetNumRhsEvals(memory_, &now.evaluations);
    erk::error_failures(memory_, &now.rejected);
    s.steps += now.steps - seen_.steps;
    s.evaluations += now.evaluations - seen_.evaluations;
    s.rejected += now.rejected - seen_.rejected;
    seen_ = now;
  }

 private:
  void release() {
    if (memory_) erk::release(&memory_);
  }

  Ode& ode_;
  double fixed_;
  sundials::Context context_;
  sundials::Vector y_, before_;
  void* memory_ = nullptr;
  double time_ = 0;
  RunStatistics seen_;
};

} // namespace

std::unique_ptr<Stepper> make_runge_kutta_stepper(Ode& ode, double fixed_step) {
  return std::make_unique<RungeKuttaStepper>(ode, fixed_step);
}

} // namespace flyball
