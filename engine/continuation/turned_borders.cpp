#include "engine/continuation/turned_borders.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/solve/newton.hpp"

#include <limits>

namespace flyball {

double TurnedBorders::linearize(const Unknowns& z, double parameter) {
  family_.set(parameter);
  z_ = z;
  balance_.emplace(family_.problem(), z_, *family_.ties(), family_.mechanism(), w_);
  if (!balance_->usable()) return std::numeric_limits<double>::infinity();
  rate_ = family_.scale() * balance_->rate(family_.rates());
  return balance_->residual();
}

Eigen::MatrixXd TurnedBorders::bordered(const Eigen::VectorXd& border) const {
  const Eigen::Index size = rate_.size(), moving = border.size() - 1;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size + 1, size + 1);
  out.topLeftCorner(size, size) = balance_->matrix();
  out.col(size).head(size) = rate_;
  out.row(size).head(moving) = border.head(moving).transpose();
  out(size, size) = border[moving];
  return out;
}

Eigen::VectorXd TurnedBorders::direction_of(const Eigen::VectorXd& all) const {
  const Eigen::Index moving = all.size() - 1 - balance_->multipliers();
  Eigen::VectorXd out(moving + 1);
  out << all.head(moving), all[all.size() - 1];
  return out;
}

bool TurnedBorders::step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
                         Eigen::VectorXd& lambda) {
  if (!balance_->usable()) return false;
  Eigen::VectorXd rhs(rate_.size() + 1);
  rhs << -balance_->left(), along;
  const auto solved = solve_square(bordered(border), rhs);
  if (!solved) return false;
  step = direction_of(*solved);
  lambda = balance_->lambda_of(solved->segment(border.size() - 1, balance_->multipliers()));
  return true;
}

bool TurnedBorders::direction(const Eigen::VectorXd& border, Eigen::VectorXd& out) {
  if (!balance_->usable()) return false;
  const auto solved = solve_square(bordered(border), Eigen::VectorXd::Unit(rate_.size() + 1, rate_.size()));
  if (!solved) return false;
  out = direction_of(*solved);
  return true;
}

std::optional<double> TurnedBorders::determinant(const Eigen::VectorXd& border) {
  if (!balance_->usable()) return {};
  const Eigen::MatrixXd m = bordered(border);
  const auto values = singular_values(m);
  if (!values) return {};
  Lu lu;
  const bool regular = lu.compute(m) && (*values)[0] > 0;
  return regular ? lu.sign_of_determinant() * (*values)[values->size() - 1] / (*values)[0] : 0;
}

bool TurnedBorders::second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) {
  if (!balance_->usable()) return false;
  Eigen::MatrixXd open(rate_.size(), rate_.size() + 1);
  open << balance_->matrix(), rate_;
  const auto parts = singular_vectors(open);
  if (!parts) return false;
  Eigen::MatrixXd null_space(tangent.size(), 2);
  for (const Eigen::Index i : {0, 1})
    null_space.col(i) = direction_of(parts->right.col(rate_.size() - i));
  return off_tangent(null_space, tangent, out);
}

} // namespace flyball
