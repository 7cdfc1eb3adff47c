#include "engine/stability/steady_motion.hpp"

#include "engine/linear/pencil.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/phase_stiffness.hpp"
#include "engine/system/kept_momentum.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// Of these directions in which phases change those along which nothing else does: two shafts that a spring
// ties turn together, and not the one against the other.
std::optional<Eigen::MatrixXd> free_phases(const Problem& problem, const Unknowns& z,
                                           const ReducedMotion& motion, const Eigen::MatrixXd& phases,
                                           Workspace& w) {
  if (!motion.of_angles || phases.cols() == 0) return phases;
  const auto effect = singular_vectors(motion.stiffness * phases);
  if (!effect) return {};
  Eigen::MatrixXd out(phases.rows(), 0);
  for (Eigen::Index i = 0; i < phases.cols(); ++i) {
    if (i < effect->values.size() && effect->values[i] > tolerance::neutral_force * motion.stiffness_terms)
      continue;
    const Eigen::VectorXd direction = phases * effect->right.col(i);
    Eigen::VectorXd turned = (motion.basis * direction).cwiseProduct(motion.unit);
    turned /= turned.lpNorm<Eigen::Infinity>();
    if (!balanced_along(problem, z, turned, w)) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols<1>() = direction;
  }
  return out;
}

} // namespace

std::optional<SteadyMotion> steady_motion(const Problem& problem, const Unknowns& z, Workspace& w) {
  const System& system = problem.system;
  ReducedMotion motion = reduced_motion(problem, z, w);
  SteadyMotion out;
  if (!keeps_momentum(system)) {
    if (!system.torques.empty()) {
      auto phases =
          free_phases(problem, z, motion, cyclic_directions(system, motion.basis, false), w.elsewhere());
      if (!phases) return {};
      out.phases = std::move(*phases);
    }
    out.noise = std::move(motion.noise);
    out.inertia = std::move(motion.inertia);
    out.mass = std::move(motion.mass);
    out.velocity = std::move(motion.velocity);
    out.stiffness = std::move(motion.stiffness);
    return out;
  }
  auto reduced = at_given_momenta(motion.mass, motion.velocity, motion.stiffness,
                                  cyclic_directions(system, motion.basis, true));
  if (!reduced) return {};
  static_cast<LinearPencil&>(out) = std::move(*reduced);
  out.phases = out.directions.transpose() * cyclic_directions(system, motion.basis, false);
  out.noise = out.directions.cwiseAbs2().transpose() * motion.noise;
  out.inertia = out.directions.cwiseAbs2().transpose() * motion.inertia;
  return out;
}

std::optional<std::vector<Complex>> eigenvalues_of(const Problem& problem, const SteadyMotion& motion,
                                                   bool* few_digits) {
  if (motion.phases.cols() == 0)
    return pencil_eigenvalues(motion.mass, motion.velocity, motion.stiffness, problem.cancel, motion.inertia);
  // On a tree an entry of M is as exact as its bodies' own numbers; a basis of loops mixes them.
  const double massless = problem.system.rows == 0 ? 1e-26 : 1e-13;
  auto out = eigenvalues_without_cyclic(motion.mass, motion.velocity, motion.stiffness, motion.phases,
                                        massless, problem.cancel, few_digits);
  if (out) return out;
  // Something has no mass: all of them, and those nearest to zero left out.
  out = pencil_eigenvalues(motion.mass, motion.velocity, motion.stiffness, problem.cancel, motion.inertia);
  for (Eigen::Index i = 0; out && i < motion.phases.cols(); ++i)
    if (!out->empty()) out->erase(std::ranges::min_element(*out, {}, [](Complex x) { return std::abs(x); }));
  return out;
}

std::optional<std::vector<Complex>> motion_eigenvalues(const Problem& problem, const Unknowns& z,
                                                       Workspace& w) {
  const auto motion = steady_motion(problem, z, w);
  if (!motion) return {};
  return eigenvalues_of(problem, *motion);
}

} // namespace flyball
