#include "engine/solve/refine.hpp"

#include "engine/solve/singular_loops.hpp"
#include "engine/system/law_sizes.hpp"

#include <bit>

namespace flyball {
namespace {

// What is left of the balance is small, and then rounded.
void evaluate_rounded(const Problem& problem, const Unknowns& z, Workspace& w) {
  evaluate_extended(problem, z, w);
  w.residual.f = w.residual_extended.f.cast<double>();
  w.residual.phi = w.residual_extended.phi.cast<double>();
}

// Of noise in four patterns: no two of eight neighbours have the same signs in all of them, nor opposite
// ones, so that what they do together does not cancel throughout.
double noise_sign(unsigned pattern, Eigen::Index i) {
  const auto place = static_cast<unsigned>(i), eight = place / 8;
  const unsigned mixed = (place + 5 * eight) % 8;
  const unsigned turned = pattern == 0 ? 0 : mixed >> (pattern - 1);
  return ((turned ^ static_cast<unsigned>(std::popcount(eight))) & 1U) == 0 ? 1 : -1;
}

// What the rounding of the residual, to double precision of laws, and of the solution for the step, and
// equations of redundant loops that disagree, do to each coordinate: the step that noise of this size with
// arbitrary signs asks for, four times over. `left` (scaled) is the largest force that the step had to
// balance: a stiff spring's, by its rounded length. Loops mix it with the softest.
void add_noise(const Problem& problem, const Unknowns& z, double left, double opening, Workspace& w,
               Eigen::VectorXd& error) {
  const double mixed = problem.system.rows > 0 ? std::numeric_limits<double>::epsilon() * left : 0;
  Eigen::VectorXd& noise = w.projected;
  noise.setZero(problem.system.nv);
  add_law_sizes(problem.system, problem.parameters, z.q, w.kinematics, noise);
  noise = std::numeric_limits<double>::epsilon() * noise + 2 * extended_rounding * w.magnitudes.force;
  for (unsigned pattern = 0; pattern < 4; ++pattern) {
    for (Eigen::Index i = 0; i < w.residual.f.size(); ++i)
      w.residual.f[i] = noise_sign(pattern, i) * (noise[i] + mixed / problem.scaling.column[i]);
    for (Eigen::Index i = 0; i < w.residual.phi.size(); ++i)
      w.residual.phi[i] = noise_sign(pattern, i) *
                          (2 * extended_rounding * w.magnitudes.phi[i] + opening / problem.scaling.row[i]);
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
    error += w.scaled_step.cwiseProduct(problem.scaling.column).cwiseAbs();
  }
}

// The responses to noise forces (scaled) of this size, with signs in four patterns.
void add_responses(const Problem& problem, const Eigen::VectorXd& size, Workspace& w,
                   Eigen::VectorXd& error) {
  w.residual.phi.setZero();
  for (unsigned pattern = 0; pattern < 4; ++pattern) {
    for (Eigen::Index i = 0; i < size.size(); ++i)
      w.residual.f[i] = noise_sign(pattern, i) * size[i] / problem.scaling.column[i];
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
    if (w.scaled_step.allFinite()) error += w.scaled_step.cwiseProduct(problem.scaling.column).cwiseAbs();
  }
}

// What the solution for the last step rounds, x in w.step: that of a matrix beside K, by eps |K| |x| (Higham,
// chapter 9). A step is never shorter than the last digits of the coordinates, which a far one spreads to
// others where K couples it with them (Skeel's condition, |K^-1| |K| |x|; ibid., chapter 7).
void add_last_digits(const Problem& problem, const Unknowns& z, const DenseKkt& dense, Workspace& w,
                     Eigen::VectorXd& error) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  constexpr double beside_the_rest = 0.01; // less adds nothing that is worth knowing
  const Eigen::VectorXd& scale = problem.scaling.column;
  Eigen::VectorXd &x = w.step, &noise = w.projected;
  x = x.cwiseQuotient(scale).cwiseAbs();
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type != LinkType::spherical)
      x[link.v] = std::max(x[link.v], rounding * std::abs(z.q[link.q]) / scale[link.v]);
  noise = rounding * dense.stiffness().cwiseAbs().lazyProduct(x); // a product with gemv would allocate
  const auto rest = 2 * extended_rounding * w.magnitudes.force.cwiseProduct(scale);
  if ((noise.array() > beside_the_rest * rest.array()).any()) add_responses(problem, noise, w, error);
}

