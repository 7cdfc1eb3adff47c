#include "engine/continuation/dense_borders.hpp"

#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/newton.hpp"

#include <algorithm>

namespace flyball {
namespace {

// The two right singular vectors (columns) of [H b] that belong to the smallest singular values, zero among
// them.
std::optional<Eigen::MatrixXd> last_right_vectors(const Eigen::MatrixXd& h) {
  const Eigen::Index k = h.rows();
  if (k + 1 < large::from) {
    const auto svd = singular_vectors(h);
    if (!svd) return {};
    return Eigen::MatrixXd(svd->right.rightCols(2));
  }
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(k + 1, k + 1);
  square.topRows(k) = h;
  const auto smallest = large::smallest_singular(square, 2);
  if (!smallest) return {};
  return Eigen::MatrixXd(smallest->right.rowwise().reverse());
}

} // namespace

double DenseBorders::linearize(const Unknowns& z, double parameter) {
  const Problem problem = family_.problem();
  find_rates(z, parameter);
  const double residual = scaled_residual(problem, w_);
  factor(problem, z, w_);
  if (problem.system.rows > 0)
    w_.residual.f.noalias() -= w_.dense.linearization.constraint.transpose() * z.lambda;
  force_ = w_.residual.f.cwiseProduct(problem.scaling.column);
  basis_ = w_.dense.constraints().basis();
  const Eigen::Index n = problem.system.nv, k = basis_.cols();
  r0_ = r1_ = Eigen::VectorXd::Zero(n);
  if (w_.dense.constraints().rank() > 0) {
    w_.dense.constraints().solve(-w_.residual.phi.cwiseProduct(problem.scaling.row), r0_);
    w_.dense.constraints().solve(-loop_rate_, r1_);
  }
  still_.resize(k, 0);
  h_.resize(k, k + 1);
  h_.leftCols(k) = large::projected(w_.dense.stiffness(), basis_);
  // A state without loads has stiffness only, one without stiffness loads only.
  double size = n > 0 ? w_.magnitudes.force.cwiseProduct(problem.scaling.column).maxCoeff() : 0;
  if (k > 0) size = std::max(size, h_.leftCols(k).cwiseAbs().maxCoeff());
  if (!(size > 0)) size = 1;
  h_.leftCols(k) /= size;
  h_.col(k) = basis_.transpose() * (w_.dense.stiffness() * r1_ + force_rate_) / size;
  g_ = basis_.transpose() * (force_ + w_.dense.stiffness() * r0_) / size;
  return residual;
}

void DenseBorders::keep_still(const Eigen::MatrixXd& directions) {
  keep_still_reduced(basis_.transpose() * directions);
}

Eigen::MatrixXd DenseBorders::keep_still_reduced(const Eigen::MatrixXd& directions) {
  auto stiffness = h_.leftCols(basis_.cols());
  if (still_.cols() > 0) stiffness -= still_ * still_.transpose();
  still_ = directions;
  if (still_.cols() > 0) stiffness += still_ * still_.transpose();
  return basis_ * still_;
}

Eigen::MatrixXd DenseBorders::keep_still_there() {
  // H v = 0 makes (H + V V^T) v = V (V^T v).
  const Eigen::Index k = basis_.cols();
  Eigen::MatrixXd nearly = still_;
  if (Lu lu; lu.compute(h_.leftCols(k)))
    for (auto column : nearly.colwise())
      column = lu.solve(column);
  const Eigen::MatrixXd before = still_;
  keep_still_reduced(Eigen::MatrixXd(k, 0));
  const auto span = singular_vectors(nearly);
  if (!span) return keep_still_reduced(before);
  const Eigen::MatrixXd directions = span->left.leftCols(nearly.cols());
  const auto effect = singular_vectors(h_.leftCols(k) * directions);
  if (!effect) return keep_still_reduced(before);
  Eigen::MatrixXd there = directions * effect->right.rightCols(unresisted(effect->values));
  // Turned among each other as before, so that one may go on in one of them.
  if (there.cols() == before.cols())
    if (const auto turn = singular_vectors(there.transpose() * before))
      there = (there * turn->left * turn->right.transpose()).eval();
  return keep_still_reduced(there);
}

Eigen::Index DenseBorders::unresisted(const Eigen::VectorXd& values) {
  constexpr double rounding = 1e-11, resists = 1e-7; // of the largest entry of H
  const auto up_to = [&](double size) {
    return std::ranges::count_if(values, [=](double value) { return value <= size; });
  };
  hardly_resists_ = up_to(resists) > up_to(rounding);
  return up_to(rounding);
}

Eigen::MatrixXd DenseBorders::keep_null_space_still(const Eigen::VectorXd& along) {
  const Eigen::Index n = basis_.rows(), k = basis_.cols();
  keep_still_reduced(Eigen::MatrixXd(k, 0));
  if (k == 0 || k >= large::from) return keep_still_reduced(Eigen::MatrixXd(k, 0));
  const auto parts = singular_vectors(h_.leftCols(k));
  if (!parts) return keep_still_reduced(Eigen::MatrixXd(k, 0));
  const Eigen::MatrixXd null_space = parts->right.rightCols(unresisted(parts->values));
  if (null_space.cols() == 0) return keep_still_reduced(null_space);
  // A branch at one value of the parameter is such a direction itself.
  const Eigen::MatrixXd shares = along.head(n).transpose() * basis_ * null_space; // (1, d)
  const auto split = singular_vectors(shares);
  if (!split) return keep_still_reduced(Eigen::MatrixXd(k, 0));
  const Eigen::Index own = split->values[0] > 0.5 ? 1 : 0;
  return keep_still_reduced(null_space * split->right.rightCols(null_space.cols() - own));
}

// Scaled step and parameter from reduced unknowns.
Eigen::VectorXd DenseBorders::expand(const Eigen::VectorXd& reduced, double with_r0) const {
  Eigen::VectorXd full(basis_.rows() + 1);
  const Eigen::Index k = basis_.cols();
  full.head(basis_.rows()) = basis_ * reduced.head(k) + r1_ * reduced[k] + with_r0 * r0_;
  full[basis_.rows()] = reduced[k];
  return full;
}

// The balance on the null space with the row that projects a step on the border.
Eigen::MatrixXd DenseBorders::bordered(const Eigen::VectorXd& border) const {
  const Eigen::Index n = basis_.rows(), k = basis_.cols();
  Eigen::MatrixXd m(k + 1, k + 1);
  m.topRows(k) = h_;
  m.row(k).head(k) = border.head(n).transpose() * basis_;
  m(k, k) = border.head(n).dot(r1_) + border[n];
  return m;
}

bool DenseBorders::step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
                        Eigen::VectorXd& lambda) {
  const Problem problem = family_.problem();
  const Eigen::Index n = basis_.rows(), k = basis_.cols();
  Eigen::VectorXd rhs(k + 1);
  rhs.head(k) = -g_;
  rhs[k] = -border.head(n).dot(r0_) + along;
  const auto solved = solve_square(bordered(border), rhs);
  if (!solved) return false;
  step = expand(*solved, 1);
  if (problem.system.rows > 0) {
    const Eigen::VectorXd target = -(force_ + w_.dense.stiffness() * step.head(n) + force_rate_ * step[n]);
    w_.dense.constraints().multipliers(target, w_.scaled_lambda);
    lambda = w_.scaled_lambda.cwiseProduct(problem.scaling.row);
  }
  return true;
}

