#include "engine/stability/certificates.hpp"

#include "engine/linear/large.hpp"
#include "engine/linear/pencil.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/gyroscopic_stability.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// Whether a potential with this Hessian has a strict minimum; of a diagonal below `noise` nothing is known.
bool is_minimum(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& noise) {
  if ((hessian - hessian.transpose()).norm() > tolerance::symmetric * hessian.norm()) return false;
  ReducedHessian potential;
  potential.factor(hessian, noise, true);
  return potential.positive_definite();
}

// Whether the symmetric part of a matrix is positive semidefinite but for rounding: its own, or that of a
// matrix of this norm that it was made of.
bool is_semidefinite(const Eigen::MatrixXd& a, double terms) {
  Eigen::MatrixXd symmetric = (a + a.transpose()) / 2;
  symmetric.diagonal().array() += 1e-12 * std::max(a.norm(), terms);
  Cholesky factors;
  return symmetric.isZero(0) || factors.compute(symmetric);
}

// Whether torques depend on speeds that torques give alone.
bool torques_are_of_speeds(const System& system) {
  const auto of_speeds = [&](const DriveLaw& law) {
    return std::ranges::all_of(law.inputs, [&](const DriveLaw::Input& input) {
      if (!input.rate()) return false;
      const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
      return system.links[static_cast<std::size_t>(c.link)].drive >= 0;
    });
  };
  return std::ranges::all_of(system.torques, [&](const DriveTorqueElement& torque) {
    return of_speeds(torque.torque) && of_speeds(torque.load);
  });
}

bool energy_keeps(const System& system, const SteadyMotion& motion) {
  const bool falls = system.conservative_at_speeds && system.single_drives && torques_are_of_speeds(system);
  if (system.torques.empty() || (!system.conserves && !falls)) return false;
  const Eigen::MatrixXd &k = motion.stiffness, &phases = motion.phases;
  if (!is_semidefinite(motion.velocity, motion.velocity_terms) ||
      !is_semidefinite(motion.mass, motion.mass_terms))
    return false;
  if (phases.cols() == 0) return is_minimum(k, motion.noise);
  if (!((k * phases).norm() + (k.transpose() * phases).norm() <= tolerance::symmetric * k.norm()))
    return false;
  // A speed that nothing keeps may be any other as well.
  const Eigen::MatrixXd resists = phases.transpose() * motion.velocity * phases;
  if (!is_minimum((resists + resists.transpose()) / 2, Eigen::VectorXd::Zero(resists.rows()))) return false;
  const auto all = orthonormal_completion(phases);
  if (!all) return false;
  const auto others = all->rightCols(all->cols() - phases.cols());
  return is_minimum(large::projected(k, others), others.cwiseAbs2().transpose() * motion.noise);
}

// Whether directions without mass and damping tip over at once: no finite eigenvalue shows it. They do
// where their own stiffness is negative, and where it vanishes while they are coupled with directions that
// have mass: with a mass e of theirs, e s^2 and m s^2 on the diagonal and c beside it, s^2 = +-c / sqrt(e m).
std::optional<bool> massless_directions_tip(const SteadyMotion& motion) {
  if (motion.mass.rows() == 0) return false;
  const auto [mass, velocity, stiffness, graded, known] =
      measured_pencil(motion.mass, motion.velocity, motion.stiffness, motion.inertia);
  SymmetricEigen shape;
  if (!shape.compute((mass + mass.transpose()) / 2)) return {};
  Eigen::Index massless = 0;
  while (massless < mass.rows() &&
         shape.values()[massless] < tolerance::massless * std::max(mass.norm(), 1e-300))
    ++massless;
  if (massless == 0) return false;
  const Eigen::MatrixXd z = shape.vectors().leftCols(massless),
                        r = shape.vectors().rightCols(mass.rows() - massless);
  SymmetricEigen local;
  if (!local.compute(z.transpose() * (stiffness + stiffness.transpose()) * z / 2)) return {};
  const double size = std::max(stiffness.norm(), 1e-300);
  if (local.values()[0] < -tolerance::without_force * size) return true;
  for (Eigen::Index i = 0; i < massless && local.values()[i] < tolerance::without_force * size; ++i) {
    const Eigen::VectorXd direction = z * local.vectors().col(i);
    if ((velocity * direction).norm() > tolerance::without_force * velocity.norm()) continue;
    const double coupling = std::min((r.transpose() * stiffness * direction).norm(),
                                     (direction.transpose() * stiffness * r).norm());
    if (coupling > tolerance::coupled * size &&
        coupling * coupling > 100 * std::abs(local.values()[i]) * size)
      return true;
  }
  return false;
}

