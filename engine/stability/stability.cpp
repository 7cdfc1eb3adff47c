#include "engine/stability/stability.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/pencil.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/gyroscopic_stability.hpp"
#include "engine/stability/kink_stability.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/phase_stiffness.hpp"
#include "engine/stability/pivot_stability.hpp"
#include "engine/stability/play.hpp"
#include "engine/stability/routh.hpp"
#include "engine/system/dampers.hpp"
#include "engine/system/kept_momentum.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// Whether a step (scaled) along null directions leads to another balanced state, the rest giving way as it
// must: a bob that turns about the vertical goes along an arc.
bool stays_balanced(const FactoredState& at, const Eigen::MatrixXd& null_space,
                    const Eigen::VectorXd& first) {
  const Problem& problem = at.problem;
  Workspace& w = at.w.elsewhere();
  Unknowns moved = at.z;
  Eigen::VectorXd step = first;
  for (int i = 0; i < 8; ++i) {
    w.step = step.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, w.step, moved.q);
    if (!assemble(problem, moved.q, 0, w)) return false;
    evaluate_with_multipliers(problem, moved, w);
    factor(problem, moved, w); // without loops the basis is made by this alone
    const Eigen::MatrixXd& basis = w.dense.constraints().basis();
    const Eigen::VectorXd left = basis.transpose() * w.residual.f.cwiseProduct(problem.scaling.column);
    const double force = largest(w.magnitudes.force.cwiseProduct(problem.scaling.column));
    if (left.size() == 0 || left.lpNorm<Eigen::Infinity>() <= tolerance::neutral_force * force) return true;
    const auto all = orthonormal_completion(basis.transpose() * null_space);
    if (!all || all->cols() <= null_space.cols()) return false;
    const auto rest = all->rightCols(all->cols() - null_space.cols());
    const auto solved = least_squares(large::projected(w.dense.stiffness(), basis) * rest, -left);
    if (!solved) return false;
    step = basis * (rest * *solved);
    if (!(step.lpNorm<Eigen::Infinity>() <= first.lpNorm<Eigen::Infinity>())) return false;
  }
  return false;
}

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

// Whether directions without mass and damping tip over at once: no finite eigenvalue shows it. They do
// where their own stiffness is negative, and where it vanishes while they are coupled with directions that
// have mass: with a mass e of theirs, e s^2 and m s^2 on the diagonal and c beside it, s^2 = +-c / sqrt(e m).
std::optional<bool> massless_directions_tip(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                            const Eigen::MatrixXd& stiffness) {
  if (mass.rows() == 0) return false;
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

// Whether a potential with this Hessian, of Routh's for instance, has a strict minimum.
bool is_minimum(const Eigen::MatrixXd& hessian) {
  if ((hessian - hessian.transpose()).norm() > tolerance::symmetric * hessian.norm()) return false;
  ReducedHessian potential;
  potential.factor(hessian, Eigen::VectorXd::Zero(hessian.rows()), true);
  return potential.positive_definite();
}

// Whether a matrix is positive semidefinite but for rounding.
bool is_semidefinite(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd symmetric = (a + a.transpose()) / 2;
  symmetric.diagonal().array() += 1e-12 * symmetric.norm();
  Cholesky factors;
  return symmetric.isZero(0) || factors.compute(symmetric);
}

// On the null space of the constraints, at the momenta that are kept, and the phases of what torques drive
// among these directions: of a dense problem that is factored at z.
struct SteadyMotion : LinearPencil {
  Eigen::MatrixXd phases; // orthonormal, by column
};

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
  return out;
}

