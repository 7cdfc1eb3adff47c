#include "engine/solve/existence.hpp"

#include "engine/system/drive_rates.hpp"
#include "engine/system/implied_rates.hpp"
#include "engine/system/kept_momentum.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Evaluates the balance without multipliers at a phase and factors the constraints there.
void evaluate_phase(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  w.zero_lambda.setZero(problem.system.rows);
  Unknowns z{q, w.zero_lambda};
  evaluate(problem, z, t, w);
  factor_constraints(problem, w);
}

// Whether something acts along the coordinates of drives left to themselves.
void judge_momenta(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w,
                   Existence& result) {
  evaluate_phase(problem, q, t, w);
  Unknowns z{q, w.zero_lambda};
  if (problem.system.rows > 0) {
    best_multipliers(problem, w, z.lambda);
    evaluate(problem, z, t, w);
  }
  for (Eigen::Index i = 0; i < w.residual.taken.size(); ++i) {
    const double left = std::abs(w.residual.taken[i]), size = w.magnitudes.taken[i];
    if (left <= tolerance::phase_balance * size || left <= result.violation * size) continue;
    result = {false, false, t, left / size, -1, std::max(result.left, left / size), static_cast<int>(i)};
  }
}

} // namespace

int rubbing_link(const System& system, const Parameters& p) {
  for (const DrivenCoordinate& d : system.drives) // springs and stops would not settle there
    if (finds_speed(system.links[static_cast<std::size_t>(d.link)]) &&
        p.links[static_cast<std::size_t>(d.link)].elastic)
      return d.link;
  return -1;
}

std::vector<double> sample_phases(const System& system, const Parameters& p, const Eigen::VectorXd& q) {
  if (p.phase_free) return {};
  return phase_times(drive_rates(system, p, q));
}

Existence check_existence(const Problem& problem, const Eigen::VectorXd& q, const std::vector<double>& phases,
                          Workspace& w) {
  Existence result;
  if (const int link = rubbing_link(problem.system, problem.parameters); link >= 0)
    return {.holds = false, .rubs = link};
  if (keeps_momentum(problem.system)) judge_momenta(problem, q, 0, w, result);
  if (phases.empty()) return result;
  const std::vector<DriveRate> rates = drive_rates(problem.system, problem.parameters, q);
  for (double t : phases) {
    // What rounding makes of angles after many turns.
    const double rounding = std::max(0., 4 * angle_rounding(rates, t) - tolerance::phase_rounding);
    const double least = tolerance::phase_balance + rounding;
    evaluate_phase(problem, q, t, w);
    set_closures(problem.system, problem.parameters, q, w.kinematics, w.residual.phi);
    for (std::size_t c = 0; c < problem.system.cuts.size(); ++c) {
      const CutJoint& cut = problem.system.cuts[c];
      for (std::size_t r = 0; r < cut.rows.size(); ++r) {
        const auto row = static_cast<Eigen::Index>(cut.first_row) + static_cast<Eigen::Index>(r);
        const double open = std::abs(w.residual.phi[row]) * problem.scaling.row[row];
        result.left = std::max(result.left, open - rounding);
        if (open <= least || (result.loops_open && open <= result.violation)) continue;
        result = {false, true, t, open, static_cast<int>(c), result.left};
      }
    }
    if (result.loops_open) continue;
    w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
    const auto judge = [&](double left, double size) {
      if (left > 0) result.left = std::max(result.left, left / size - rounding);
      if (left > least * size && left / size > result.violation)
        result = {false, false, t, left / size, -1, result.left};
    };
    if (problem.system.rows > 0) { // with the multipliers that do best
      Unknowns z{q, {}};
      best_multipliers(problem, w, z.lambda);
      evaluate(problem, z, t, w);
      w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
    }
    for (Eigen::Index i = 0; i < w.residual.taken.size(); ++i)
      judge(std::abs(w.residual.taken[i]), w.magnitudes.taken[i]);
    for (Eigen::Index k = 0; k < w.scaled_force.size(); ++k)
      judge(std::abs(w.scaled_force[k]), w.magnitudes.force[k] * problem.scaling.column[k]);
  }
  return result;
}

Eigen::VectorXd phase_variation(const Problem& problem, const Unknowns& z, const std::vector<double>& phases,
                                Workspace& w) {
  Eigen::VectorXd most = Eigen::VectorXd::Zero(problem.system.nv);
  Unknowns there{z.q, {}};
  for (double t : phases) {
    evaluate_phase(problem, z.q, t, w);
    best_multipliers(problem, w, there.lambda);
    evaluate(problem, there, t, w);
    factor(problem, there, w);
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
    most = most.cwiseMax(w.scaled_step.cwiseProduct(problem.scaling.column).cwiseAbs());
  }
  return 2 * most;
}

} // namespace flyball
