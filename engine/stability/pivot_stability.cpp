#include "engine/stability/pivot_stability.hpp"

#include "engine/kkt/motion_products.hpp"
#include "engine/linear/largest.hpp"
#include "engine/solve/existence.hpp"

#include <random>

namespace flyball {
namespace {

// Whether a step (scaled) along null directions leads to another balanced state, the rest giving way as it
// must, to `rounding` of the forces.
bool stays_balanced(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& first, double rounding,
                    Workspace& w) {
  Unknowns moved = z;
  Eigen::VectorXd step = first, multipliers;
  const double shift = w.kkt(problem).shift();
  const auto balanced = [&] {
    const double force = largest(w.magnitudes.force.cwiseProduct(problem.scaling.column));
    const double left = w.residual.f.cwiseProduct(problem.scaling.column).lpNorm<Eigen::Infinity>();
    const double open = problem.system.rows > 0
                            ? w.residual.phi.cwiseProduct(problem.scaling.row).lpNorm<Eigen::Infinity>()
                            : 0;
    return left <= rounding * force && open <= rounding;
  };
  for (int i = 0; i < 8; ++i) {
    w.step = step.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, w.step, moved.q);
    evaluate(problem, moved, 0, w); // as a rule loops carry on as they did
    if (balanced()) return true;
    if (problem.system.rows > 0) {
      evaluate_with_multipliers(problem, moved, w);
      if (balanced()) return true;
    }
    factor(problem, moved, w);
    if (shift > 0) w.kkt(problem).factor(shift);
    newton_step(problem, w.residual.f, w.residual.phi, w, step, multipliers);
    if (!(step.lpNorm<Eigen::Infinity>() <= first.lpNorm<Eigen::Infinity>())) return false;
  }
  return false;
}

// Whether where the potential falls some way motions follow it, be it along one direction or several: without
// forces in the velocity, and where every coordinate is damped, whatever gyroscopic forces do (Kelvin, Tait
// and Chetayev). The balance must be evaluated at z.
bool nothing_holds(const Problem& problem, const Unknowns& z, Workspace& w) {
  bool all_damped = true;
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    const std::size_t count = link.v < 0 ? 0 : link.type == LinkType::spherical ? 3 : 1;
    for (std::size_t i = 0; i < count; ++i)
      all_damped = all_damped && problem.parameters.links[l].force[i].damping > 0;
  }
  if (all_damped) return true;
  MotionProducts products;
  products.linearize(problem, z, w.kinematics, w.residual);
  return !products.velocity_matters();
}

// Where many directions are neutral but for rounding: inverse iteration with the factors that hold them.
Stability of_held_directions(const Problem& problem, const Unknowns& z, Workspace& w) {
  constexpr int samples = 4, iterations = 4;
  constexpr double rounding = 1e-11; // the step is short, since what is held comes back far along it
  Stability out;
  KktSystem& e = w.kkt(problem);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  Eigen::VectorXd direction, one(problem.system.nv), image;
  std::vector<bool> takes_part(static_cast<std::size_t>(problem.system.nv));
  for (int i = 0; i < samples; ++i) {
    for (double& x : one)
      x = any(random);
    for (int k = 0; k < iterations; ++k) {
      e.metric(one, image);
      e.solve(image, one);
      one /= one.lpNorm<Eigen::Infinity>();
    }
    for (int v = 0; v < problem.system.nv; ++v)
      if (std::abs(one[v]) > 1e-6) takes_part[static_cast<std::size_t>(v)] = true;
    if (i == 0) direction = one;
  }
  for (const KktSystem::NullDirection& f : e.null_directions()) // and what feels nothing at all
    for (const auto& [v, share] : f)
      if (std::abs(share) > 1e-6) takes_part[static_cast<std::size_t>(v)] = true;
  const bool balanced = stays_balanced(problem, z, 0.002 * direction, rounding, w) &&
                        stays_balanced(problem, z, -0.003 * direction, rounding, w);
  out.reason = balanced ? StabilityReason::neutral : StabilityReason::marginal;
  for (int v = 0; balanced && v < problem.system.nv; ++v)
    if (takes_part[static_cast<std::size_t>(v)]) out.neutral.push_back(v);
  return out;
}

} // namespace

Stability find_pivot_stability(const Problem& problem, const Unknowns& z, Workspace& w) {
  Stability out;
  if (const auto phases = sample_phases(problem.system, problem.parameters); !phases.empty()) {
    if (may_vary(problem, z, phases, w)) {
      out.reason = StabilityReason::varying;
      out.floquet_failure = FloquetFailure::unresolved;
      return out;
    }
    evaluate(problem, z, 0, w);
    factor(problem, z, w);
  }
  if (!problem.symmetric() || !w.kkt(problem).inertia_is_certain(problem, w)) return out;
  if (w.kkt(problem).shift() > 0) return of_held_directions(problem, z, w);
  const int negative = w.kkt(problem).negative_count();
  if (w.kkt(problem).positive_definite()) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
  } else if (negative % 2 == 1 || (negative > 0 && nothing_holds(problem, z, w))) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  }
  if (!w.kkt(problem).singular()) return out;

  // All at once: either nothing resists any of them, or the state is singular.
  const std::vector<KktSystem::NullDirection> directions = w.kkt(problem).null_directions();
  Eigen::VectorXd all = Eigen::VectorXd::Zero(problem.system.nv), one;
  std::vector<bool> takes_part(static_cast<std::size_t>(problem.system.nv));
  if (directions.size() <= 100) {
    for (const KktSystem::NullDirection& f : directions) {
      w.kkt(problem).direction_of(f, one);
      one /= one.lpNorm<Eigen::Infinity>();
      for (int v = 0; v < problem.system.nv; ++v)
        if (std::abs(one[v]) > 1e-6) takes_part[static_cast<std::size_t>(v)] = true;
      all += one;
    }
  } else { // each by itself would cost too much: without what follows beyond
    for (const KktSystem::NullDirection& f : directions)
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
      stays_balanced(problem, z, 0.05 * all, 1e-9, w) && stays_balanced(problem, z, -0.11 * all, 1e-9, w);
  if (balanced)
    for (int v = 0; v < problem.system.nv; ++v)
      if (takes_part[static_cast<std::size_t>(v)]) out.neutral.push_back(v);
  if (!out.reason && negative == 0)
    out.reason = balanced ? StabilityReason::neutral : StabilityReason::marginal;
  return out;
}

} // namespace flyball
