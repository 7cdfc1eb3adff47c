#include "engine/stability/stability.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/kink_stability.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/neutral_directions.hpp"
#include "engine/stability/pivot_stability.hpp"
#include "engine/system/dampers.hpp"
#include "engine/system/kept_momentum.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// By the multipliers, of which those of `neutral` directions (a rotation or shift that nothing resists, and
// its rate) lie at 1.
void classify_by_multipliers(const Problem& problem, const Unknowns& z, int neutral, Workspace& w,
                             Stability& out) {
  FloquetOutcome outcome;
  if (problem.system.nv <= largest_for_eigenvalues)
    outcome = find_floquet(problem, z.q, w);
  else
    outcome.failure = FloquetFailure::unresolved;
  if (!outcome.result) {
    out.reason = StabilityReason::varying;
    out.floquet_failure = outcome.failure;
    return;
  }
  const Floquet& floquet = out.floquet.emplace(std::move(*outcome.result));
  out.eigenvalues = floquet_exponents(floquet);
  out.reason = StabilityReason::floquet;
  if (neutral > 0) out.reason = StabilityReason::neutral;
  out.stable = stable_by_multipliers(floquet.multipliers, floquet.error, neutral,
                                     is_hamiltonian(problem.system, problem.parameters));
  if (out.stable == false) out.reason = StabilityReason::floquet;
}

} // namespace

bool may_vary(const Problem& problem, const Unknowns& z, const std::vector<double>& phases, Workspace& w) {
  const System& system = problem.system;
  const bool can_compare = system.nv <= (system.rows > 0 ? 600 : 2000);
  return !phases.empty() && (!can_compare || motion_varies(problem, z.q, phases, w));
}

bool has_potential(const Problem& problem, const Unknowns& z, const Eigen::MatrixXd& k, Workspace& w) {
  if (!problem.system.conservative) return false;
  if (problem.system.single_drives) return true;
  if ((k - k.transpose()).norm() > tolerance::symmetric * k.norm()) return false;
  if (problem.system.nv == 0) return true;
  // Second differences of U + lambda . Phi, whose gradient is f.
  const auto lagrangian = [&](int i, double step) {
    Eigen::VectorXd q = z.q;
    w.step.setZero(problem.system.nv);
    w.step[i] = step * problem.scaling.column[i];
    retract<double>(problem.system, w.step, q);
    forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
    w.zero_lambda.setZero(problem.system.rows);
    evaluate_residual<double>(problem.system, problem.parameters, q, w.zero_lambda, w.kinematics, w.residual);
    const Potential potential = amended_potential(problem.system, problem.parameters, q, w.kinematics);
    return Potential{potential.value + z.lambda.dot(w.residual.phi), potential.magnitude};
  };
  // Steps so long that the rounding of a potential that is large and hardly changes makes h^2 of K.
  const double size = k.norm(), smooth = tolerance::second_difference,
               large = 4 * tolerance::potential_rounding * lagrangian(0, 0).magnitude,
               h = size > 0 ? std::clamp(std::pow(large / size, 0.25), smooth, 0.1) : smooth;
  bool agrees = true;
  for (int i = 0; i < problem.system.nv && agrees; ++i) {
    interruption_point();
    const double second =
        (lagrangian(i, h).value - 2 * lagrangian(i, 0).value + lagrangian(i, -h).value) / (h * h);
    agrees = std::abs(second - k(i, i)) <= (smooth + (h > smooth ? 2 * h * h : 0)) * size;
  }
  return agrees;
}

Stability find_smooth_stability(const FactoredState& at, bool with_eigenvalues) {
  const Problem& problem = at.problem;
  const System& system = problem.system;
  if (problem.form != KktForm::dense) return find_pivot_stability(at);
  Stability out;
  Workspace& w = at.w;
  const bool varies =
      motion_varies(problem, at.z.q, sample_phases(system, problem.parameters, at.z.q), w.elsewhere());
  const PhaseStiffness angles = phase_stiffness(problem, at.z, w.elsewhere());
  const bool of_angles = !angles.entries.empty() || loops_tie_angles(problem, w.kinematics);
  // The potential at given speeds tells nothing of their angles.
  const bool potential = !of_angles && has_potential(problem, at.z, w.dense.stiffness(), w.elsewhere());
  const Eigen::MatrixXd& reduced = w.dense.reduced();
  ReducedHessian symmetric; // where there is a potential, whatever Newton used
  const bool factored = potential == problem.symmetric() && w.dense.shift() == 0;
  if (!factored) symmetric.factor(reduced, w.dense.noise(), potential);
  ReducedHessian& hessian = factored ? w.dense.hessian() : symmetric;
  Eigen::MatrixXd null_space = w.dense.constraints().basis() * hessian.null_basis();
  if (of_angles && null_space.cols() > 0) null_space = without_drift(at, angles, null_space);
  NeutralDirections neutral = neutral_directions(at, null_space);
  out.neutral = std::move(neutral.coordinates);
  out.neutral_directions = std::move(neutral.directions);
  // Multipliers take such angles for cyclic, and where momentum is kept the row of what acts is not at hand.
  out.angles_leave_open = of_angles && (varies || keeps_momentum(system));
  if (out.angles_leave_open) return out;
  if (varies) {
    classify_by_multipliers(problem, at.z, neutral.count, w.elsewhere(), out);
    return out;
  }

  // The first certificate that is not open is the reason. Of few coordinates eigenvalues cost little, and
  // tell more than an energy that falls.
  constexpr int few = 8;
  const bool keeps = !problem.parameters.dampers_drive; // a motion does not gain energy
  const bool energy_first = system.conserves || system.nv > few;
  Verdict& verdict = out;
  if (potential && keeps && hessian.positive_definite()) verdict = {true, StabilityReason::minimum};
  if (verdict.stable && !with_eigenvalues) return out;
  auto motion = steady_motion(problem, at.z, w);
  if (!motion) return out;
  if (potential) motion->stiffness = (reduced + reduced.transpose()) / 2;
  if (!verdict.stable && keeps && energy_first) verdict = by_energy(system, *motion);
  if (verdict.stable && !with_eigenvalues) return out;
  out.eigenvalues = eigenvalues_of(problem, *motion, with_eigenvalues ? nullptr : &out.few_digits);
  if (verdict.stable || !out.eigenvalues) return out;
  BalanceShape balance{{}, static_cast<int>(null_space.cols()), neutral.count};
  out.null_eigenvalues =
      system.torques.empty() ? count_null_eigenvalues(at, *motion, hessian, potential) : 2 * balance.null;
  if (potential && keeps)
    balance.falls = hessian.decompose() && hessian.eigenvalues()[0] < -ReducedHessian::zero;
  verdict = by_spectrum(at, *motion, *out.eigenvalues, out.null_eigenvalues, balance);
  if (!verdict.stable && keeps && !energy_first)
    if (const Verdict energy = by_energy(system, *motion); energy.stable) verdict = energy;
  return out;
}

Stability find_stability(const FactoredState& at, bool with_eigenvalues) {
  Stability out = find_smooth_stability(at, with_eigenvalues);
  judge_kinks(at, out);
  return out;
}

} // namespace flyball
