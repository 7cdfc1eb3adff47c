#include "engine/continuation/kkt_borders.hpp"

#include "engine/linear/largest.hpp"
#include "engine/solve/newton.hpp"
#include "engine/stability/pivot_stability.hpp"

#include <random>

namespace flyball {
namespace {

constexpr int most_refinements = 8;
constexpr double rounding = 1e-15, enough = 1e-8; // of the terms of the equations
constexpr double least_terms = 1e-5; // of the loads: what a step so short leaves is rounding of these

bool finite(const Eigen::VectorXd& v) {
  return std::isfinite(v.sum());
}

// Of the stiffness for moving the mechanism as a whole: the first shift tried.
constexpr double least_shift = 1e-10;

} // namespace

double KktBorders::linearize(const Unknowns& z, double parameter) {
  const Problem problem = family_.problem();
  n_ = problem.system.nv;
  find_rates(z, parameter);
  const double left = scaled_residual(problem, w_);
  if (!std::isfinite(left)) return left;
  force_ = w_.residual.f.cwiseProduct(problem.scaling.column);
  loops_ = w_.residual.phi.cwiseProduct(problem.scaling.row);
  old_lambda_ = z.lambda.cwiseQuotient(problem.scaling.row);
  products_.linearize(problem, z, w_.kinematics, w_.residual);
  factor(problem, z, w_);
  KktSystem& e = factors();
  const double reach = problem.parameters.length;
  force_size_ = force_size();
  double shift = least_shift * force_size_ / (e.mass() * reach * reach);
  for (int i = 0; i < 4 && e.null_count() > e.force_free_count() && std::isfinite(shift); ++i, shift *= 100)
    e.factor(shift);
  e.solve(force_rate_, loop_rate_, rate_step_, rate_multipliers_);
  return left;
}

// Of forces, in scaled units: a state without loads has stiffness only, one without stiffness loads only.
double KktBorders::force_size() {
  const Problem problem = family_.problem();
  const double loads = largest(w_.magnitudes.force.cwiseProduct(problem.scaling.column));
  if (loads > 0) return loads;
  const double stiffness = products_.stiffness_terms(Eigen::VectorXd::Ones(n_)) / std::sqrt(n_);
  return stiffness > 0 ? stiffness : 1;
}

double KktBorders::delta(const Eigen::VectorXd& border) const {
  return border[n_] - border.head(n_).dot(rate_step_);
}

bool KktBorders::eliminate(const Eigen::VectorXd& border, const Bordered& rhs, Bordered& out) {
  const double pivot = delta(border);
  if (pivot == 0 || !std::isfinite(pivot)) return false;
  factors().solve(rhs.x, rhs.lambda, out.x, out.lambda);
  out.m = (rhs.m - border.head(n_).dot(out.x)) / pivot;
  out.x -= out.m * rate_step_;
  out.lambda -= out.m * rate_multipliers_;
  return finite(out.x) && finite(out.lambda) && std::isfinite(out.m);
}

double KktBorders::residual(const Eigen::VectorXd& border, const Bordered& rhs, const Bordered& v,
                            Bordered& out) {
  const double terms = products_.stiffness_terms(v.x);
  products_.stiffness(v.x, product_);
  products_.constraint_transposed(v.lambda, constrained_);
  products_.constraint(v.x, closed_);
  out.x = rhs.x - product_ - constrained_ - v.m * force_rate_;
  out.lambda = rhs.lambda - closed_ - v.m * loop_rate_;
  out.m = rhs.m - border.head(n_).dot(v.x) - border[n_] * v.m;
  const double forces = rhs.x.norm() + terms + constrained_.norm() + std::abs(v.m) * force_rate_.norm() +
                        least_terms * force_size_;
  const double lengths = std::abs(rhs.m) + v.x.norm() + std::abs(v.m);
  // Redundant loops that are open may ask for what no step does; the balance's own residual tells of these.
  return std::max(forces > 0 ? out.x.norm() / forces : 0, lengths > 0 ? std::abs(out.m) / lengths : 0);
}

bool KktBorders::solve(const Eigen::VectorXd& border, const Bordered& rhs, Bordered& out) {
  Bordered left, correction, trial;
  if (!eliminate(border, rhs, out)) return false;
  double size = residual(border, rhs, out, left);
  for (int i = 0; i < most_refinements && size > rounding; ++i) {
    if (!eliminate(border, left, correction)) return false;
    trial = out;
    trial.x += correction.x;
    trial.lambda += correction.lambda;
    trial.m += correction.m;
    const double next = residual(border, rhs, trial, left);
    if (!(next < size)) break;
    out = trial;
    const bool slow = next > 0.5 * size;
    size = next;
    if (slow) break;
  }
  return size <= enough;
}

bool KktBorders::step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
                      Eigen::VectorXd& lambda) {
  Bordered out;
  if (!solve(border, {-force_, -loops_, along}, out)) return false;
  step.resize(n_ + 1);
  step << out.x, out.m;
  lambda = (old_lambda_ + out.lambda).cwiseProduct(family_.problem().scaling.row);
  return true;
}

bool KktBorders::direction(const Eigen::VectorXd& border, Eigen::VectorXd& result) {
  Bordered out;
  if (!solve(border, {Eigen::VectorXd::Zero(n_), Eigen::VectorXd::Zero(loops_.size()), 1}, out)) return false;
  result.resize(n_ + 1);
  result << out.x, out.m;
  return true;
}

bool KktBorders::iterate_inversely(const Eigen::VectorXd& border, int iterations, Bordered& v, double& rate) {
  std::mt19937 random(7);
  v.x.resize(n_);
  for (double& entry : v.x)
    entry = static_cast<double>(random()) / 2147483648. - 1;
  v.m = 1;
  Bordered next;
  for (int i = 0; i < iterations; ++i) {
    const double length = std::hypot(v.x.norm(), v.m);
    if (!(length > 0)) return false;
    v.x *= force_size_ / length;
    v.lambda.setZero(loops_.size());
    v.m /= length;
    if (!eliminate(border, v, next)) return false;
    std::swap(v, next);
    rate = 1 / std::hypot(v.x.norm(), v.m);
  }
  return std::isfinite(rate);
}

std::optional<double> KktBorders::determinant(const Eigen::VectorXd& border) {
  Bordered v;
  double rate = 0;
  if (!factors().inertia_is_certain(family_.problem(), w_)) return {};
  if (!iterate_inversely(border, 3, v, rate)) return 0;
  const bool negative = (factors().negative_count() % 2 == 1) != (delta(border) < 0);
  return negative ? -rate : rate;
}

bool KktBorders::second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) {
  if (n_ == 0) return false;
  Bordered v;
  double rate = 0;
  if (!iterate_inversely(tangent, 5, v, rate)) return false;
  out.resize(n_ + 1);
  out << v.x, v.m;
  out -= tangent * tangent.dot(out);
  if (!(out.norm() > 0)) return false;
  out.normalize();
  return true;
}

} // namespace flyball
