#include "engine/equilibrium/refine.hpp"

namespace flyball {

void refine(const Problem& problem, Unknowns& z, const NewtonOutcome& outcome, Workspace& w,
            Eigen::VectorXd& error) {
  const System& system = problem.system;
  error.setZero(system.nv);
  if (system.nv == 0) return;
  double previous = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    w.q_long = z.q.cast<long double>();
    w.lambda_long.setZero(system.rows);
    forward<long double>(system, problem.parameters, w.q_long, 0, w.kinematics_long);
    evaluate_residual<long double>(system, problem.parameters, w.q_long, w.lambda_long, w.kinematics_long,
                                   w.residual_long);
    // With multipliers solved for whole: what they cannot balance is what counts.
    w.residual.f = w.residual_long.f.cast<double>();
    w.residual.phi = w.residual_long.phi.cast<double>();
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, z.lambda);
    if (!w.scaled_step.allFinite()) break;
    w.step = w.scaled_step.cwiseProduct(problem.scaling.column);
    const double size = w.scaled_step.lpNorm<Eigen::Infinity>();
    error = w.step.cwiseAbs();
    if (size > 0.5 * previous) break; // no longer contracting: rounding, or a singular state
    retract<double>(system, w.step, z.q);
    previous = size;
    if (size < 1e-13) break;
  }
  if (outcome.linear) // about a singular state the error is of the size of the last step
    error = error.cwiseMax(2 * outcome.last_step * problem.scaling.column);
  // Corrections carry the rounding of the residual that they come from.
  error += 16 * static_cast<double>(std::numeric_limits<long double>::epsilon()) * problem.scaling.column;
  for (const Link& link : system.links) {
    if (link.v < 0) continue;
    const int n = link.type == LinkType::spherical ? 3 : 1;
    for (int k = 0; k < n; ++k) {
      const double value = n == 3 ? 1 : std::abs(z.q[link.q]);
      error[link.v + k] += 2 * std::numeric_limits<double>::epsilon() * value;
    }
  }
}

} // namespace flyball
