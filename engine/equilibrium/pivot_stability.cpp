#include "engine/equilibrium/pivot_stability.hpp"

namespace flyball {
namespace {

// Whether a way (scaled) along directions without stiffness leads to another balanced state, the rest giving
// way as it must.
bool stays_balanced(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& way, Workspace& w) {
  Unknowns moved = z;
  Eigen::VectorXd step = way;
  for (int i = 0; i < 8; ++i) {
    w.step = step.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, w.step, moved.q);
    evaluate(problem, moved, 0, w);
    const double force = w.magnitudes.force.cwiseProduct(problem.scaling.column).maxCoeff();
    w.target = -w.residual.f.cwiseProduct(problem.scaling.column);
    if (w.target.lpNorm<Eigen::Infinity>() <= 1e-9 * force) return true;
    factor(problem, moved, w);
    w.eliminator(problem).solve(w.target, step);
    if (!(step.lpNorm<Eigen::Infinity>() <= way.lpNorm<Eigen::Infinity>())) return false;
  }
  return false;
}

} // namespace

Stability find_pivot_stability(const Problem& problem, const Unknowns& z, Workspace& w) {
  Stability out;
  if (!problem.symmetric()) return out;
  const int negative = w.eliminator(problem).negative_count();
  if (w.eliminator(problem).positive_definite()) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
  } else if (negative % 2 == 1) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  }
  if (w.eliminator(problem).flat().empty()) return out;

  // All at once: either nothing resists any of them, or the state is singular.
  const std::vector<Eliminator::Flat> flat = w.eliminator(problem).flat();
  Eigen::VectorXd all = Eigen::VectorXd::Zero(problem.system.nv), one;
  std::vector<bool> takes_part(static_cast<std::size_t>(problem.system.nv));
  if (flat.size() <= 100) {
    for (const Eliminator::Flat& f : flat) {
      w.eliminator(problem).direction_of(f, one);
      one /= one.lpNorm<Eigen::Infinity>();
      for (int v = 0; v < problem.system.nv; ++v)
        if (std::abs(one[v]) > 1e-6) takes_part[static_cast<std::size_t>(v)] = true;
      all += one;
    }
  } else { // each by itself would cost too much: without what follows beyond
    for (const Eliminator::Flat& f : flat)
      for (const auto& [v, share] : f)
        if (std::abs(share) > 1e-6) {
          takes_part[static_cast<std::size_t>(v)] = true;
          all[v] += share;
        }
  }
  if (all.isZero(0)) { // too many to name
    if (!out.reason && negative == 0) out.reason = StabilityReason::marginal;
    return out;
  }
  all /= all.lpNorm<Eigen::Infinity>();
  const bool balanced =
      stays_balanced(problem, z, 0.05 * all, w) && stays_balanced(problem, z, -0.11 * all, w);
  if (balanced)
    for (int v = 0; v < problem.system.nv; ++v)
      if (takes_part[static_cast<std::size_t>(v)]) out.neutral.push_back(v);
  if (!out.reason && negative == 0)
    out.reason = balanced ? StabilityReason::neutral : StabilityReason::marginal;
  return out;
}

} // namespace flyball
