#include "engine/kkt/sparse_kkt.hpp"

#include "engine/linear/spectral.hpp"

namespace flyball {
namespace {

constexpr int most_null_directions = 200; // that are solved for whole

} // namespace

void SparseKkt::linearize(const Problem& problem, const Unknowns& z, const Evaluation& at) {
  take_in(problem, z, at, Lines::exact);
}

bool SparseKkt::linearize_convex(const Problem& problem, const Unknowns& z, const Evaluation& at) {
  if (!equations_.compressed()) return false;
  take_in(problem, z, at, Lines::convex);
  return true;
}

void SparseKkt::take_in(const Problem& problem, const Unknowns& z, const Evaluation& at, Lines lines) {
  equations_.assemble(problem, z, at.kinematics, at.residual, at.magnitudes, lines);
  rows_ = equations_.rows();
  size_ = equations_.coordinates();
  mass_ = equations_.mass();
  set_force_free_directions();
}

void SparseKkt::factor(double shift) {
  shift_ = shift;
  directions_.resize(static_cast<std::size_t>(force_free_));
  factors_.factor(equations_.pattern(), equations_.sum(1, shift), zero);
  // What the metric, which is positive definite, leaves singular are the constraints.
  if (factors_.nullity() == 0) {
    redundant_ = 0;
  } else if (factors_.nullity() != redundant_) {
    counted_.factor(equations_.pattern(), equations_.sum(0, 1), zero);
    redundant_ = std::min(counted_.nullity(), factors_.nullity());
  }
  const int of_constraints = equations_.multipliers() - redundant_;
  negative_ = equations_.symmetric() ? std::max(0, factors_.negative() - of_constraints) : 0;
  add_null_directions();
  null_ = static_cast<int>(directions_.size());
}

// What nothing holds, in coordinates: the first of the null directions, whatever the shift.
void SparseKkt::set_force_free_directions() {
  const std::vector<bool>& unconstrained = equations_.unconstrained();
  std::size_t count = 0;
  for (std::size_t u = 0; u < unconstrained.size(); ++u) {
    if (!unconstrained[u]) continue;
    const BodyNode& x = equations_.nodes()[static_cast<int>(u / 6)];
    if (directions_.size() == count) directions_.emplace_back();
    NullDirection& direction = directions_[count];
    direction.clear();
    for (int c = 0; c < x.columns; ++c)
      if (const double share = x.d(static_cast<Eigen::Index>(u % 6), c); share != 0)
        direction.emplace_back(x.v[static_cast<std::size_t>(c)], share);
    if (!direction.empty()) ++count;
  }
  directions_.resize(count);
  force_free_ = static_cast<int>(count);
}

// What the factors leave singular beside the redundant rows.
void SparseKkt::add_null_directions() {
  const int count = factors_.nullity() - redundant_;
  if (count <= 0) return;
  if (factors_.nullity() > most_null_directions) {
    directions_.resize(directions_.size() + static_cast<std::size_t>(count));
    return;
  }
  // In coordinates, what is left of the null space is that of the stiffness.
  const Eigen::MatrixXd& space = factors_.null_space();
  const int coordinates = equations_.coordinates();
  Eigen::MatrixXd motions(coordinates, space.cols());
  Eigen::VectorXd column;
  for (Eigen::Index i = 0; i < space.cols(); ++i)
    equations_.extract_solution(space.col(i), motions.col(i));
  PivotedQr order;
  if (!order.compute(motions)) {
    directions_.resize(directions_.size() + static_cast<std::size_t>(count)); // counted, not named
    return;
  }
  for (int i = 0; i < count; ++i) {
    column = motions.col(order.permutation()[i]);
    const double size = column.lpNorm<Eigen::Infinity>();
    NullDirection direction;
    for (int v = 0; v < coordinates; ++v)
      if (std::abs(column[v]) > 1e-12 * size) direction.emplace_back(v, column[v] / size);
    directions_.push_back(std::move(direction));
  }
}

void SparseKkt::solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing,
                         Eigen::VectorXd& x, Eigen::VectorXd& lambda) {
  x.setZero(equations_.coordinates());
  lambda.setZero(rows_);
  equations_.assemble_rhs(rhs, closing, reduced_);
  if (reduced_.size() > 0) factors_.solve(reduced_, enough);
  equations_.extract_solution(reduced_, x, lambda);
}