// Whether torques that depend on the speeds they give alone, and fall as these grow, keep what stands at a
// strict minimum of the amended potential at these speeds. The energy less the sum of w L then has a strict
// minimum at the steady state, w its speeds and L the angular momenta of its shafts; and it falls at the rate
// of sum_i (T_i(w') - T_i(w)) (w'_i - w_i) < 0 and what dampers take. `jacobian` is that of the balance,
// scaled.
bool torques_keep_minimum(const Problem& problem, const Eigen::MatrixXd& jacobian,
                          const Eigen::MatrixXd& constraints, const Eigen::VectorXd& noise) {
  const System& system = problem.system;
  constexpr int few = 8; // of which eigenvalues cost little, and tell more
  if (system.nv <= few || system.torques.empty() || !system.conservative_at_speeds || !system.single_drives)
    return false;
  std::vector<int> speeds, rest;
  for (const DriveTorqueElement& torque : system.torques) {
    if (torque.keeps_momentum || torque.implied) return false;
    for (const DriveLaw* law : {&torque.torque, &torque.load})
      for (const DriveLaw::Input& input : law->inputs) {
        if (!input.rate()) return false;
        const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
        if (system.links[static_cast<std::size_t>(c.link)].drive < 0) return false;
      }
    speeds.push_back(system.links[static_cast<std::size_t>(torque.link)].v);
  }
  for (int v = 0; v < system.nv; ++v)
    if (std::ranges::find(speeds, v) == speeds.end()) rest.push_back(v);
  if (constraints.rows() > 0 && !constraints(Eigen::all, speeds).isZero(0)) return false;
  const Eigen::MatrixXd resists = jacobian(speeds, speeds);
  if (!is_minimum((resists + resists.transpose()) / 2)) return false;
  if (rest.empty()) return true;
  if (!(jacobian(speeds, rest).cwiseAbs().maxCoeff() <=
        tolerance::symmetric * jacobian(rest, rest).cwiseAbs().maxCoeff()))
    return false;
  Eigen::MatrixXd stiffness = jacobian(rest, rest);
  Eigen::VectorXd terms = noise;
  if (constraints.rows() > 0) {
    ConstraintSpace space;
    space.factor(constraints(Eigen::all, rest), 1e-10);
    stiffness = large::projected(stiffness, space.basis());
    terms.setZero(stiffness.rows());
  } else {
    terms = noise(rest);
  }
  ReducedHessian energy;
  energy.factor(stiffness, terms, true);
  return energy.positive_definite();
}

// Whether the energy q'^T M q' / 2 + q^T K q / 2 of a linearised motion keeps it where it is (Lyapunov,
// Dirichlet): with K symmetric and definite but along the phases that change nothing, and velocities that
// give nothing. Nothing of it follows where it does not.
bool energy_keeps(const SteadyMotion& motion) {
  if (!is_semidefinite(motion.velocity) || !is_semidefinite(motion.mass)) return false;
  if (motion.phases.cols() == 0) return is_minimum(motion.stiffness);
  const Eigen::MatrixXd& k = motion.stiffness;
  if (!((k * motion.phases).norm() + (k.transpose() * motion.phases).norm() <=
        tolerance::symmetric * k.norm()))
    return false;
  const auto all = orthonormal_completion(motion.phases);
  if (!all) return false;
  return is_minimum(large::projected(k, all->rightCols(all->cols() - motion.phases.cols())));
}

// Without those of the phases of what torques drive.
std::optional<std::vector<Complex>> eigenvalues_of(const Problem& problem, const SteadyMotion& motion) {
  if (motion.phases.cols() == 0)
    return pencil_eigenvalues(motion.mass, motion.velocity, motion.stiffness, problem.cancel);
  // On a tree an entry of M is as exact as its bodies' own numbers; a basis of loops mixes them.
  const double massless = problem.system.rows == 0 ? 1e-26 : 1e-13;
  auto out = eigenvalues_without_cyclic(motion.mass, motion.velocity, motion.stiffness, motion.phases,
                                        massless, problem.cancel);
  if (out) return out;
  // Something has no mass: all of them, and those nearest to zero left out.
  out = pencil_eigenvalues(motion.mass, motion.velocity, motion.stiffness, problem.cancel);
  for (Eigen::Index i = 0; out && i < motion.phases.cols(); ++i)
    if (!out->empty()) out->erase(std::ranges::min_element(*out, {}, [](Complex x) { return std::abs(x); }));
  return out;
}