// Rows that count as dependent on others carry nothing of the load, though any part of it could be theirs: to
// them it acts by what is left of the combination that vanishes, here and within the error of the state.
void add_shared_loads(const Problem& problem, const Unknowns& z, const DenseKkt& dense, Workspace& w,
                      Eigen::VectorXd& error) {
  constexpr double takes_part = 1e-9; // of a combination
  const ConstraintSpace& rows = dense.constraints();
  const double off = error.cwiseQuotient(problem.scaling.column).lpNorm<Eigen::Infinity>();
  Eigen::VectorXd &noise = w.projected, &reach = w.step, &combination = w.scaled_phi, &left = w.scaled_force;
  noise.setZero(problem.system.nv);
  for (int k = 0; k < rows.rows() - rows.rank(); ++k) {
    rows.dependence(k, combination, left);
    double load = 0;
    reach.setZero(noise.size());
    for (Eigen::Index i = 0; i < combination.size(); ++i) {
      if (!(std::abs(combination[i]) > takes_part)) continue;
      load = std::max(load, std::abs(z.lambda[i] / problem.scaling.row[i]));
      reach = reach.cwiseMax(dense.jacobian().row(i).transpose().cwiseAbs());
    }
    noise += load * left.cwiseAbs();
    for (Eigen::Index v = 0; v < noise.size(); ++v)
      if (reach[v] > 0) noise[v] += load * off;
  }
  add_responses(problem, noise, w, error);
}

// Whether every axis points along one of the world's: then normalising rounds nothing.
bool has_plain_axes(const Problem& problem) {
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const LinkType type = problem.system.links[l].type;
    if ((type == LinkType::revolute || type == LinkType::prismatic) &&
        (problem.parameters.links[l].axis.array() != 0).count() > 1)
      return false;
  }
  return true;
}

// What the rounding of the scene's numbers on their way into the equations does to each coordinate: axes are
// normalised, lengths measured and positions subtracted in double precision, which the exact balance of
// these rounded numbers does not show. Springs of coordinates are taken as they are given.
void add_rounding_of_data(const Problem& problem, Workspace& w, Eigen::VectorXd& error) {
  const System& system = problem.system;
  error.setZero(system.nv);
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  const bool plain = has_plain_axes(problem);
  if (plain && system.rows == 0) return;
  for (const unsigned pattern : {0U, 2U}) {
    w.residual.f.setZero();
    for (std::size_t l = 0; l < system.links.size() && !plain; ++l) {
      const Link& link = system.links[l];
      const int n = link.type == LinkType::spherical ? 3 : 1;
      const double size =
          link.type == LinkType::prismatic ? w.magnitudes.link_force[l] : w.magnitudes.link_moment[l];
      for (int v = link.v; link.v >= 0 && v < link.v + n; ++v)
        w.residual.f[v] = noise_sign(pattern, v) * rounding * size;
    }
    for (Eigen::Index i = 0; i < w.residual.phi.size(); ++i)
      w.residual.phi[i] = noise_sign(pattern, i) * rounding * w.magnitudes.phi[i];
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
    if (w.scaled_step.allFinite()) error += w.scaled_step.cwiseProduct(problem.scaling.column).cwiseAbs();
  }
}

// The force along a null direction, at a distance along it.
class SoftDirection {
 public:
  SoftDirection(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& direction, Workspace& w)
      : p_(problem), z_(z), direction_(direction), w_(w) {
    move(0);
    here_ = force_;
  }

