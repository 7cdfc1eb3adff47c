#include "engine/linear/state_space.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

using Poles = std::optional<std::vector<std::complex<double>>>;

double power_of_two_near(double x) {
  return std::exp2(std::round(std::log2(x)));
}

void sort_by_frequency(std::vector<std::complex<double>>& s) {
  for (std::complex<double>& x : s)
    x += std::complex<double>(0, 0); // no negative zeros
  std::ranges::sort(s, [](std::complex<double> a, std::complex<double> b) {
    if (std::abs(a.imag()) != std::abs(b.imag())) return std::abs(a.imag()) < std::abs(b.imag());
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
}

// Rows and columns of A + rate E brought to a like size, by turns (Ruiz, A scaling algorithm to equilibrate
// both rows and columns norms in matrices, 2001). Eigenvalues stay. By what rows and columns were multiplied.
struct Scales {
  Eigen::VectorXd row, column;
};
Scales equilibrate(Eigen::MatrixXd& a, Eigen::MatrixXd& e) {
  Scales scales{Eigen::VectorXd::Ones(a.rows()), Eigen::VectorXd::Ones(a.rows())};
  for (int turn = 0; turn < 8; ++turn)
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const double row = std::max(a.row(i).cwiseAbs().maxCoeff(), e.row(i).cwiseAbs().maxCoeff());
      if (row > 0) {
        const double factor = power_of_two_near(1 / std::sqrt(row));
        a.row(i) *= factor;
        e.row(i) *= factor;
        scales.row[i] *= factor;
      }
      const double column = std::max(a.col(i).cwiseAbs().maxCoeff(), e.col(i).cwiseAbs().maxCoeff());
      if (column > 0) {
        const double factor = power_of_two_near(1 / std::sqrt(column));
        a.col(i) *= factor;
        e.col(i) *= factor;
        scales.column[i] *= factor;
      }
    }
  return scales;
}

constexpr double least_singular = 1e-13; // of the largest singular value of A in like sizes
constexpr double hardly_felt = 1e-9;     // of what an output feels of all states

// Without the states that integrate and that no output feels, A n = 0 and C n = 0: of x = n a + q b the part
// b goes its own way. Nothing where an output feels one.
std::optional<StateSpace> without_unseen(const StateSpace& system) {
  const Eigen::Index n = system.a.rows();
  Eigen::MatrixXd a = system.a,
                  e = system.e.size() > 0 ? system.e : Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)),
                  none = Eigen::MatrixXd::Zero(n, n);
  const Scales scales = equilibrate(a, none);
  e = scales.row.asDiagonal() * e * scales.column.asDiagonal();
  const Eigen::MatrixXd c = system.c * scales.column.asDiagonal();
  PivotedQr qr;
  if (!qr.compute(a.transpose())) return {};
  const Eigen::Index rank = qr.rank(least_singular);
  if (rank == n) return {}; // singular by a hair: nothing that could be left out
  const Eigen::MatrixXd q = qr.q(), left_out = q.rightCols(n - rank);
  if (((c * left_out).rowwise().norm().array() > hardly_felt * c.rowwise().norm().array()).any()) return {};
  PivotedQr moved;
  if (!moved.compute(e * left_out) || moved.rank(least_singular) < n - rank) return {};
  const Eigen::MatrixXd beside = moved.q().rightCols(rank).transpose();
  return StateSpace{beside * e * q.leftCols(rank), beside * a * q.leftCols(rank),
                    beside * scales.row.asDiagonal() * system.b, c * q.leftCols(rank), system.d};
}

bool is_singular(Eigen::MatrixXd a) {
  Eigen::MatrixXd none = Eigen::MatrixXd::Zero(a.rows(), a.cols());
  equilibrate(a, none);
  const auto sizes = singular_values(a);
  return !sizes || !((*sizes)[sizes->size() - 1] > least_singular * (*sizes)[0]);
}

} // namespace

StateSpace balanced(StateSpace x) {
  for (int turn = 0; turn < 100; ++turn) {
    bool changed = false;
    for (Eigen::Index i = 0; i < x.a.rows(); ++i) {
      const double own = std::abs(x.a(i, i));
      const double row = x.a.row(i).lpNorm<1>() - own, column = x.a.col(i).lpNorm<1>() - own;
      if (!(row > 0) || !(column > 0) || !std::isfinite(row + column)) continue;
      const double factor = power_of_two_near(std::sqrt(row / column));
      if (!(factor * column + row / factor < 0.95 * (row + column))) continue;
      x.a.col(i) *= factor;
      x.c.col(i) *= factor;
      x.a.row(i) /= factor;
      x.b.row(i) /= factor;
      changed = true;
    }
    if (!changed) break;
  }
  return x;
}