// How many eigenvalues of s^2 M + s D + K are zero by its null directions, K n = 0, given in `right` and
// those of K^T in `left`: each has one, and a second where K x = -D n has a solution, so that x + n t goes on
// by itself (a Jordan chain; Gohberg, Lancaster and Rodman, Matrix Polynomials, 1982, section 1.4).
int count_null_eigenvalues(const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& left,
                           const Eigen::MatrixXd& right) {
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

std::optional<std::vector<Complex>> motion_eigenvalues(const Problem& problem, const Unknowns& z,
                                                       Workspace& w) {
  const auto motion = steady_motion(problem, z, w);
  if (!motion) return {};
  return eigenvalues_of(problem, *motion);
}

double real_part_rounding(Complex s, double largest) {
  return tolerance::on_axis * std::abs(s) + tolerance::on_axis_of_largest * largest;
}

bool may_vary(const Problem& problem, const Unknowns& z, const std::vector<double>& phases, Workspace& w) {
  const System& system = problem.system;
  const bool can_compare = system.nv <= (system.rows > 0 ? 600 : 2000);
  return !phases.empty() && (!can_compare || motion_varies(problem, z.q, phases, w));
}

bool has_potential(const Problem& problem, const Unknowns& z, const Eigen::MatrixXd& k, Workspace& w) {
  if (!problem.system.conservative) return false;
  if (problem.system.single_drives) return true;
  if ((k - k.transpose()).norm() > tolerance::symmetric * k.norm()) return false;
  // Second differences of U + lambda . Phi, whose gradient is f.
  const auto lagrangian = [&](int i, double step) {
    Eigen::VectorXd q = z.q;
    w.step.setZero(problem.system.nv);
    w.step[i] = step * problem.scaling.column[i];
    retract<double>(problem.system, w.step, q);
    forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
    w.zero_lambda.setZero(problem.system.rows);
    evaluate_residual<double>(problem.system, problem.parameters, q, w.zero_lambda, w.kinematics, w.residual);
    return amended_potential(problem.system, problem.parameters, q, w.kinematics).value +
           z.lambda.dot(w.residual.phi);
  };
  const double h = tolerance::second_difference;
  bool agrees = true;
  for (int i = 0; i < problem.system.nv && agrees; ++i) {
    interruption_point();
    const double second = (lagrangian(i, h) - 2 * lagrangian(i, 0) + lagrangian(i, -h)) / (h * h);
    agrees = std::abs(second - k(i, i)) <= tolerance::second_difference * k.norm();
  }
  return agrees;
}

namespace {

// Puts coordinates into out.neutral that take part in null directions along which it stays balanced at a
// distance; how many such directions there are.
int find_neutral(const FactoredState& at, const Eigen::MatrixXd& null_space, Stability& out) {
  const Problem& problem = at.problem;
  int count = 0;
  const auto stays_along = [&](const Eigen::VectorXd& direction) {
    const auto step = [&](double size) { return step_within_play(problem, at.z.q, size * direction); };
    return stays_balanced(at, null_space, step(0.05)) && stays_balanced(at, null_space, step(-0.11));
  };
  // What holds for a mixture of many holds for each.
  const bool all = null_space.cols() > few_null_directions && stays_along(mixture_of(null_space));
  for (Eigen::Index c = 0; c < null_space.cols(); ++c) {
    Eigen::VectorXd direction = null_space.col(c);
    const double size = direction.lpNorm<Eigen::Infinity>();
    if (!(size > 0)) continue;
    direction /= size;
    if (!all && !stays_along(direction)) continue;
    ++count;
    for (int i = 0; i < problem.system.nv; ++i)
      if (std::abs(direction[i]) > tolerance::takes_part &&
          std::ranges::find(out.neutral, i) == out.neutral.end())
        out.neutral.push_back(i);
  }
  std::ranges::sort(out.neutral);
  return count;
}

// Of null directions (scaled, by column) those along which tied angles do not drift: a balance at other
// speeds that would turn what springs and loops tie is none of a steady state.
Eigen::MatrixXd without_drift(const Problem& problem, const Kinematics<double>& k,
                              const PhaseStiffness& angles, const Linearization& l,
                              const Eigen::MatrixXd& null_space) {
  const System& system = problem.system;
  const Eigen::Index n = system.nv;
  Eigen::MatrixXd ties = Eigen::MatrixXd::Zero(n + system.rows, n); // of forces and loops, by angles
  for (std::size_t i = 0; i < angles.entries.size(); ++i)
    ties.col(angles.entries[i]).head(n) =
        angles.columns.col(static_cast<Eigen::Index>(i)).cwiseProduct(problem.scaling.column);
  if (const double size = largest_size(ties); size > 0) ties /= size;
  if (system.rows > 0)
    ties.bottomRows(system.rows) =
        problem.scaling.row.asDiagonal() *
        (constraints_of_motion(system, problem.parameters, k, l.constraint) - l.constraint);
  const auto parts = singular_vectors(ties * problem.scaling.column.asDiagonal() * null_space);
  if (!parts) return null_space;
  constexpr double drifts = 1e-9; // of the largest effect of an angle
  const double least = drifts * largest_size(ties) * largest(problem.scaling.column);
  Eigen::Index rank = 0;
  while (rank < parts->values.size() && parts->values[rank] > least)
    ++rank;
  return null_space * parts->right.rightCols(null_space.cols() - rank);
}

// What the potential, where there is one, and null directions tell of a state that is no minimum.
struct EnergyVerdict {
  bool potential = false;
  double most_negative = 0; // the lowest eigenvalue of `hessian`, where there is a potential
  ReducedHessian& hessian;
  Eigen::MatrixXd null_space; // scaled, by column
  int neutral = 0;            // see find_neutral()
};

// By the eigenvalues in `out`, of `motion`.
void judge_eigenvalues(const FactoredState& at, const SteadyMotion& motion, const EnergyVerdict& energy,
                       Stability& out) {
  const Problem& problem = at.problem;
  Workspace& w = at.w;
  const Eigen::MatrixXd &mass = motion.mass, &velocity = motion.velocity, &stiffness = motion.stiffness;
  const Eigen::Index null_count = energy.null_space.cols();
  // What belongs to null directions is zero but for rounding: the smallest are left out.
  out.null_eigenvalues = 2 * static_cast<int>(null_count);
  if (out.null_eigenvalues > 0 && problem.system.torques.empty()) {
    const Eigen::MatrixXd null_basis = energy.hessian.null_basis();
    ReducedHessian transposed;
    if (!energy.potential) transposed.factor(w.dense.reduced().transpose(), w.dense.noise(), false);
    out.null_eigenvalues =
        count_null_eigenvalues(velocity, energy.potential ? null_basis : transposed.null_basis(), null_basis);
  }
  std::vector<Complex> moving = *out.eigenvalues;
  std::ranges::sort(moving, [](Complex a, Complex b) { return std::abs(a) < std::abs(b); });
  const double largest = moving.empty() ? 0 : std::abs(moving.back());
  for (int i = 0; i < out.null_eigenvalues && !moving.empty() &&
                  std::abs(moving.front()) < tolerance::null_eigenvalue * largest;
       ++i)
    moving.erase(moving.begin());
  bool right = false, left = !moving.empty() || null_count == 0;
  for (Complex x : moving) {
    const double rounding = real_part_rounding(x, largest);
    if (x.real() > rounding) right = true;
    if (x.real() >= -rounding) left = false;
  }
  const auto tipping = massless_directions_tip(mass, velocity, stiffness);
  if (!tipping) return;
  if (*tipping) right = true;
  // Where the energy falls nowhere it grows nowhere either, whatever rounding makes of the eigenvalues.
  const bool falls = !energy.potential || energy.most_negative < -ReducedHessian::zero;
  if (right && falls) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  } else if (energy.neutral > 0) {
    out.reason = StabilityReason::neutral;
  } else if (null_count > 0) {
    out.reason = StabilityReason::marginal;
  } else if (left) {
    out.stable = true;
    out.reason = StabilityReason::asymptotic;
  } else if (energy.potential && energy.most_negative < -ReducedHessian::zero) {
    const auto damped =
        damping_destabilizes(problem, at.z.q, w.dense.constraints().basis(), mass, velocity, stiffness, w);
    if (!damped) return;
    if (*damped) out.stable = false;
    out.reason = *damped ? StabilityReason::unstable : StabilityReason::gyroscopic_only;
  } else {
    out.reason = StabilityReason::marginal;
  }
}

} // namespace