  // Whether there the imbalance exceeds the rounding of double precision.
  bool decides(double distance) {
    move(distance);
    if (!exceeds(2)) return false;
    // A straight step leaves a curved valley of the potential: the imbalance counts only where it remains
    // after Newton steps in the stiff directions. These leave some rounding of their own.
    for (int i = 0; i < 10 && exceeds(8); ++i) {
      const double before = force_;
      if (!std::isfinite(before)) return true;
      find_step_back();
      if (w_.scaled_step.lpNorm<Eigen::Infinity>() < 1) take(1);
      if (!(force_ < 0.5 * before)) return true;
    }
    return exceeds(8);
  }

 private:
  bool exceeds(double times) const { return !(force_ <= times * (here_ + noise_)); }

  void move(double distance) {
    moved_ = z_;
    w_.scaled_step = direction_;
    take(distance);
  }

  void take(double distance) {
    w_.step = distance * w_.scaled_step.cwiseProduct(p_.scaling.column);
    retract<double>(p_.system, w_.step, moved_.q);
    force_ = std::numeric_limits<double>::infinity();
    if (distance != 0 && !assemble(p_, moved_.q, 0, w_)) return;
    evaluate_with_multipliers(p_, moved_, w_);
    const Eigen::VectorXd terms = w_.magnitudes.force.cwiseProduct(p_.scaling.column);
    noise_ = std::numeric_limits<double>::epsilon() * direction_.cwiseAbs().dot(terms);
    force_ = std::abs(direction_.dot(w_.residual.f.cwiseProduct(p_.scaling.column)));
  }

  // The Newton step with a stiffness along the direction like those of the others.
  void find_step_back() {
    factor(p_, moved_, w_);
    const Eigen::MatrixXd& basis = w_.dense.constraints().basis();
    // Where the scale is none nothing is felt at all.
    const Eigen::ArrayXd unit =
        (w_.dense.hessian().scale().array() > 0).select(1 / w_.dense.hessian().scale().array(), 0);
    const Eigen::VectorXd stiffened =
        (basis.transpose() * direction_).cwiseProduct(unit.matrix()).normalized();
    const Eigen::VectorXd by_coordinate = stiffened.cwiseProduct(unit.matrix());
    stiffness_ = w_.dense.reduced();
    stiffness_ += by_coordinate * by_coordinate.transpose();
    hessian_.factor(stiffness_, w_.dense.noise(), p_.symmetric());
    const Eigen::VectorXd rhs = -basis.transpose() * w_.residual.f.cwiseProduct(p_.scaling.column);
    hessian_.solve(rhs, back_);
    w_.scaled_step = basis * back_;
  }

  const Problem& p_;
  const Unknowns& z_;
  const Eigen::VectorXd direction_;
  Workspace& w_;
  Unknowns moved_;
  ReducedHessian hessian_;
  Eigen::MatrixXd stiffness_;
  Eigen::VectorXd back_;
  double force_ = 0, noise_ = 0, here_ = 0;
};

// How far (scaled) the state can be moved along a null direction before double precision sees an imbalance;
// not finite where it never does.
double undetermined_distance(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& direction,
                             Workspace& w) {
  SoftDirection soft(problem, z, direction, w.elsewhere());
  double farthest = 0;
  bool decided = false;
  for (const double side : {1., -1.}) {
    double distance = 1e-10;
    while (distance < 0.1 && !soft.decides(side * distance))
      distance *= 2;
    if (!(distance < 0.1)) continue;
    farthest = std::max(farthest, distance);
    decided = true;
  }
  return decided ? farthest : std::numeric_limits<double>::infinity();
}

// The displacement (scaled) that the residual force along a null direction, which the Newton steps left
// alone, causes by the stiffness there; none where that is no more than rounding.
double displacement_along(const Problem& problem, const Eigen::VectorXd& direction, const Workspace& w) {
  const Eigen::VectorXd size = direction.cwiseAbs();
  const double force =
      std::abs(direction.dot(w.residual.f.cwiseProduct(problem.scaling.column))) +
      8 * extended_rounding * size.dot(w.magnitudes.force.cwiseProduct(problem.scaling.column));
  const double stiffness = std::abs(direction.dot(w.dense.stiffness() * direction));
  const double noise =
      8 * std::numeric_limits<double>::epsilon() * size.dot(w.dense.stiffness().cwiseAbs() * size);
  return stiffness > noise ? force / stiffness : 0;
}

