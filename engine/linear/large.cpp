#include "engine/linear/large.hpp"

#include "engine/linear/interruption.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Householder>
#include <Eigen/Jacobi>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace flyball::large {
namespace {

constexpr Eigen::Index panel = 32; // columns
constexpr double piece = 1e7;      // multiplications between two looks: some milliseconds
constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Columns of a product that make up a piece, each of so many multiplications.
Eigen::Index columns_at_once(double each, Eigen::Index all) {
  return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(piece / std::max(each, 1.)), 4,
                                  std::max<Eigen::Index>(all, 4));
}

// c -= a b, by pieces.
template <class C, class A, class B>
void take_off_product(C&& c, const A& a, const B& b) {
  const Eigen::Index step =
      columns_at_once(static_cast<double>(a.rows()) * static_cast<double>(a.cols()), c.cols());
  for (Eigen::Index j = 0; j < c.cols(); j += step) {
    interruption_point();
    const Eigen::Index some = std::min(step, c.cols() - j);
    c.middleCols(j, some).noalias() -= a * b.middleCols(j, some);
  }
}

// A panel (m, n), m >= n, of an LU with partial pivoting, without blocks.
template <class Panel>
void factor_panel(Panel&& p, Eigen::Ref<Eigen::VectorXi> exchanges) {
  for (Eigen::Index k = 0; k < p.cols(); ++k) {
    Eigen::Index largest = 0;
    p.col(k).tail(p.rows() - k).cwiseAbs().maxCoeff(&largest);
    largest += k;
    exchanges[k] = static_cast<int>(largest);
    if (largest != k) p.row(k).swap(p.row(largest));
    if (p(k, k) == 0) continue;
    const Eigen::Index below = p.rows() - k - 1, right = p.cols() - k - 1;
    p.col(k).tail(below) /= p(k, k);
    p.bottomRightCorner(below, right).noalias() -= p.col(k).tail(below) * p.row(k).tail(right);
  }
}

// Symmetric to tridiagonal form by Householder reflections, in the lower triangle: column k keeps the
// essential part of reflection k below its second subdiagonal entry.
void tridiagonalize(Eigen::MatrixXd& a, Eigen::VectorXd& diagonal, Eigen::VectorXd& below,
                    Eigen::VectorXd& coefficients) {
  const Eigen::Index n = a.rows();
  diagonal.resize(n);
  below.resize(std::max<Eigen::Index>(n - 1, 0));
  coefficients.setZero(below.size());
  Eigen::VectorXd v(n), w(n);
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    interruption_point();
    const Eigen::Index rest = n - k - 1;
    double tau = 0, beta = 0;
    a.col(k).tail(rest).makeHouseholderInPlace(tau, beta);
    below[k] = beta;
    coefficients[k] = tau;
    if (tau == 0) continue;
    auto u = v.head(rest);
    u = a.col(k).tail(rest);
    u[0] = 1;
    auto block = a.bottomRightCorner(rest, rest);
    auto p = w.head(rest);
    p.noalias() = block.selfadjointView<Eigen::Lower>() * (tau * u);
    p -= (0.5 * tau * p.dot(u)) * u;
    block.selfadjointView<Eigen::Lower>().rankUpdate(u, p, -1);
  }
  diagonal = a.diagonal();
}

// The product of those reflections.
void accumulate(const Eigen::MatrixXd& a, const Eigen::VectorXd& coefficients, Eigen::MatrixXd& q) {
  const Eigen::Index n = a.rows();
  q.setIdentity(n, n);
  Eigen::VectorXd work(n);
  for (Eigen::Index k = n - 2; k >= 0; --k) {
    interruption_point();
    const Eigen::Index rest = n - k - 1;
    q.bottomRightCorner(rest, rest)
        .applyHouseholderOnTheLeft(a.col(k).tail(rest - 1), coefficients[k], work.data());
  }
}

// One implicit QR step on rows begin to end of a tridiagonal matrix.
void qr_step(Eigen::VectorXd& d, Eigen::VectorXd& e, Eigen::Index begin, Eigen::Index end,
             Eigen::MatrixXd* vectors) {
  const double half = (d[end - 1] - d[end]) / 2, last = e[end - 1];
  const double shift = d[end] - last * last / (half + std::copysign(std::hypot(half, last), half));
  double x = d[begin] - shift, z = e[begin];
  for (Eigen::Index k = begin; k < end && z != 0; ++k) {
    Eigen::JacobiRotation<double> turn;
    turn.makeGivens(x, z);
    const double c = turn.c(), s = turn.s(); // (c -s; s c) (x; z) = (r; 0)
    const double p = d[k], q = d[k + 1], r = e[k];
    if (k > begin) e[k - 1] = c * e[k - 1] - s * z;
    d[k] = c * c * p - 2 * c * s * r + s * s * q;
    d[k + 1] = s * s * p + 2 * c * s * r + c * c * q;
    e[k] = c * s * (p - q) + (c * c - s * s) * r;
    x = e[k];
    if (k + 1 < end) {
      z = -s * e[k + 1];
      e[k + 1] *= c;
    }
    if (vectors) vectors->applyOnTheRight(k, k + 1, turn);
  }
}

} // namespace

void multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& out) {
  out.resize(a.rows(), b.cols());
  const Eigen::Index step =
      columns_at_once(static_cast<double>(a.rows()) * static_cast<double>(a.cols()), b.cols());
  if (step >= b.cols()) {
    out.noalias() = a * b;
    return;
  }
  for (Eigen::Index j = 0; j < b.cols(); j += step) {
    interruption_point();
    const Eigen::Index some = std::min(step, b.cols() - j);
    out.middleCols(j, some).noalias() = a * b.middleCols(j, some);
  }
}

Eigen::MatrixXd projected(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (b.rows() == b.cols()) return a;
  if (b.rows() < from) return b.transpose() * a * b;
  Eigen::MatrixXd product, out(b.cols(), b.cols());
  multiply(a, b, product);
  const Eigen::Index step =
      columns_at_once(static_cast<double>(b.rows()) * static_cast<double>(b.cols()), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); j += step) {
    interruption_point();
    const Eigen::Index some = std::min(step, b.cols() - j);
    out.middleCols(j, some).noalias() = b.transpose() * product.middleCols(j, some);
  }
  return out;
}

bool factor_cholesky(Eigen::MatrixXd& a) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index j = 0; j < n; j += panel) {
    const Eigen::Index some = std::min(panel, n - j), below = n - j - some;
    const Eigen::MatrixXd across = a.block(j, 0, some, j).transpose();
    take_off_product(a.block(j, j, n - j, some), a.block(j, 0, n - j, j), across);
    interruption_point();
    auto corner = a.block(j, j, some, some);
    const Eigen::LLT<Eigen::MatrixXd> factors(corner);
    if (factors.info() != Eigen::Success) return false;
    corner = factors.matrixL();
    if (below > 0)
      corner.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(
          a.block(j + some, j, below, some));
  }
  return std::isfinite(a.diagonal().sum()); // of NaN the comparisons inside tell nothing
}

void factor_lu(Eigen::MatrixXd& a, Eigen::VectorXi& exchanges) {
  const Eigen::Index n = a.rows();
  exchanges.resize(n);
  for (Eigen::Index j = 0; j < n; j += panel) {
    interruption_point();
    const Eigen::Index some = std::min(panel, n - j), rest = n - j - some;
    auto of_panel = exchanges.segment(j, some);
    factor_panel(a.block(j, j, n - j, some), of_panel);
    for (Eigen::Index k = 0; k < some; ++k) {
      of_panel[k] += static_cast<int>(j);
      const Eigen::Index other = of_panel[k];
      if (other == j + k) continue;
      a.row(j + k).head(j).swap(a.row(other).head(j));
      a.row(j + k).tail(rest).swap(a.row(other).tail(rest));
    }
    if (rest == 0) break;
    auto beside = a.block(j, j + some, some, rest);
    a.block(j, j, some, some).triangularView<Eigen::UnitLower>().solveInPlace(beside);
    take_off_product(a.bottomRightCorner(rest, rest), a.block(j + some, j, rest, some), beside);
  }
}

void factor_pivoted_qr(Eigen::MatrixXd& a, Eigen::VectorXd& coefficients, Eigen::VectorXi& order) {
  const Eigen::Index m = a.rows(), n = a.cols(), count = std::min(m, n);
  coefficients.setZero(count);
  order.resize(n);
  std::iota(order.begin(), order.end(), 0);
  // Norms of what is left of the columns, updated, and found anew where too many digits have gone (LAPACK
  // Working Note 176).
  Eigen::VectorXd norms = a.colwise().norm().transpose(), direct = norms, work(n);
  const double few_digits = std::sqrt(epsilon);
  for (Eigen::Index k = 0; k < count; ++k) {
    interruption_point();
    Eigen::Index best = 0;
    norms.tail(n - k).maxCoeff(&best);
    best += k;
    if (best != k) {
      a.col(k).swap(a.col(best));
      std::swap(norms[k], norms[best]);
      std::swap(direct[k], direct[best]);
      std::swap(order[k], order[best]);
    }
    double beta = 0;
    a.col(k).tail(m - k).makeHouseholderInPlace(coefficients[k], beta);
    a(k, k) = beta;
    a.bottomRightCorner(m - k, n - k - 1)
        .applyHouseholderOnTheLeft(a.col(k).tail(m - k - 1), coefficients[k], work.data());
    for (Eigen::Index j = k + 1; j < n; ++j) {
      if (norms[j] == 0) continue;
      const double share = std::abs(a(k, j)) / norms[j];
      const double left = std::max(0., (1 + share) * (1 - share)), seen = norms[j] / direct[j];
      if (left * seen * seen <= few_digits)
        norms[j] = direct[j] = a.col(j).tail(m - k - 1).norm();
      else
        norms[j] *= std::sqrt(left);
    }
  }
}