bool DenseBorders::direction(const Eigen::VectorXd& border, Eigen::VectorXd& out) {
  const Eigen::Index k = basis_.cols();
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(k + 1);
  rhs[k] = 1;
  const auto solved = solve_square(bordered(border), rhs);
  if (!solved) return false;
  out = expand(*solved, 0);
  return true;
}

std::optional<double> DenseBorders::determinant(const Eigen::VectorXd& border) {
  const Eigen::MatrixXd m = bordered(border);
  const Eigen::Index k = basis_.cols();
  if (k + 1 >= large::from) {
    const auto smallest = large::smallest_singular(m, 1);
    if (!smallest) return {};
    // The size of the rest only scales it.
    return smallest->sign * smallest->values[0] / m.norm() * std::sqrt(static_cast<double>(k + 1));
  }
  const auto values = singular_values(m);
  if (!values) return {};
  Lu lu;
  const bool regular = lu.compute(m) && (*values)[0] > 0;
  return regular ? lu.sign_of_determinant() * (*values)[k] / (*values)[0] : 0;
}

int DenseBorders::falling() {
  const Eigen::Index k = basis_.cols();
  if (k == 0 || k >= large::from) return 0;
  const auto found = eigenvalues(h_.leftCols(k));
  return found ? static_cast<int>(std::ranges::count_if(*found, [](auto s) { return s.real() < 0; })) : 0;
}

bool DenseBorders::second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) {
  if (basis_.cols() == 0) return false;
  const auto null_directions = last_right_vectors(h_);
  if (!null_directions) return false;
  Eigen::MatrixXd null_space(tangent.size(), 2);
  for (const Eigen::Index i : {0, 1})
    null_space.col(i) = expand(null_directions->col(i), 0);
  return off_tangent(null_space, tangent, out);
}

} // namespace flyball
