#include "engine/kkt/speeds_kkt.hpp"

#include "engine/kkt/speed_time.hpp"

#include <algorithm>
#include <utility>

namespace flyball {
namespace {

bool is_positive_definite(const Eigen::MatrixXd& a) {
  ReducedHessian symmetric;
  symmetric.factor((a + a.transpose()) / 2, Eigen::VectorXd::Zero(a.rows()), true);
  return symmetric.positive_definite();
}

} // namespace

void SpeedsKkt::linearize(const Problem& problem, const Unknowns& z, const Evaluation& at) {
  const System& system = problem.system;
  const Eigen::VectorXd& unit = problem.scaling.column;
  tree_.linearize(problem, z, at);
  size_ = system.nv;
  rows_ = 0;
  laws_alone_ = problem.parameters.phase_free;
  products_.linearize_forces(problem, z, at.kinematics, at.residual, !laws_alone_);
  mass_ = tree_.mass();
  speeds_.clear();
  for (const DriveTorqueElement& torque : system.torques)
    speeds_.push_back(system.links[static_cast<std::size_t>(torque.link)].v);
  const auto count = static_cast<Eigen::Index>(speeds_.size());
  columns_.resize(size_, count);
  resists_.resize(count, count);
  inertia_.resize(0); // until it is asked for
  time_ = speed_time(problem);
  for (Eigen::Index i = 0; i < count; ++i) {
    work_ = Eigen::VectorXd::Unit(size_, speeds_[static_cast<std::size_t>(i)]);
    products_.velocity(work_, product_);
    columns_.col(i) = product_;
  }
  const auto place = [&](int v) { return std::ranges::find(speeds_, v) - speeds_.begin(); };
  by_value_ = drive_torque_entries(system, problem.parameters, z.q, at.kinematics, false);
  for (DriveTorqueEntry& e : by_value_)
    e.value *= unit[e.row] * unit[e.column];
  for (const DriveTorqueEntry& e : drive_torque_entries(system, problem.parameters, z.q, at.kinematics, true))
    if (const auto by = place(e.column); by < count)
      columns_(e.row, by) += e.value * unit[e.row] * unit[e.column];
    else // a rate that is zero in steady states: no part of the matrix, but the law depends on it
      by_value_.push_back({e.row, e.column, 0});
  for (Eigen::Index i = 0; i < count; ++i) {
    resists_.row(i) = columns_.row(speeds_[static_cast<std::size_t>(i)]);
    columns_.row(speeds_[static_cast<std::size_t>(i)]).setZero();
  }
}

void SpeedsKkt::rows_times(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  if (!laws_alone_) products_.stiffness(x, product_);
  out.resize(static_cast<Eigen::Index>(speeds_.size()));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const int v = speeds_[static_cast<std::size_t>(i)];
    out[i] = laws_alone_ ? 0 : product_[v];
    for (const DriveTorqueEntry& e : by_value_)
      if (e.row == v) out[i] += e.value * x[e.column];
  }
}

void SpeedsKkt::factor(double shift) {
  shift_ = shift;
  tree_.factor(shift);
  const auto count = static_cast<Eigen::Index>(speeds_.size());
  response_.resize(size_, count);
  Eigen::MatrixXd border = resists_;
  if (shift != 0) {
    find_inertia();
    border.diagonal() += shift * inertia_;
  }
  Eigen::VectorXd noise(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    tree_.solve(columns_.col(i), answer_);
    response_.col(i) = answer_;
    rows_times(answer_, rest_);
    noise[i] = rounding * (std::abs(border(i, i)) + std::abs(rest_[i]));
    border.col(i) -= rest_;
  }
  border_.factor(border, noise, false);
  schur_complement_ = std::move(border);
  known_ = tree_.known() && border_.known();
  force_free_ = tree_.force_free_count();
  directions_ = tree_.null_directions();
  if (border_.singular()) {
    const Eigen::MatrixXd shares = border_.null_basis();
    for (Eigen::Index c = 0; c < shares.cols(); ++c) {
      NullDirection& direction = directions_.emplace_back();
      for (Eigen::Index i = 0; i < count; ++i)
        direction.emplace_back(speeds_[static_cast<std::size_t>(i)], shares(i, c));
    }
  }
  null_ = static_cast<int>(directions_.size());
  negative_ = tree_.negative_count();
}

void SpeedsKkt::solve_to(double, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing,
                         Eigen::VectorXd& x, Eigen::VectorXd& lambda) {
  tree_.solve(rhs, closing, x, lambda);
  rows_times(x, rest_);
  for (Eigen::Index i = 0; i < rest_.size(); ++i)
    rest_[i] = rhs[speeds_[static_cast<std::size_t>(i)]] - rest_[i];
  border_.solve(rest_, answer_);
  x.noalias() -= response_ * answer_;
  for (Eigen::Index i = 0; i < answer_.size(); ++i)
    x[speeds_[static_cast<std::size_t>(i)]] = answer_[i];
}

// The tree's metric of what moves on the shafts, and the shafts' own inertia.
double SpeedsKkt::with_speeds(const Eigen::VectorXd& x, double square, Eigen::VectorXd& product) const {
  for (Eigen::Index i = 0; i < inertia_.size(); ++i) {
    const int v = speeds_[static_cast<std::size_t>(i)];
    product[v] = inertia_[i] * x[v];
    square += product[v] * x[v];
  }
  return square;
}

void SpeedsKkt::find_inertia() {
  if (inertia_.size() > 0) return;
  inertia_.resize(static_cast<Eigen::Index>(speeds_.size()));
  for (Eigen::Index i = 0; i < inertia_.size(); ++i) {
    const int v = speeds_[static_cast<std::size_t>(i)];
    work_ = Eigen::VectorXd::Unit(size_, v);
    products_.inertia(work_, product_);
    inertia_[i] = time_ * product_[v];
  }
}

double SpeedsKkt::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  find_inertia();
  return with_speeds(x, tree_.metric(x, product), product);
}

double SpeedsKkt::metric_of_solution(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  return metric(x, product); // the tree's own solution was another
}

void SpeedsKkt::direction_of(const NullDirection& direction, Eigen::VectorXd& x) {
  const bool of_speeds =
      !direction.empty() && std::ranges::find(speeds_, direction.front().first) != speeds_.end();
  if (!of_speeds) {
    tree_.direction_of(direction, x);
    return;
  }
  x.setZero(size_);
  for (const auto& [v, share] : direction) {
    const auto i = std::ranges::find(speeds_, v) - speeds_.begin();
    x -= share * response_.col(i);
    x[v] += share;
  }
}

bool SpeedsKkt::keeps_minimum() const {
  return shift_ == 0 && tree_.positive_definite() && by_value_.empty() && is_positive_definite(resists_);
}

bool SpeedsKkt::is_definite() const {
  return tree_.negative_count() == 0 && is_positive_definite(schur_complement_);
}

} // namespace flyball