bool symmetric_eigen(Eigen::MatrixXd a, Eigen::VectorXd& values, Eigen::MatrixXd* vectors) {
  const Eigen::Index n = a.rows();
  interruption_point();
  double size = 0;
  for (Eigen::Index j = 0; j < n; ++j)
    size = std::max(size, a.col(j).tail(n - j).cwiseAbs().maxCoeff());
  if (size > 0) a /= size;
  Eigen::VectorXd e, coefficients;
  tridiagonalize(a, values, e, coefficients);
  Eigen::MatrixXd q;
  if (vectors) accumulate(a, coefficients, q);
  constexpr int most = 60;
  int steps = 0;
  for (Eigen::Index end = n - 1; end > 0;) {
    for (Eigen::Index i = 0; i < end; ++i)
      if (std::abs(e[i]) <= epsilon * (std::abs(values[i]) + std::abs(values[i + 1])) ||
          std::abs(e[i]) < epsilon * epsilon) // of a matrix whose largest entry is 1
        e[i] = 0;
    while (end > 0 && e[end - 1] == 0) {
      --end;
      steps = 0;
    }
    if (end <= 0) break;
    if (++steps > most) return false;
    Eigen::Index begin = end - 1;
    while (begin > 0 && e[begin - 1] != 0)
      --begin;
    interruption_point();
    qr_step(values, e, begin, end, vectors ? &q : nullptr);
  }
  std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return values[i]; });
  const Eigen::VectorXd unsorted = size * values;
  if (vectors) vectors->resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index from_column = order[static_cast<std::size_t>(i)];
    values[i] = unsorted[from_column];
    if (vectors) vectors->col(i) = q.col(from_column);
  }
  return values.allFinite();
}

std::optional<SmallestSingular> smallest_singular(const Eigen::MatrixXd& a, Eigen::Index count) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd lu = a;
  Eigen::VectorXi exchanges;
  if (n == 0 || count > n) return {};
  factor_lu(lu, exchanges);
  // Where the matrix is singular to rounding the vectors are the same a little beside it.
  const double least = epsilon * std::max(a.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  for (Eigen::Index i = 0; i < n; ++i)
    if (std::abs(lu(i, i)) < least) lu(i, i) = std::copysign(least, lu(i, i));
  const auto lower = lu.triangularView<Eigen::UnitLower>();
  const auto upper = lu.triangularView<Eigen::Upper>();
  const auto transposed = lu.transpose();
  const auto transposed_lower = transposed.triangularView<Eigen::UnitUpper>();
  const auto transposed_upper = transposed.triangularView<Eigen::Lower>();
  const auto solve = [&](Eigen::MatrixXd& x) {
    for (Eigen::Index i = 0; i < n; ++i)
      x.row(i).swap(x.row(exchanges[i]));
    lower.solveInPlace(x);
    upper.solveInPlace(x);
  };
  const auto solve_transposed = [&](Eigen::MatrixXd& x) {
    transposed_upper.solveInPlace(x);
    transposed_lower.solveInPlace(x);
    for (Eigen::Index i = n - 1; i >= 0; --i)
      x.row(i).swap(x.row(exchanges[i]));
  };
  const auto orthonormal = [](Eigen::MatrixXd& x) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
    x = qr.householderQ() * Eigen::MatrixXd::Identity(x.rows(), x.cols());
  };
  // A few columns more than asked for: the next values then hold up nothing.
  const Eigen::Index block = std::min<Eigen::Index>(n, count + 3);
  Eigen::MatrixXd right(n, block), left;
  std::mt19937 random(1);
  for (double& entry : right.reshaped())
    entry = static_cast<double>(random()) / 2147483648. - 1;
  orthonormal(right);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(count);
  SmallestSingular out;
  for (Eigen::Index i = 0; i < n; ++i)
    if ((lu(i, i) < 0) != (exchanges[i] != i)) out.sign = -out.sign;
  for (int i = 0; i < 40; ++i) {
    interruption_point();
    left = right;
    solve_transposed(left);
    orthonormal(left);
    right = left;
    solve(right);
    orthonormal(right);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(left.transpose() * (a * right),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    out.values = svd.singularValues().reverse().head(count);
    out.left = (left * svd.matrixU()).rowwise().reverse().leftCols(count);
    out.right = (right * svd.matrixV()).rowwise().reverse().leftCols(count);
    if (!out.values.allFinite()) return {};
    if ((out.values - before).cwiseAbs().maxCoeff() <= 1e-9 * out.values[count - 1] + least) break;
    before = out.values;
  }
  return out;
}

} // namespace flyball::large
