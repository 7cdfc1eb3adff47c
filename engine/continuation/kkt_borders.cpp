#include "engine/continuation/kkt_borders.hpp"

#include "engine/solve/newton.hpp"

#include <random>

namespace flyball {

double KktBorders::linearize(const Unknowns& z, double parameter) {
  const Problem problem = family_.problem();
  n_ = problem.system.nv;
  find_rates(z, parameter);
  const double left = scaled_residual(problem, w_);
  if (!std::isfinite(left)) return left;
  force_ = w_.residual.f.cwiseProduct(problem.scaling.column);
  loops_ = w_.residual.phi.cwiseProduct(problem.scaling.row);
  old_lambda_ = z.lambda.cwiseQuotient(problem.scaling.row);
  bordered_.linearize(problem, z, w_);
  bordered_.set_columns(force_rate_, loop_rate_);
  return left;
}

void KktBorders::set_row(const Eigen::VectorXd& row) {
  bordered_.set_rows({row.head(n_).transpose(), {}, row.tail(1)});
}

bool KktBorders::step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
                      Eigen::VectorXd& lambda) {
  BorderedKkt::Vector out;
  set_row(border);
  if (!bordered_.solve({-force_, -loops_, Eigen::VectorXd::Constant(1, along)}, out)) return false;
  step.resize(n_ + 1);
  step << out.x, out.m;
  lambda = (old_lambda_ + out.lambda).cwiseProduct(family_.problem().scaling.row);
  return true;
}

bool KktBorders::direction(const Eigen::VectorXd& border, Eigen::VectorXd& result) {
  BorderedKkt::Vector out;
  set_row(border);
  if (!bordered_.solve(
          {Eigen::VectorXd::Zero(n_), Eigen::VectorXd::Zero(loops_.size()), Eigen::VectorXd::Ones(1)}, out))
    return false;
  result.resize(n_ + 1);
  result << out.x, out.m;
  return true;
}

bool KktBorders::iterate_inversely(int iterations, BorderedKkt::Vector& v, double& rate) {
  std::mt19937 random(7);
  v.x.resize(n_);
  for (double& entry : v.x)
    entry = static_cast<double>(random()) / 2147483648. - 1;
  v.m.setOnes(1);
  BorderedKkt::Vector next;
  for (int i = 0; i < iterations; ++i) {
    const double length = std::hypot(v.x.norm(), v.m[0]);
    if (!(length > 0)) return false;
    v.x *= bordered_.force_size() / length;
    v.lambda.setZero(loops_.size());
    v.m /= length;
    if (!bordered_.eliminate(v, next)) return false;
    std::swap(v, next);
    rate = 1 / std::hypot(v.x.norm(), v.m[0]);
  }
  return std::isfinite(rate);
}

std::optional<double> KktBorders::determinant(const Eigen::VectorXd& border) {
  BorderedKkt::Vector v;
  double rate = 0;
  const Problem problem = family_.problem();
  KktSystem& factors = w_.kkt(problem);
  if (!factors.inertia_is_certain(problem, w_)) return {};
  set_row(border);
  if (!iterate_inversely(3, v, rate)) return 0;
  const bool negative = (factors.negative_count() % 2 == 1) != (bordered_.complement()(0, 0) < 0);
  return negative ? -rate : rate;
}

bool KktBorders::second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) {
  if (n_ == 0) return false;
  BorderedKkt::Vector v;
  double rate = 0;
  set_row(tangent);
  if (!iterate_inversely(5, v, rate)) return false;
  out.resize(n_ + 1);
  out << v.x, v.m;
  out -= tangent * tangent.dot(out);
  if (!(out.norm() > 0)) return false;
  out.normalize();
  return true;
}

} // namespace flyball
