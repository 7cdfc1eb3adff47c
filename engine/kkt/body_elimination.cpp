#include "engine/kkt/body_elimination.hpp"

#include "engine/linear/spectral.hpp"

namespace flyball {
namespace {

constexpr int most_null_directions = 200; // of which all that follows is told

} // namespace

void BodyElimination::linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                const Residual<double>& residual, const Magnitudes& magnitudes) {
  take_in(problem, z, k, residual, magnitudes, Lines::exact);
}

bool BodyElimination::linearize_convex(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                       const Residual<double>& residual, const Magnitudes& magnitudes) {
  if (!equations_.compressed()) return false;
  take_in(problem, z, k, residual, magnitudes, Lines::convex);
  return true;
}

void BodyElimination::take_in(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                              const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines) {
  equations_.assemble(problem, z, k, residual, magnitudes, lines);
  start(zero, false);
}

void BodyElimination::linearize_metric(const Problem& problem, const Kinematics<double>& k,
                                       double tolerance) {
  equations_.assemble_metric(problem, k);
  start(tolerance, true);
}

void BodyElimination::start(double tolerance, bool metric_alone) {
  tolerance_ = tolerance;
  metric_alone_ = metric_alone;
  rows_ = equations_.rows();
  mass_ = equations_.mass();
  set_loose_directions();
}

void BodyElimination::factor(double shift) {
  shift_ = shift;
  flat_.resize(loose_);
  factors_.factor(equations_.pattern(), equations_.sum(1, shift), tolerance_);
  // What the metric, which is positive definite, leaves singular are the constraints.
  if (factors_.nullity() == 0 || metric_alone_) {
    redundant_ = factors_.nullity();
  } else if (factors_.nullity() != redundant_) {
    constraints_.factor(equations_.pattern(), equations_.sum(0, 1), zero);
    redundant_ = std::min(constraints_.nullity(), factors_.nullity());
  }
  const int of_constraints = equations_.multipliers() - redundant_;
  negative_ = equations_.symmetric() ? std::max(0, factors_.negative() - of_constraints) : 0;
  add_flat_directions();
}

// What nothing holds, in coordinates: the first of the flat directions, whatever the shift.
void BodyElimination::set_loose_directions() {
  const std::vector<bool>& loose = equations_.loose();
  loose_ = 0;
  for (std::size_t u = 0; u < loose.size(); ++u) {
    if (!loose[u]) continue;
    const BodyNode& x = equations_.nodes()[static_cast<int>(u / 6)];
    if (flat_.size() == loose_) flat_.emplace_back();
    Flat& flat = flat_[loose_];
    flat.clear();
    for (int c = 0; c < x.columns; ++c)
      if (const double share = x.d(static_cast<Eigen::Index>(u % 6), c); share != 0)
        flat.emplace_back(x.v[static_cast<std::size_t>(c)], share);
    if (!flat.empty()) ++loose_;
  }
  flat_.resize(loose_);
}

// What the factors leave singular beside the redundant rows.
void BodyElimination::add_flat_directions() {
  const int count = factors_.nullity() - redundant_;
  if (count <= 0) return;
  if (factors_.nullity() > most_null_directions) {
    flat_.resize(flat_.size() + static_cast<std::size_t>(count));
    return;
  }
  // In coordinates, what is left of the null space is that of the stiffness.
  const Eigen::MatrixXd& space = factors_.null_space();
  const int coordinates = equations_.coordinates();
  Eigen::MatrixXd motions(coordinates, space.cols());
  Eigen::VectorXd column;
  for (Eigen::Index i = 0; i < space.cols(); ++i)
    equations_.take(space.col(i), motions.col(i));
  PivotedQr order;
  if (!order.compute(motions)) {
    flat_.resize(flat_.size() + static_cast<std::size_t>(count)); // counted, not named
    return;
  }
  for (int i = 0; i < count; ++i) {
    column = motions.col(order.permutation()[i]);
    const double size = column.lpNorm<Eigen::Infinity>();
    Flat flat;
    for (int v = 0; v < coordinates; ++v)
      if (std::abs(column[v]) > 1e-12 * size) flat.emplace_back(v, column[v] / size);
    flat_.push_back(std::move(flat));
  }
}

void BodyElimination::solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing,
                               Eigen::VectorXd& x, Eigen::VectorXd& lambda) {
  x.setZero(equations_.coordinates());
  lambda.setZero(rows_);
  equations_.put(rhs, closing, held_);
  if (held_.size() > 0) factors_.solve(held_, enough);
  equations_.take(held_, x, lambda);
}

double BodyElimination::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
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

void BodyElimination::direction_of(const Flat& flat, Eigen::VectorXd& x) {
  x.setZero(equations_.coordinates());
  for (const auto& [v, share] : flat)
    x[v] = share;
}

} // namespace flyball