double SparseKkt::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  const BodyNodes& nodes = equations_.nodes();
  const auto count = static_cast<std::size_t>(nodes.size());
  motion_.resize(count);
  wrench_.resize(count);
  product.resize(x.size());
  double square = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const BodyNode& n = nodes[static_cast<int>(i)];
    Vec6& motion = motion_[i];
    motion.setZero();
    if (n.parent >= 0) motion = carried(motion_[static_cast<std::size_t>(n.parent)], n.lever);
    for (int c = 0; c < n.columns; ++c) {
      const int v = n.v[static_cast<std::size_t>(c)];
      motion += n.s.col(c) * x[v];
      product[v] = n.weight[c] * x[v];
      square += product[v] * x[v];
    }
    wrench_[i] = nodes.scaled(inertia_matrix(n)) * motion;
    square += motion.dot(wrench_[i]);
  }
  for (std::size_t i = count; i-- > 0;) {
    const BodyNode& n = nodes[static_cast<int>(i)];
    for (int c = 0; c < n.columns; ++c)
      product[n.v[static_cast<std::size_t>(c)]] += n.s.col(c).dot(wrench_[i]);
    if (n.parent >= 0) wrench_[static_cast<std::size_t>(n.parent)] += about(wrench_[i], n.lever);
  }
  return square;
}

void SparseKkt::direction_of(const NullDirection& direction, Eigen::VectorXd& x) {
  x.setZero(equations_.coordinates());
  for (const auto& [v, share] : direction)
    x[v] = share;
}

void SparseKkt::factor_constraints(const Problem& problem, const Evaluation& at) {
  rows_ = problem.system.rows;
  size_ = problem.system.nv;
  length_ = problem.parameters.length;
  if (rows_ == 0) return;
  const double tolerance = rank_tolerance(problem, at.residual.phi); // pivots are singular values squared
  constraints_.factor(problem, at.kinematics, std::max(tolerance * tolerance, 1e-10));
}

bool SparseKkt::inertia_is_certain(const Problem& problem, const Evaluation& at) {
  if (problem.system.rows == 0) return true;
  factor_constraints(problem, at);
  return redundant_ >= problem.system.rows - independent_rows(problem, at);
}

int SparseKkt::independent_rows(const Problem& problem, const Evaluation& at) {
  const int rows = problem.system.rows;
  if (rows == 0 || constraints_.redundant() <= rows) return rows - (rows > 0 ? constraints_.redundant() : 0);
  // Chains of bodies without mass leave the metric singular by itself, which its pivots do not distinguish
  // from redundant rows: the rank of the rows alone.
  Linearization l;
  linearize_constraints(problem.system, problem.parameters, at.kinematics, l);
  PivotedQr qr;
  if (!qr.compute(problem.scaling.column.asDiagonal() * l.constraint.transpose() *
                  problem.scaling.row.asDiagonal()))
    return 0;
  return static_cast<int>(qr.rank(rank_tolerance(problem, at.residual.phi)));
}

void SparseKkt::balance(const Eigen::VectorXd& force, Eigen::VectorXd& lambda) {
  lambda.setZero(rows_);
  if (rows_ == 0) return;
  none_.setZero(rows_);
  constraints_.solve(force, none_, unused_, lambda);
}

void SparseKkt::close(const Eigen::VectorXd& closing, Eigen::VectorXd& x) {
  x.setZero(size_);
  if (rows_ == 0) return;
  none_.setZero(size_);
  constraints_.solve(none_, closing, x, unused_);
}

void SparseKkt::project(const Eigen::VectorXd& force, Eigen::VectorXd& left) {
  left = force;
  if (rows_ == 0) return;
  none_.setZero(rows_);
  constraints_.solve(force, none_, left, unused_);
  left *= constraints_.mass() * length_ * length_;
}

} // namespace flyball
