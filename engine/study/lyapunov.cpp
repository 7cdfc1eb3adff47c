#include "engine/study/lyapunov.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace flyball {
namespace {

using Complex = std::complex<double>;
constexpr Complex imaginary{0, 1};

// A derivative and how far its entries may be off.
struct Derivative {
  Eigen::VectorXd value;
  double error = 0;
};

// Of central differences, whose errors go with even powers of the step, each half as long as the one before:
// the table of Richardson's extrapolations, of which that is taken which its neighbours agree with most.
class Extrapolation {
 public:
  void add(const Eigen::VectorXd& difference) {
    std::vector<Eigen::VectorXd> row{difference};
    double power = 4;
    for (std::size_t k = 0; k < last_.size() && k < columns; ++k, power *= 4) {
      row.push_back(row[k] + (row[k] - last_[k]) / (power - 1));
      const double error = std::max((row[k + 1] - row[k]).norm(), (row[k + 1] - last_[k]).norm());
      if (!(error < best_.error)) continue;
      best_ = {row[k + 1], error};
      since_ = 0;
    }
    last_ = std::move(row);
    ++since_;
  }
  // Rounding has taken over.
  bool done() const { return since_ > 4; }
  const Derivative& best() const { return best_; }

 private:
  static constexpr std::size_t columns = 6;
  std::vector<Eigen::VectorXd> last_;
  Derivative best_{{}, std::numeric_limits<double>::infinity()};
  int since_ = 0;
};

class Expansion {
 public:
  Expansion(const VectorField& field, Eigen::Index size) : field_(field), x_(size) {}

  bool begin() {
    x_.setZero();
    return field_(x_, centre_);
  }

  // d/dh, d^2/dh^2 and d^3/dh^3 of F(h d) at h = 0, d as long as it is.
  std::array<Derivative, 3> along(const Eigen::VectorXd& d) {
    const double length = d.norm();
    std::array<Extrapolation, 3> tables;
    Eigen::VectorXd odd_before; // F(h d) - F(-h d) at the step before
    double h = longest;
    for (int k = 0; k < steps; ++k, h /= 2) {
      Eigen::VectorXd forth, back;
      if (!at(h / length * d, forth) || !at(-h / length * d, back)) {
        odd_before.resize(0); // so far there is no motion, or another
        continue;
      }
      const Eigen::VectorXd odd = forth - back;
      tables[0].add(odd / (2 * h));
      tables[1].add((forth - 2 * centre_ + back) / (h * h));
      if (odd_before.size() > 0) tables[2].add((odd_before - 2 * odd) / (2 * h * h * h));
      odd_before = odd;
      if (std::ranges::all_of(tables, &Extrapolation::done)) break;
    }
    std::array<Derivative, 3> out;
    double power = length;
    for (std::size_t order = 0; order < 3; ++order, power *= length) {
      out[order] = tables[order].best();
      if (out[order].value.size() == 0) out[order].value = Eigen::VectorXd::Zero(x_.size());
      out[order].value *= power;
      out[order].error *= power;
    }
    return out;
  }

  // B(a, b)
  Derivative second(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    const double la = a.norm(), lb = b.norm();
    if (la == 0 || lb == 0) return {Eigen::VectorXd::Zero(x_.size()), 0};
    const Eigen::VectorXd sum = a / la + b / lb, difference = a / la - b / lb;
    Derivative out{Eigen::VectorXd::Zero(x_.size()), 0};
    for (const double sign : {1., -1.}) {
      const Eigen::VectorXd& d = sign > 0 ? sum : difference;
      if (d.norm() < 1e-12) continue;
      const Derivative one = along(d)[1];
      out.value += sign * one.value;
      out.error += one.error;
    }
    out.value *= la * lb / 4;
    out.error *= la * lb / 4;
    return out;
  }

 private:
  static constexpr double longest = 0.4;
  static constexpr int steps = 13;

  bool at(const Eigen::VectorXd& x, Eigen::VectorXd& rate) { return field_(x, rate) && rate.allFinite(); }

  const VectorField& field_;
  Eigen::VectorXd x_, centre_;
};

struct ComplexDerivative {
  Eigen::VectorXcd value;
  double error = 0;
};

// B(a + i b, c + i d) of real parts.
ComplexDerivative second(Expansion& of, const Eigen::VectorXcd& x, const Eigen::VectorXcd& y) {
  const Eigen::VectorXd a = x.real(), b = x.imag(), c = y.real(), d = y.imag();
  const Derivative ac = of.second(a, c), bd = of.second(b, d), ad = of.second(a, d), bc = of.second(b, c);
  return {(ac.value - bd.value).cast<Complex>() + imaginary * (ad.value + bc.value).cast<Complex>(),
          ac.error + bd.error + ad.error + bc.error};
}

std::optional<double> norm_of_inverse(const Eigen::MatrixXd& a) {
  const auto values = singular_values(a);
  if (!values || !((*values)[values->size() - 1] > 1e-14 * (*values)[0])) return {};
  return 1 / (*values)[values->size() - 1];
}

} // namespace

