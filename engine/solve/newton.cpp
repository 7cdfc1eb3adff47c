#include "engine/solve/newton.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/system/constraint_row.hpp"

namespace flyball {
namespace {

void apply_step(const Problem& problem, const Eigen::VectorXd& scaled_step, double fraction,
                Eigen::VectorXd& q, Workspace& w) {
  w.step = fraction * scaled_step.cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, w.step, q);
}

// The largest rounding of a coordinate, scaled.
double resolution(const Problem& problem, const Eigen::VectorXd& q) {
  double largest = 0;
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type == LinkType::prismatic)
      largest = std::max(largest, std::abs(q[link.q]) / problem.scaling.column[link.v]);
  return 8 * std::numeric_limits<double>::epsilon() * largest;
}

// What is left of the force balance when the best multipliers have been found; f is without constraint
// forces.
double merit(const Problem& problem, Workspace& w) {
  w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
  double sum = 0;
  const double size = largest(w.magnitudes.force.cwiseProduct(problem.scaling.column));
  w.kkt(problem).project(w.scaled_force, w.projected);
  sum += std::max(0., w.projected.dot(w.scaled_force)) / std::max(size * size, 1e-300);
  sum += w.residual.phi.cwiseProduct(problem.scaling.row).squaredNorm();
  return std::sqrt(sum);
}

// The balance with the multipliers' forces taken off again.
void take_off_multipliers(const Problem& problem, const Eigen::VectorXd& lambda, Workspace& w) {
  if (problem.system.rows == 0) return;
  const auto take_off = [&](const SystemPart& part, std::size_t) {
    for (const int n : part.cuts) {
      const auto c = static_cast<std::size_t>(n);
      const CutJoint& cut = problem.system.cuts[c];
      for (std::size_t r = 0; r < cut.rows.size(); ++r)
        row_gradient(cut, problem.parameters.cuts[c], cut.rows[r], w.kinematics, [&](int v, double g) {
          w.residual.f[v] -= g * lambda[cut.first_row + static_cast<int>(r)];
        });
    }
  };
  for_parts(problem.system.division, take_off);
  take_off(problem.system.division.between, 0);
}

// After a short step of this size another with the same factors: of sparse equations it costs a fifth of one
// with new factors, and takes an error e^2 on to e^3 (Shamanskii, A modification of Newton's method, 1967).
void step_again(const Problem& problem, double size, Unknowns& z, Workspace& w) {
  newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
  if (!(w.scaled_step.lpNorm<Eigen::Infinity>() < 0.1 * size)) return;
  apply_step(problem, w.scaled_step, 1, z.q, w);
  z.lambda += w.trial.lambda;
  evaluate(problem, z, 0, w);
}

} // namespace

void evaluate(const Problem& problem, const Unknowns& z, double t, Workspace& w) {
  interruption_point();
  forward<double>(problem.system, problem.parameters, z.q, t, w.kinematics);
  evaluate_forces(problem, z, w);
}

void evaluate_forces(const Problem& problem, const Unknowns& z, Workspace& w) {
  evaluate_residual<double>(problem.system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual);
  evaluate_magnitudes(problem.system, problem.parameters, z.q, z.lambda, w.kinematics, w.magnitudes);
}

double scaled_residual(const Problem& problem, const Workspace& w) {
  double worst = 0;
  for (Eigen::Index i = 0; i < w.residual.f.size(); ++i)
    if (w.residual.f[i] != 0) worst = std::max(worst, std::abs(w.residual.f[i]) / w.magnitudes.force[i]);
  for (Eigen::Index i = 0; i < w.residual.phi.size(); ++i)
    worst = std::max(worst, std::abs(w.residual.phi[i]) * problem.scaling.row[i]);
  return std::isfinite(w.residual.f.sum() + w.residual.phi.sum()) ? worst
                                                                  : std::numeric_limits<double>::infinity();
}

void find_step(const Problem& problem, bool whole, Unknowns& z, Workspace& w) {
  if (whole) take_off_multipliers(problem, z.lambda, w);
  newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
  if (whole)
    z.lambda = w.trial.lambda;
  else
    z.lambda += w.trial.lambda;
}

void factor_constraints(const Problem& problem, Workspace& w) {
  w.kkt(problem).factor_constraints(problem, w);
}