void add_singular_directions(const Problem& problem, const Unknowns& z, Workspace& w, ErrorEstimate& error) {
  Eigen::MatrixXd null_space = w.dense.constraints().basis() * w.dense.hessian().null_basis();
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(null_space.cols());
  evaluate_rounded(problem, z, w);
  for (Eigen::Index c = 0; c < null_space.cols(); ++c) {
    const double size = null_space.col(c).lpNorm<Eigen::Infinity>();
    if (!(size > 0)) continue;
    null_space.col(c) /= size;
    displacement[c] = displacement_along(problem, null_space.col(c), w);
  }
  // What is never determined along a mixture of many is not along any of them.
  const bool none = null_space.cols() > few_null_directions &&
                    !std::isfinite(undetermined_distance(problem, z, mixture_of(null_space), w));
  for (Eigen::Index c = 0; c < null_space.cols(); ++c) {
    if (null_space.col(c).isZero(0)) continue;
    const double distance = none ? std::numeric_limits<double>::infinity()
                                 : undetermined_distance(problem, z, null_space.col(c), w);
    const Eigen::VectorXd moved = null_space.col(c).cwiseProduct(problem.scaling.column).cwiseAbs();
    if (std::isfinite(distance))
      error.solution = error.solution.cwiseMax(std::max(distance, 4 * displacement[c]) * moved);
    else // neutral, or lost in rounding: stability decides which
      error.undetermined = error.undetermined.cwiseMax(moved);
  }
}

// The correction of z by the factors at hand, scaled, in the workspace; returns its size. Multipliers are
// corrected like the rest, so that the forces they balance do not drown what they cannot.
double find_correction(const Problem& problem, const Unknowns& z, Workspace& w) {
  evaluate_rounded(problem, z, w);
  newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
  return w.scaled_step.lpNorm<Eigen::Infinity>();
}

// Whether corrections by the same factors shrink so slowly that the balance bends within them, as a table of
// torques does at the foot of a steep interval: then stiffness and eigenvalues are not those of the factors
// either. By double precision's last digits they shrink no further.
bool bends_within(double size, double previous) {
  constexpr double straight = 1e-6;
  return size > straight * previous && size > tolerance::least_closing_step && std::isfinite(previous);
}

// A shift that kept null directions still shortens the steps along soft ones: without it, unless there is a
// null direction indeed.
void drop_shift(const Problem& problem, Workspace& w) {
  KktSystem& kkt = w.kkt(problem);
  const double shift = kkt.shift();
  if (shift == 0) return;
  kkt.factor();
  if (kkt.null_count() > kkt.force_free_count()) kkt.factor(shift);
}

} // namespace

void evaluate_extended(const Problem& problem, const Unknowns& z, Workspace& w) {
  w.q_extended = z.q.cast<Extended>();
  w.lambda_extended = z.lambda.cast<Extended>();
  evaluate_extended(problem, w);
}

void evaluate_extended(const Problem& problem, Workspace& w) {
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type == LinkType::spherical) w.q_extended.segment<4>(link.q).normalize();
  forward<Extended>(problem.system, problem.parameters, w.q_extended, 0, w.kinematics_extended);
  evaluate_residual<Extended>(problem.system, problem.parameters, w.q_extended, w.lambda_extended,
                              w.kinematics_extended, w.residual_extended);
}

