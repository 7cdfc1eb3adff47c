#include "engine/stability/pivot_stability.hpp"

#include "engine/kkt/motion_products.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/play.hpp"

namespace flyball {
namespace {

// Whether a step (scaled) along null directions leads to another balanced state, the rest giving way as it
// must, to `rounding` of the forces.
bool stays_balanced(const FactoredState& at, const Eigen::VectorXd& first, double rounding) {
  const Problem& problem = at.problem;
  Workspace& w = at.w.elsewhere();
  Unknowns moved = at.z;
  Eigen::VectorXd step = first, multipliers;
  const double shift = at.kkt().shift();
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
// and Chetayev).
bool nothing_holds(const FactoredState& at) {
  const Problem& problem = at.problem;
  bool all_damped = true;
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    const std::size_t count = link.v < 0 ? 0 : link.type == LinkType::spherical ? 3 : 1;
    for (std::size_t i = 0; i < count; ++i)
      all_damped = all_damped && problem.parameters.links[l].force[i].damping > 0;
  }
  if (all_damped) return true;
  MotionProducts products;
  products.linearize(problem, at.z, at.w.kinematics, at.w.residual);
  return !products.velocity_matters();
}

// Where many directions are neutral but for rounding: inverse iteration with the factors whose shift resists
// them.
Stability of_shifted_directions(const FactoredState& at) {
  const Problem& problem = at.problem;
  constexpr int samples = 4, iterations = 4;
  constexpr double rounding = 1e-11; // the step is short, since what the shift resists returns far along it
  Stability out;
  KktSystem& kkt = at.kkt();
  std::mt19937 random(11);
  Eigen::VectorXd direction, one(problem.system.nv), image;
  std::vector<bool> takes_part(static_cast<std::size_t>(problem.system.nv));
  for (int i = 0; i < samples; ++i) {
    for (double& x : one)
      x = uniform(random, -1, 1);
    for (int k = 0; k < iterations; ++k) {
      kkt.metric(one, image);
      kkt.solve(image, one);
      one /= one.lpNorm<Eigen::Infinity>();
    }
    for (int v = 0; v < problem.system.nv; ++v)
      if (std::abs(one[v]) > tolerance::takes_part) takes_part[static_cast<std::size_t>(v)] = true;
    if (i == 0) direction = one;
  }
  for (const KktSystem::NullDirection& f : kkt.null_directions()) // and what feels nothing at all
    for (const auto& [v, share] : f)
      if (std::abs(share) > tolerance::takes_part) takes_part[static_cast<std::size_t>(v)] = true;
  const auto step = [&](double size) { return step_within_play(problem, at.z.q, size * direction); };
  const bool balanced =
      stays_balanced(at, step(0.002), rounding) && stays_balanced(at, step(-0.003), rounding);
  out.reason = balanced ? StabilityReason::neutral : StabilityReason::marginal;
  for (int v = 0; balanced && v < problem.system.nv; ++v)
    if (takes_part[static_cast<std::size_t>(v)]) out.neutral.push_back(v);
  return out;
}

} // namespace

Stability find_pivot_stability(const FactoredState& at) {
  const Problem& problem = at.problem;
  KktSystem& kkt = at.kkt();
  Stability out;
  const auto phases = sample_phases(problem.system, problem.parameters, at.z.q);
  if (may_vary(problem, at.z, phases, at.w.elsewhere())) {
    out.reason = StabilityReason::varying;
    out.floquet_failure = FloquetFailure::unresolved;
    return out;
  }
  if (!problem.symmetric() || problem.parameters.dampers_drive || !kkt.inertia_is_certain(problem, at.w))
    return out;
  if (kkt.shift() > 0) return of_shifted_directions(at);
  const int negative = kkt.negative_count();
  if (kkt.positive_definite()) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
  } else if (negative % 2 == 1 || (negative > 0 && nothing_holds(at))) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  }
  if (!kkt.singular()) return out;

  // All at once: either nothing resists any of them, or the state is singular.
  const std::vector<KktSystem::NullDirection> directions = kkt.null_directions();
  Eigen::VectorXd all = Eigen::VectorXd::Zero(problem.system.nv), one;
  std::vector<bool> takes_part(static_cast<std::size_t>(problem.system.nv));
  if (directions.size() <= 100) {
    for (const KktSystem::NullDirection& f : directions) {
      kkt.direction_of(f, one);
      one /= one.lpNorm<Eigen::Infinity>();
      for (int v = 0; v < problem.system.nv; ++v)
        if (std::abs(one[v]) > tolerance::takes_part) takes_part[static_cast<std::size_t>(v)] = true;
      all += one;
    }
  } else { // each by itself would cost too much: without what follows beyond
    for (const KktSystem::NullDirection& f : directions)
      for (const auto& [v, share] : f)
        if (std::abs(share) > tolerance::takes_part) {
          takes_part[static_cast<std::size_t>(v)] = true;
          all[v] += share;
        }
  }
  if (all.isZero(0)) { // too many to name
    if (!out.reason && negative == 0) out.reason = StabilityReason::marginal;
    return out;
  }
  all /= all.lpNorm<Eigen::Infinity>();
  const auto step = [&](double size) { return step_within_play(problem, at.z.q, size * all); };
  const bool balanced = stays_balanced(at, step(0.05), tolerance::neutral_force) &&
                        stays_balanced(at, step(-0.11), tolerance::neutral_force);
  if (balanced)
    for (int v = 0; v < problem.system.nv; ++v)
      if (takes_part[static_cast<std::size_t>(v)]) out.neutral.push_back(v);
  if (!out.reason && negative == 0)
    out.reason = balanced ? StabilityReason::neutral : StabilityReason::marginal;
  return out;
}

} // namespace flyball
