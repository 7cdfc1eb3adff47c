#include "engine/stability/sign_is_open.hpp"

#include "engine/linear/largest.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/steady_motion.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double known_error =
    1e-11; // scaled: an error below this is that of a state that is far from singular

// Of a dense problem with a potential; `away` is the error, scaled.
bool stiffness_is_open(const Problem& problem, const Unknowns& z, double away, bool minimum, Workspace& w) {
  DenseKkt* dense = w.matrices(problem);
  if (minimum && away < known_error) return false;
  Unknowns here = z;
  factor_with_multipliers(problem, here, w);
  ReducedHessian& hessian = dense->hessian();
  if (hessian.size() == 0) return false;
  if (hessian.singular()) {
    // Whatever is left open in a direction without stiffness, another one may fall for certain.
    constexpr double certain = 1e-6;
    return !(hessian.decompose() && hessian.eigenvalues()[0] < -certain);
  }
  if (!hessian.decompose()) return true;
  Eigen::Index softest = 0;
  hessian.eigenvalues().cwiseAbs().minCoeff(&softest);
  Eigen::VectorXd direction = hessian.eigenvectors().col(softest).cwiseProduct(hessian.scale());
  if (problem.system.rows > 0 && dense->constraints().rank() > 0)
    direction = (dense->constraints().basis() * direction).eval();
  direction /= direction.lpNorm<Eigen::Infinity>();
  const auto stiffness = [&] { return direction.dot(dense->stiffness() * direction); };
  const double noise = 4 * std::numeric_limits<double>::epsilon() *
                       direction.cwiseAbs().dot(w.magnitudes.force.cwiseProduct(problem.scaling.column));
  const double least = stiffness();
  double change = noise;
  for (const double side : {4., -4.}) {
    here.q = z.q;
    const Eigen::VectorXd step = side * away * direction.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, step, here.q);
    if (!assemble(problem, here.q, 0, w)) continue;
    factor_with_multipliers(problem, here, w);
    change = std::max(change, std::abs(stiffness() - least));
  }
  return std::abs(least) <= change;
}

// The direction (scaled, its largest entry 1) in which the balance that is factored in the workspace changes
// least, by inverse iteration.
Eigen::VectorXd softest_direction(const Problem& problem, Workspace& w) {
  Eigen::VectorXd x = Eigen::VectorXd::Ones(problem.system.nv), next;
  for (int i = 0; i < 3; ++i) {
    w.kkt(problem).solve(x, next);
    const double size = largest_size(next);
    if (!(size > 0) || !std::isfinite(size)) return Eigen::VectorXd::Zero(x.size());
    x = next / size;
  }
  return x;
}

// The largest real part (1/s) of the eigenvalues of the motion at `here`, where the loops are closed.
std::optional<double> growth_at(const Problem& problem, Unknowns here, Workspace& w) {
  factor_with_multipliers(problem, here, w);
  const auto eigenvalues = motion_eigenvalues(problem, here, w);
  if (!eigenvalues || eigenvalues->empty()) return {};
  double growth = -std::numeric_limits<double>::infinity();
  for (const std::complex<double> s : *eigenvalues)
    growth = std::max(growth, s.real());
  return growth;
}

// Of a dense problem whose speeds are found by torques.
bool growth_is_open(const Problem& problem, const Unknowns& z, double away, Workspace& w) {
  if (away < known_error) return false;
  const auto least = growth_at(problem, z, w);
  if (!least) return false;
  const Eigen::VectorXd direction = softest_direction(problem, w);
  double change = 0;
  for (const double side : {4., -4.}) {
    Unknowns there = z;
    const Eigen::VectorXd step = side * away * direction.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, step, there.q);
    if (!assemble(problem, there.q, 0, w)) continue;
    if (const auto growth = growth_at(problem, there, w))
      change = std::max(change, std::abs(*growth - *least));
  }
  return std::abs(*least) <= change;
}