void refine(const Problem& problem, Unknowns& z, const NewtonOutcome& outcome, Workspace& w,
            ErrorEstimate& estimate) {
  const System& system = problem.system;
  Eigen::VectorXd& error = estimate.solution;
  error.setZero(system.nv);
  estimate.undetermined.setZero(system.nv);
  estimate.data.setZero(system.nv);
  estimate.singular_loops = false;
  if (system.nv == 0) return;
  drop_shift(problem, w);
  const DenseKkt* dense = w.matrices(problem);
  double previous = std::numeric_limits<double>::infinity(), left = 0, opening = 0;
  double bent = 0;         // the first correction within which the balance bends, scaled
  bool straightens = true; // else that is a root of higher order
  constexpr int last_round = 4, most_factored = 24;
  for (int round = 0, factored = 0; round <= last_round + factored; ++round) {
    double size = find_correction(problem, z, w);
    if (dense && !outcome.linear && !dense->singular() && factored < most_factored &&
        bends_within(size, previous)) {
      if (factored++ == 0) bent = size;
      factor_at(problem, z, w);
      size = find_correction(problem, z, w);
    }
    straightens = size < 0.1 * previous;
    left = w.residual.f.cwiseProduct(problem.scaling.column).lpNorm<Eigen::Infinity>();
    if (!w.scaled_step.allFinite()) break;
    w.step = w.scaled_step.cwiseProduct(problem.scaling.column);
    error = w.step.cwiseAbs();
    if (dense && dense->constraints().rank() < system.rows) {
      w.scaled_phi = w.residual.phi.cwiseProduct(problem.scaling.row);
      w.scaled_phi.noalias() += dense->jacobian() * w.scaled_step;
      opening = w.scaled_phi.lpNorm<Eigen::Infinity>();
    }
    // No longer contracting: rounding, or a singular state. Beside a double root steps are halved.
    if (size > (factored > 0 ? 0.75 : 0.5) * previous) {
      error *= 4 * std::max(1., previous / size);
      break;
    }
    retract<double>(system, w.step, z.q);
    z.lambda += w.trial.lambda;
    previous = size;
    if (size < tolerance::least_closing_step) break;
    if (round == last_round + factored)
      error *= 4; // converging slowly: what is left may be more than the last correction
  }
  if (bent > 0 && !straightens) error = error.cwiseMax(4 * bent * problem.scaling.column);
  if (outcome.linear) // to a root of order n the steps shrink by (n - 1) / n: n - 1 of the last are left
    error = error.cwiseMax(4 * outcome.last_step * problem.scaling.column);
  const bool stepped = w.scaled_step.allFinite();
  add_noise(problem, z, left, opening, w, error);
  if (dense && stepped) add_last_digits(problem, z, *dense, w, error);
  if (dense && dense->constraints().rank() < system.rows && error.allFinite())
    add_shared_loads(problem, z, *dense, w, error);
  add_rounding_of_data(problem, w, estimate.data);
  error += extended_rounding * problem.scaling.column;
  estimate.singular_loops = at_singular_loops(problem, z, w);
  if (estimate.singular_loops && dense->constraints().rank() < std::min(system.rows, system.nv))
    error += 4 * std::sqrt(opening + extended_rounding) * problem.scaling.column;
  if (dense && dense->singular()) add_singular_directions(problem, z, w, estimate);
  for (const Link& link : system.links) {
    if (link.v < 0) continue;
    const int n = link.type == LinkType::spherical ? 3 : 1;
    for (int k = 0; k < n; ++k) {
      const double value = n == 3 ? 1 : std::abs(z.q[link.q]);
      error[link.v + k] += 2 * std::numeric_limits<double>::epsilon() * value;
    }
  }
}

bool is_pushed_where_soft(const FactoredState& at) {
  constexpr double of_data = 64 * std::numeric_limits<double>::epsilon();
  const DenseKkt* dense = at.w.matrices(at.problem);
  if (!dense || !at.problem.symmetric() || !dense->singular()) return false;
  const Eigen::VectorXd& scale = at.problem.scaling.column;
  Workspace& w = at.w.elsewhere();
  evaluate_rounded(at.problem, at.z, w);
  const Eigen::MatrixXd soft =
      scale.asDiagonal() * (dense->constraints().basis() * dense->hessian().null_basis());
  for (Eigen::Index c = 0; c < soft.cols(); ++c)
    if (std::abs(soft.col(c).dot(w.residual.f)) > of_data * soft.col(c).cwiseAbs().dot(at.w.magnitudes.force))
      return true;
  return false;
}

} // namespace flyball