Poles poles(const StateSpace& system, CancelFlag cancel) {
  Poles found;
  if (system.e.size() == 0) {
    found = eigenvalues(balanced(system).a, cancel);
  } else {
    const double a = system.a.norm(), e = system.e.norm(),
                 rate = a > 0 && e > 0 ? power_of_two_near(a / e) : 1;
    Eigen::MatrixXd scaled_a = system.a / rate, scaled_e = system.e;
    equilibrate(scaled_a, scaled_e);
    found = generalized_eigenvalues(scaled_a, scaled_e, cancel);
    for (std::size_t i = 0; found && i < found->size(); ++i)
      (*found)[i] *= rate;
  }
  if (found) sort_by_frequency(*found);
  return found;
}

// While the output does not feel the input at once, turn the states so that it is the last one alone: it must
// vanish, and so must its rate, which is the output of what is left.
Poles zeros(const StateSpace& system, Eigen::Index input, Eigen::Index output) {
  if (system.e.size() > 0) return {};
  const StateSpace x = balanced(system);
  Eigen::MatrixXd a = x.a;
  Eigen::VectorXd b = x.b.col(input), c = x.c.row(output).transpose();
  double d = x.d(output, input);
  constexpr double none = 1e-11; // of what it stands beside: rounding, and what differences left of zero
  // Sizes of what c, d and b are made of, for telling them from nothing.
  const double size_b = b.norm(), size_a = std::max(a.norm(), 1e-300);
  if (size_b == 0 && d == 0) return {};
  double size_c = c.norm();
  if (size_c == 0 && d == 0) return {};
  // d and c A^-1 b are alike in unit.
  while (!(std::abs(d) * size_a > none * size_c * size_b)) {
    const Eigen::Index n = a.rows();
    const double length = c.norm();
    if (n == 0 || !(length > none * size_c)) return {};
    HouseholderQr qr;
    if (!qr.compute(c)) return {};
    const Eigen::MatrixXd q = qr.q(); // the first column along c
    Eigen::MatrixXd turned(n, n);
    turned << q.rightCols(n - 1), q.col(0);
    a = (turned.transpose() * a * turned).eval();
    b = (turned.transpose() * b).eval();
    c = a.row(n - 1).head(n - 1).transpose();
    d = b[n - 1];
    a = a.topLeftCorner(n - 1, n - 1).eval();
    b = b.head(n - 1).eval();
    size_c = size_a;
  }
  if (a.rows() == 0) return std::vector<std::complex<double>>();
  StateSpace left;
  left.a = a - b * c.transpose() / d;
  left.b = b;
  left.c = c.transpose();
  left.d.setConstant(1, 1, d);
  Poles found = eigenvalues(balanced(std::move(left)).a);
  if (found) sort_by_frequency(*found);
  return found;
}

std::optional<Eigen::MatrixXcd> transfer(const StateSpace& system, std::complex<double> s) {
  interruption_point();
  if (system.a.rows() == 0) return Eigen::MatrixXcd(system.d.cast<std::complex<double>>());
  Eigen::MatrixXcd matrix = -system.a.cast<std::complex<double>>();
  if (system.e.size() > 0)
    matrix += s * system.e;
  else
    matrix.diagonal().array() += s;
  ComplexLu lu;
  if (!lu.compute(matrix)) return {};
  Eigen::MatrixXcd out = system.c * lu.solve(system.b.cast<std::complex<double>>());
  out += system.d;
  if (!out.allFinite()) return {};
  return out;
}

std::optional<Eigen::MatrixXd> static_gain(const StateSpace& of) {
  StateSpace system = of;
  if (system.a.rows() > 0 && is_singular(system.a)) {
    auto seen = without_unseen(system);
    if (!seen || (seen->a.rows() > 0 && is_singular(seen->a))) return {};
    system = std::move(*seen);
  }
  if (system.a.rows() == 0) return system.d;
  Lu lu;
  if (!lu.compute(system.a)) return {};
  Eigen::MatrixXd out = system.d;
  for (Eigen::Index i = 0; i < system.b.cols(); ++i)
    out.col(i) -= system.c * lu.solve(system.b.col(i));
  if (!out.allFinite()) return {};
  return out;
}

} // namespace flyball