int independent_rows(const Problem& problem, Workspace& w) {
  return w.kkt(problem).independent_rows(problem, w);
}

void best_multipliers(const Problem& problem, Workspace& w, Eigen::VectorXd& lambda) {
  w.scaled_force = -w.residual.f.cwiseProduct(problem.scaling.column);
  if (!balance_with_tied_angles(problem, w.kinematics, w.scaled_force, w.scaled_lambda))
    w.kkt(problem).balance(w.scaled_force, w.scaled_lambda);
  lambda = w.scaled_lambda.cwiseProduct(problem.scaling.row);
}

void close(const Problem& problem, Workspace& w, Eigen::VectorXd& scaled_step) {
  w.scaled_phi = -w.residual.phi.cwiseProduct(problem.scaling.row);
  w.kkt(problem).close(w.scaled_phi, scaled_step);
}

void factor(const Problem& problem, const Unknowns& z, Workspace& w) {
  interruption_point();
  KktSystem& kkt = w.kkt(problem);
  kkt.linearize(problem, z, w);
  kkt.factor();
}

void evaluate_with_multipliers(const Problem& problem, Unknowns& z, Workspace& w) {
  z.lambda.setZero(problem.system.rows);
  if (problem.system.rows == 0) return evaluate(problem, z, 0, w);
  forward<double>(problem.system, problem.parameters, z.q, 0, w.kinematics);
  evaluate_residual<double>(problem.system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual);
  factor_constraints(problem, w);
  best_multipliers(problem, w, z.lambda);
  evaluate_forces(problem, z, w);
}

void factor_with_multipliers(const Problem& problem, Unknowns& z, Workspace& w) {
  evaluate_with_multipliers(problem, z, w);
  factor(problem, z, w);
}

void newton_step(const Problem& problem, const Eigen::VectorXd& f, const Eigen::VectorXd& phi, Workspace& w,
                 Eigen::VectorXd& scaled_step, Eigen::VectorXd& lambda) {
  w.scaled_force = -f.cwiseProduct(problem.scaling.column);
  w.scaled_phi = -phi.cwiseProduct(problem.scaling.row);
  w.kkt(problem).solve(w.scaled_force, w.scaled_phi, scaled_step, w.scaled_lambda);
  lambda = w.scaled_lambda.cwiseProduct(problem.scaling.row);
}