std::optional<LyapunovCoefficient> first_lyapunov_coefficient(const VectorField& field, Eigen::Index size,
                                                              double frequency) {
  Expansion expansion(field, size);
  if (size < 2 || !expansion.begin()) return {};
  Eigen::MatrixXd a(size, size);
  double a_error = 0;
  for (Eigen::Index k = 0; k < size; ++k) {
    const Derivative column = expansion.along(Eigen::VectorXd::Unit(size, k))[0];
    a.col(k) = column.value;
    a_error += column.error;
  }
  if (!std::isfinite(a_error)) return {};
  const auto right = eigenvectors(a), left = eigenvectors(a.transpose());
  if (!right || !left) return {};
  const auto next_to = [](const ComplexEigen& all, Complex s) {
    Eigen::Index at = 0;
    (all.values.array() - s).abs().minCoeff(&at);
    return at;
  };
  const Eigen::Index at = next_to(*right, Complex(0, frequency));
  const Complex s = right->values[at];
  const double w = s.imag();
  if (!(w > 0)) return {};
  const Eigen::VectorXcd q = right->vectors.col(at);
  Eigen::VectorXcd p = left->vectors.col(next_to(*left, std::conj(s)));
  const Complex overlap = p.dot(q); // conjugates p
  if (!(std::abs(overlap) > 1e-10)) return {};
  p /= std::conj(overlap);

  // Derivatives along the two real directions of q, their sum and difference, give B and C of q and q*.
  const Eigen::VectorXd u = q.real(), v = q.imag();
  const auto du = expansion.along(u), dv = expansion.along(v), ds = expansion.along(u + v),
             dd = expansion.along(u - v);
  const Eigen::VectorXd b_mean = du[1].value + dv[1].value; // B(q, q*)
  const double b_error = du[1].error + dv[1].error;
  const Eigen::VectorXcd b_twice = (du[1].value - dv[1].value).cast<Complex>() +
                                   imaginary * ((ds[1].value - dd[1].value) / 2).cast<Complex>(); // B(q, q)
  const double b_twice_error = b_error + (ds[1].error + dd[1].error) / 2;
  const Eigen::VectorXd c_uuv = (ds[2].value - dd[2].value - 2 * dv[2].value) / 6,
                        c_uvv = (ds[2].value + dd[2].value - 2 * du[2].value) / 6;
  const Eigen::VectorXcd c = (du[2].value + c_uvv).cast<Complex>() +
                             imaginary * (c_uuv + dv[2].value).cast<Complex>(); // C(q, q, q*)
  const double c_error = 4 * (du[2].error + dv[2].error + ds[2].error + dd[2].error) / 3;

  // What x is shifted by, and its part that swings twice as fast.
  Lu solver;
  if (!solver.compute(a)) return {};
  const Eigen::VectorXd mean = solver.solve(b_mean);
  Eigen::MatrixXd twice_matrix(2 * size, 2 * size); // 2 i w - A, in real parts
  const Eigen::MatrixXd turn = 2 * w * Eigen::MatrixXd::Identity(size, size);
  twice_matrix << -a, -turn, turn, -a;
  Eigen::VectorXd twice_parts(2 * size);
  twice_parts << b_twice.real(), b_twice.imag();
  Lu twice_solver;
  if (!twice_solver.compute(twice_matrix)) return {};
  twice_parts = twice_solver.solve(twice_parts);
  const Eigen::VectorXcd twice =
      twice_parts.head(size).cast<Complex>() + imaginary * twice_parts.tail(size).cast<Complex>();
  const auto mean_gain = norm_of_inverse(a), twice_gain = norm_of_inverse(twice_matrix);
  if (!mean_gain || !twice_gain) return {};
  const double mean_error = *mean_gain * (b_error + a_error * mean.norm()),
               twice_error = *twice_gain * (b_twice_error + a_error * twice.norm());

  const ComplexDerivative shifted = second(expansion, q, mean.cast<Complex>()),
                          doubled = second(expansion, q.conjugate(), twice);
  // An error of a vector counts as the products with it grow.
  const auto relative = [](const ComplexDerivative& product, double error, double vector) {
    return product.error + (vector > 0 ? product.value.norm() * error / vector : 0);
  };
  LyapunovCoefficient out;
  out.eigenvalue = s;
  out.q = q;
  out.value = (p.dot(c) - 2. * p.dot(shifted.value) + p.dot(doubled.value)).real() / (2 * w);
  out.error = p.norm() *
              (c_error + 2 * relative(shifted, mean_error, mean.norm()) +
               relative(doubled, twice_error, twice.norm())) /
              (2 * w);
  out.error += 1e-11 * p.norm() * (c.norm() + 2 * shifted.value.norm() + doubled.value.norm()) / (2 * w);
  if (!std::isfinite(out.value) || !std::isfinite(out.error)) return {};
  return out;
}

} // namespace flyball