Stability find_smooth_stability(const FactoredState& at, bool with_eigenvalues) {
  const Problem& problem = at.problem;
  if (problem.form != KktForm::dense) return find_pivot_stability(at);
  Stability out;
  Workspace& w = at.w;
  const bool varies = motion_varies(problem, at.z.q,
                                    sample_phases(problem.system, problem.parameters, at.z.q), w.elsewhere());
  const PhaseStiffness angles = phase_stiffness(problem, at.z, w.elsewhere());
  const bool of_angles = !angles.entries.empty() || loops_tie_angles(problem, w.kinematics);
  // The potential at given speeds tells nothing of their angles.
  const bool potential = !of_angles && has_potential(problem, at.z, w.dense.stiffness(), w.elsewhere());
  const Eigen::MatrixXd& basis = w.dense.constraints().basis();
  const Eigen::MatrixXd& reduced = w.dense.reduced();
  ReducedHessian symmetric; // where there is a potential, whatever Newton used
  const bool factored = potential == problem.symmetric() && w.dense.shift() == 0;
  if (!factored) symmetric.factor(reduced, w.dense.noise(), potential);
  ReducedHessian& energy = factored ? w.dense.hessian() : symmetric;
  const bool minimum = potential && !varies && energy.positive_definite();
  if (minimum) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
  }

  Eigen::MatrixXd null_space = basis * energy.null_basis();
  if (of_angles && null_space.cols() > 0)
    null_space = without_drift(problem, w.kinematics, angles, w.dense.linearization, null_space);
  const int neutral = find_neutral(at, null_space, out);
  // Multipliers take such angles for cyclic, and where momentum is kept the row of what acts is not at hand.
  out.angles_leave_open = of_angles && (varies || keeps_momentum(problem.system));
  if (out.angles_leave_open) return out;
  if (varies) {
    classify_by_multipliers(problem, at.z, neutral, w.elsewhere(), out);
    return out;
  }

  const bool kept =
      !of_angles && torques_keep_minimum(problem, w.dense.stiffness(), w.dense.jacobian(), w.dense.noise());
  if (kept) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
  }
  double most_negative = 0;
  if (potential && !minimum && energy.size() > 0) {
    if (energy.decompose()) most_negative = energy.eigenvalues()[0];
  }
  if ((minimum || kept) && !with_eigenvalues) return out;

  auto motion = steady_motion(problem, at.z, w);
  if (!motion) return out;
  if (potential && problem.system.torques.empty()) motion->stiffness = (reduced + reduced.transpose()) / 2;
  constexpr int few = 20; // of which eigenvalues cost little, and tell more
  if (of_angles && problem.system.nv > few && problem.system.conservative_at_speeds &&
      energy_keeps(*motion)) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
    if (!with_eigenvalues) return out;
    out.eigenvalues = eigenvalues_of(problem, *motion);
    return out;
  }
  out.eigenvalues = eigenvalues_of(problem, *motion);
  if (!problem.system.torques.empty() && problem.system.conserves && is_minimum(motion->stiffness)) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
    return out;
  }
  if (minimum || kept || !out.eigenvalues) return out;
  judge_eigenvalues(at, *motion, {potential, most_negative, energy, null_space, neutral}, out);
  return out;
}

Stability find_stability(const FactoredState& at, bool with_eigenvalues) {
  Stability out = find_smooth_stability(at, with_eigenvalues);
  judge_kinks(at, out);
  return out;
}

} // namespace flyball