NewtonOutcome newton(const Problem& problem, Unknowns& z, Workspace& w, const NewtonSettings& settings,
                     std::vector<double>* history) {
  NewtonOutcome outcome;
  KktSystem& kkt = w.kkt(problem);
  w.zero_lambda.setZero(problem.system.rows);
  if (settings.to_minimum) // what loops carry decides whether the potential falls
    evaluate_with_multipliers(problem, z, w);
  else if (!settings.factored)
    evaluate(problem, z, 0, w);
  double previous_step = 0;
  bool contracts = false;
  for (int i = 0;; ++i) {
    const double residual = scaled_residual(problem, w);
    if (history) history->push_back(residual);
    outcome.iterations = i;
    if (outcome.converged || i >= settings.max_iterations || !std::isfinite(residual) || problem.cancelled())
      break;
    if (i > 0 || !settings.factored) factor(problem, z, w);
    if (settings.proximal > 0) kkt.factor(settings.proximal);
    if (!kkt.known()) break;
    // At an unstable equilibrium it stays, to say so.
    if (settings.to_minimum && residual > tolerance::near_balance && kkt.negative_count() > 0) {
      outcome.falls = true;
      break;
    }
    w.trial.q = z.q;
    // Multipliers of redundant rows should be those of the state alone where few coordinates allow it: at a
    // singular pose of the loops the verdict on stability rests on them.
    find_step(problem, !contracts || problem.form == KktForm::dense, z, w);
    const double size = w.scaled_step.size() > 0 ? w.scaled_step.lpNorm<Eigen::Infinity>() : 0;
    if (!std::isfinite(size) || size > tolerance::farthest) break;
    if (settings.to_minimum && size > tolerance::near_balance && kkt.negative_count() > 0) break;
    if (settings.impatient && i >= 3 && size > 1 && size > 0.5 * previous_step) break;
    double fraction = 1;
    if (settings.damped && size > 0) { // without a step no part of it is better
      kkt.complete_constraints(problem, w);
      const double start = merit(problem, w);
      for (;; fraction /= 2) {
        z.q = w.trial.q;
        apply_step(problem, w.scaled_step, fraction, z.q, w);
        Unknowns probe{z.q, w.zero_lambda};
        evaluate(problem, probe, 0, w);
        factor_constraints(problem, w);
        const double now = merit(problem, w);
        if (now <= (1 - tolerance::sufficient_decrease * fraction) * start ||
            now < tolerance::merit_rounding || fraction < tolerance::least_fraction)
          break;
      }
      if (fraction < tolerance::least_fraction && size > tolerance::step) break;
    } else {
      apply_step(problem, w.scaled_step, 1, z.q, w);
    }
    outcome.largest_step = std::max(outcome.largest_step, fraction * size);
    outcome.last_step = size;
    evaluate(problem, z, 0, w);
    // From below that the next step is the last, and at rounding.
    const bool short_step = size < tolerance::short_step && size > tolerance::last_step;
    if (short_step && kkt.factors_cost_more() && !settings.damped && settings.proximal == 0)
      step_again(problem, size, z, w);
    // So far away only a balance that is as good as linear leads.
    if (size > tolerance::far && !(scaled_residual(problem, w) < tolerance::near_balance)) break;
    const double enough =
        tolerance::step +
        (size > tolerance::far || outcome.largest_step > tolerance::far ? resolution(problem, z.q) : 0);
    const double contraction = previous_step > 0 ? size / (previous_step * previous_step) : 0;
    const bool next_is_none = settings.trusting && previous_step > 0 && size < tolerance::short_step &&
                              size < 0.1 * previous_step &&
                              std::max(1., contraction) * size * size <= tolerance::trusted_error * enough;
    // Along what nothing resists steps stay as long as rounding makes them.
    const bool at_rounding = settings.proximal > 0 && size < tolerance::neutral_step &&
                             scaled_residual(problem, w) < tolerance::proximal_residual;
    if ((size <= enough || next_is_none || at_rounding) && fraction == 1.) {
      // No step is left; but a force that no coordinate resists, or a loop that cannot close, asks for none
      // either.
      const double left = scaled_residual(problem, w);
      if (left > tolerance::balance) break;
      // Where a direction has no stiffness, short steps say nothing of the force along it.
      outcome.converged =
          !kkt.singular() || (left <= tolerance::singular_residual && outcome.largest_step <= tolerance::far);
    } else if (i > 3 && size < tolerance::linear_step && size > 0.3 * previous_step &&
               scaled_residual(problem, w) < tolerance::linear_residual) {
      outcome.converged = outcome.linear = true;
    }
    contracts = size < tolerance::short_step && size < 0.1 * previous_step;
    previous_step = size;
  }
  return outcome;
}

bool assemble(const Problem& problem, Eigen::VectorXd& q, double t, Workspace& w) {
  if (problem.system.rows == 0) return true;
  Unknowns& z = w.closing;
  z.lambda.setZero(problem.system.rows);
  const auto opening = [&](const Eigen::VectorXd& at) {
    z.q = at;
    forward<double>(problem.system, problem.parameters, z.q, t, w.kinematics);
    evaluate_constraints<double>(problem.system, problem.parameters, z.q, w.kinematics, w.residual.phi);
    w.scaled_phi = -w.residual.phi.cwiseProduct(problem.scaling.row);
    return w.scaled_phi.lpNorm<Eigen::Infinity>();
  };
  double open = opening(q);
  for (int i = 0; i < 60; ++i) {
    if (!std::isfinite(open)) return false;
    if (open < tolerance::closed_to_rounding) break;
    factor_constraints(problem, w);
    close(problem, w, w.scaled_step);
    const double size = w.scaled_step.lpNorm<Eigen::Infinity>();
    if (size < tolerance::least_closing_step) break;
    double fraction = std::min(1., 0.5 / size), next = open;
    Eigen::VectorXd& moved = w.moved;
    for (;; fraction /= 2) {
      moved = q;
      apply_step(problem, w.scaled_step, fraction, moved, w);
      next = opening(moved);
      if (next < open || fraction < tolerance::least_closing_fraction) break;
    }
    if (!(next < open)) {
      open = opening(q);
      break;
    }
    q = moved;
    open = next;
  }
  return open < tolerance::closed;
}

} // namespace flyball