bool verdict_is_open(const Problem& problem, const Unknowns& z, double away, const Stability& stability,
                     Workspace& w) {
  if (problem.symmetric() && !problem.parameters.dampers_drive)
    return stiffness_is_open(problem, z, away, stability.reason == StabilityReason::minimum, w);
  const bool decided = stability.reason == StabilityReason::asymptotic ||
                       stability.reason == StabilityReason::unstable ||
                       stability.reason == StabilityReason::minimum;
  return decided && !problem.system.torques.empty() &&
         (!problem.system.conserves || problem.parameters.dampers_drive) &&
         growth_is_open(problem, z, away, w);
}

} // namespace

bool sign_is_open(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& error,
                  const Stability& stability, Workspace& w) {
  const bool varies = stability.floquet || stability.floquet_failure;
  if (problem.system.nv == 0 || problem.form != KktForm::dense || varies ||
      stability.reason == StabilityReason::neutral)
    return false;
  const double away = error.cwiseQuotient(problem.scaling.column).lpNorm<Eigen::Infinity>();
  if (stability.kinks.empty()) return verdict_is_open(problem, z, away, stability, w);
  const Parameters softer = straightened(problem, stability.kinks, KinkSide::softer);
  return verdict_is_open({problem.system, softer, problem.scaling, problem.cancel, problem.form}, z, away,
                         stability, w);
}

namespace {

constexpr double little = 1e-4; // scaled: a step beside a state

// Moves a state along a direction (scaled) and closes its loops; false where that cannot be done.
bool step_beside(const Problem& problem, const Eigen::VectorXd& direction, double by, Workspace& w,
                 Unknowns& z) {
  const Eigen::VectorXd step = by * direction.cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, step, z.q);
  return assemble(problem, z.q, 0, w);
}

// Whether a little beside the state the balance is not what its derivative there says by far, along the
// direction in which that is least: then the state is within a tenth of that of a fold or a root of higher
// order.
bool is_nearly_singular(const FactoredState& at, const Eigen::VectorXd& direction) {
  const Problem& problem = at.problem;
  const DenseKkt& dense = at.w.dense;
  const double slope = (dense.constraints().basis().transpose() * (dense.stiffness() * direction)).norm();
  double most = 0;
  for (const double side : {little, -little}) {
    Workspace& w = at.w.elsewhere();
    Unknowns beside = at.z;
    if (!step_beside(problem, direction, side, w, beside)) continue;
    evaluate_with_multipliers(problem, beside, w);
    Eigen::VectorXd force = w.residual.f.cwiseProduct(problem.scaling.column);
    if (problem.system.rows > 0) force = (w.dense.constraints().basis().transpose() * force).eval();
    most = std::max(most, force.norm());
  }
  return slope * little < 0.1 * most;
}

} // namespace

bool sign_is_open(const FactoredState& at, const Stability& stability) {
  const Problem& problem = at.problem;
  if (problem.system.nv == 0 || problem.form != KktForm::dense || !stability.stable) return false;
  const Eigen::VectorXd direction = softest_direction(problem, at.w);
  if (!is_nearly_singular(at, direction)) return false;
  Workspace& w = at.w.elsewhere();
  Unknowns beside = at.z;
  if (!step_beside(problem, direction, little, w, beside)) return false;
  NewtonSettings settings;
  settings.max_iterations = 100;
  const NewtonOutcome outcome = newton(problem, beside, w, settings, nullptr);
  if (!outcome.converged) return false;
  ErrorEstimate error;
  refine(problem, beside, outcome, w, error);
  // Found twice it is known no better than the two agree.
  const Eigen::VectorXd apart = outcome.linear ? (beside.q - at.z.q).cwiseAbs().eval() : Eigen::VectorXd();
  if (apart.size() == error.solution.size()) error.solution = error.solution.cwiseMax(apart);
  return sign_is_open(problem, at.z, error.solution, stability, w);
}

void leave_open(Stability& stability) {
  stability.stable.reset();
  stability.reason = StabilityReason::marginal;
}

void leave_out_modes(Stability& stability) {
  stability.eigenvalues.reset();
  if (stability.stable == false) leave_open(stability);
}

} // namespace flyball
