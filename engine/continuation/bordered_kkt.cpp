#include "engine/continuation/bordered_kkt.hpp"

#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/newton.hpp"

namespace flyball {
namespace {

constexpr int most_refinements = 8;
constexpr double rounding = 1e-15, enough = 1e-8; // of the terms of the equations
constexpr double least_terms = 1e-5; // of the loads: what a step so short leaves is rounding of these

// Of the stiffness for moving the mechanism as a whole: the first shift tried.
constexpr double least_shift = 1e-10;

bool finite(const Eigen::VectorXd& v) {
  return std::isfinite(v.sum());
}

} // namespace

void BorderedKkt::linearize(const Problem& problem, const Unknowns& z, Workspace& w) {
  factors_ = &w.kkt(problem);
  products_.linearize(problem, z, w.kinematics, w.residual);
  factor(problem, z, w);
  const double loads = largest(w.magnitudes.force.cwiseProduct(problem.scaling.column));
  const int n = problem.system.nv;
  const double stiffness = loads > 0 ? 0 : products_.stiffness_terms(Eigen::VectorXd::Ones(n)) / std::sqrt(n);
  force_size_ = loads > 0 ? loads : stiffness > 0 ? stiffness : 1;
  const double reach = problem.parameters.length;
  double shift = least_shift * force_size_ / (factors_->mass() * reach * reach);
  for (int i = 0; i < 4 && factors_->null_count() > factors_->force_free_count() && std::isfinite(shift);
       ++i, shift *= 100)
    factors_->factor(shift);
}

void BorderedKkt::set_columns(const Eigen::MatrixXd& forces, const Eigen::MatrixXd& loops) {
  force_rates_ = forces;
  loop_rates_ = loops;
  steps_.resize(forces.rows(), forces.cols());
  multipliers_.resize(loops.rows(), loops.cols());
  Eigen::VectorXd x, lambda;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    factors_->solve(forces.col(i), loops.col(i), x, lambda);
    steps_.col(i) = x;
    multipliers_.col(i) = lambda;
  }
}

void BorderedKkt::set_rows(Rows rows) {
  rows_ = std::move(rows);
  complement_ = rows_.m;
  complement_.noalias() -= rows_.x * steps_;
  if (rows_.lambda.size() > 0) complement_.noalias() -= rows_.lambda * multipliers_;
}

Eigen::VectorXd BorderedKkt::along_rows(const Eigen::VectorXd& x, const Eigen::VectorXd& lambda) const {
  Eigen::VectorXd out = rows_.x * x;
  if (rows_.lambda.size() > 0) out.noalias() += rows_.lambda * lambda;
  return out;
}

bool BorderedKkt::eliminate(const Vector& rhs, Vector& out) {
  const double determinant = complement_.determinant();
  if (determinant == 0 || !std::isfinite(determinant)) return false;
  factors_->solve(rhs.x, rhs.lambda, out.x, out.lambda);
  const auto m = solve_square(complement_, rhs.m - along_rows(out.x, out.lambda));
  if (!m) return false;
  out.m = *m;
  out.x.noalias() -= steps_ * out.m;
  out.lambda.noalias() -= multipliers_ * out.m;
  return finite(out.x) && finite(out.lambda);
}

double BorderedKkt::residual(const Vector& rhs, const Vector& v, Vector& out) {
  const double terms = products_.stiffness_terms(v.x);
  products_.stiffness(v.x, product_);
  products_.constraint_transposed(v.lambda, constrained_);
  products_.constraint(v.x, closed_);
  out.x = rhs.x - product_ - constrained_ - force_rates_ * v.m;
  out.lambda = rhs.lambda - closed_ - loop_rates_ * v.m;
  out.m = rhs.m - along_rows(v.x, v.lambda) - rows_.m * v.m;
  const double rates = force_rates_.colwise().norm().dot(v.m.cwiseAbs());
  const double forces = rhs.x.norm() + terms + constrained_.norm() + rates + least_terms * force_size_;
  const double lengths = rhs.m.norm() + v.x.norm() + v.m.norm();
  // Redundant loops that are open may ask for what no step does; the balance's own residual tells of these.
  return std::max(forces > 0 ? out.x.norm() / forces : 0, lengths > 0 ? out.m.norm() / lengths : 0);
}

bool BorderedKkt::solve(const Vector& rhs, Vector& out) {
  Vector left, correction, trial;
  if (!eliminate(rhs, out)) return false;
  double size = residual(rhs, out, left);
  for (int i = 0; i < most_refinements && size > rounding; ++i) {
    if (!eliminate(left, correction)) return false;
    trial = out;
    trial.x += correction.x;
    trial.lambda += correction.lambda;
    trial.m += correction.m;
    const double next = residual(rhs, trial, left);
    if (!(next < size)) break;
    out = trial;
    const bool slow = next > 0.5 * size;
    size = next;
    if (slow) break;
  }
  return size <= enough;
}

} // namespace flyball