// The null directions n of s^2 M + s D + K, K n = 0, are given in `right` and those of K^T in `left`: each
// has an eigenvalue zero, and a second where K x = -D n has a solution, so that x + n t goes on by itself (a
// Jordan chain; Gohberg, Lancaster and Rodman, Matrix Polynomials, 1982, section 1.4).
int zeros_of(const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  const int count = static_cast<int>(right.cols());
  const double size = velocity.norm();
  PivotedQr damping;
  if (count == 0 || !(size > 0) || left.cols() == 0 ||
      !damping.compute(left.colwise().normalized().transpose() * velocity * right.colwise().normalized()))
    return 2 * count;
  int damped = 0;
  while (damped < std::min(count, static_cast<int>(left.cols())) &&
         damping.pivot(damped) > tolerance::null_damping * size)
    ++damped;
  return 2 * count - damped;
}

} // namespace

Verdict by_energy(const System& system, const SteadyMotion& motion) {
  if (!energy_keeps(system, motion)) return {};
  return {true, StabilityReason::minimum};
}

double real_part_rounding(Complex s, double largest) {
  return tolerance::on_axis * std::abs(s) + tolerance::on_axis_of_largest * largest;
}

int count_null_eigenvalues(const FactoredState& at, const SteadyMotion& motion, const ReducedHessian& hessian,
                           bool potential) {
  if (hessian.null_count() == 0) return 0;
  const Eigen::MatrixXd null_basis = hessian.null_basis();
  if (potential) return zeros_of(motion.velocity, null_basis, null_basis);
  ReducedHessian transposed;
  transposed.factor(at.w.dense.reduced().transpose(), at.w.dense.noise(), false);
  return zeros_of(motion.velocity, transposed.null_basis(), null_basis);
}

Verdict by_spectrum(const FactoredState& at, const SteadyMotion& motion, std::vector<Complex> eigenvalues,
                    int null_eigenvalues, const BalanceShape& balance) {
  const Problem& problem = at.problem;
  const Eigen::MatrixXd &mass = motion.mass, &velocity = motion.velocity, &stiffness = motion.stiffness;
  std::ranges::sort(eigenvalues, {}, [](Complex s) { return std::abs(s); });
  const double largest = eigenvalues.empty() ? 0 : std::abs(eigenvalues.back());
  // What belongs to null directions is zero but for rounding.
  const auto begin = std::ranges::find_if(
      eigenvalues.begin(),
      eigenvalues.begin() + std::min(null_eigenvalues, static_cast<int>(eigenvalues.size())),
      [&](Complex s) { return !(std::abs(s) < tolerance::null_eigenvalue * largest); });
  const auto tips = massless_directions_tip(motion);
  if (!tips) return {};
  const bool grows = *tips || std::any_of(begin, eigenvalues.end(), [&](Complex s) {
    return s.real() > real_part_rounding(s, largest);
  });
  const bool decays = (begin != eigenvalues.end() || balance.null == 0) &&
                      std::all_of(begin, eigenvalues.end(),
                                  [&](Complex s) { return s.real() < -real_part_rounding(s, largest); });
  // Where the energy falls nowhere it grows nowhere either, whatever rounding makes of the eigenvalues.
  if (grows && balance.falls != false) return {false, StabilityReason::unstable};
  if (balance.neutral > 0) return {{}, StabilityReason::neutral};
  if (balance.null > 0) return {{}, StabilityReason::marginal};
  if (decays) return {true, StabilityReason::asymptotic};
  if (balance.falls != true) return {{}, StabilityReason::marginal};
  const auto damped = damping_destabilizes(problem, at.z.q, at.w.dense.constraints().basis(), mass, velocity,
                                           stiffness, at.w);
  if (!damped) return {};
  if (*damped) return {false, StabilityReason::unstable};
  return {{}, StabilityReason::gyroscopic_only};
}

} // namespace flyball
