#include "engine/dynamics/fastest_rates.hpp"

#include "engine/linear/spectral.hpp"

namespace flyball {
namespace {

constexpr double perturbation = 1e-7; // rad, or relative to the reach
constexpr double settled = 0.05;      // of a Ritz value, its residual
constexpr int most_evaluated = 40;

// J x, J the derivative of (u, s') with (q, s), in scaled coordinates: steps of q in radians and reaches, s
// and its rate in those times `rate`.
class Derivative {
 public:
  Derivative(Equations& equations, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s)
      : equations_(equations), column_(equations.model().scaling.column), t_(t), q_(q), s_(s) {}

  bool begin() {
    if (!equations_.evaluate(t_, q_, s_)) return false;
    u_ = equations_.velocity().head(s_.size());
    a_ = equations_.acceleration();
    return true;
  }
  void set_rate(double rate) { rate_ = rate; }

  bool apply(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
    const Eigen::Index n = s_.size();
    Eigen::VectorXd q = q_;
    const Eigen::VectorXd step = perturbation * x.head(n).cwiseProduct(column_);
    retract<double>(equations_.model().system, step, q);
    const Eigen::VectorXd s = s_ + perturbation * rate_ * x.tail(n).cwiseProduct(column_);
    if (!equations_.evaluate(t_, q, s)) return false;
    out.resize(2 * n);
    out.head(n) = (equations_.velocity().head(n) - u_).cwiseQuotient(column_) / perturbation;
    out.tail(n) = (equations_.acceleration() - a_).cwiseQuotient(column_) / (perturbation * rate_);
    return out.allFinite();
  }

 private:
  Equations& equations_;
  const Eigen::VectorXd& column_;
  double t_, rate_ = 1;
  const Eigen::VectorXd &q_, &s_;
  Eigen::VectorXd u_, a_;
};

} // namespace

std::vector<std::complex<double>> fastest_rates(Equations& equations, double t, const Eigen::VectorXd& q,
                                                const Eigen::VectorXd& s) {
  const Eigen::Index n = s.size(), most = std::min<Eigen::Index>(2 * n, most_evaluated);
  Derivative derivative(equations, t, q, s);
  if (n == 0 || !derivative.begin()) return {};
  // All waves are to take part, and always alike.
  Eigen::VectorXd x(2 * n), next;
  for (Eigen::Index i = 0; i < 2 * n; ++i)
    x[i] = std::sin(1.7 * static_cast<double>(i * i % 1009) + 0.3);
  // Units of time in which stiffness and damping weigh alike: else their matrix is far from normal.
  Eigen::VectorXd still = x;
  still.tail(n).setZero();
  if (!derivative.apply(still, next)) return {};
  double rate = std::sqrt(next.tail(n).norm() / still.norm());
  still = x;
  still.head(n).setZero();
  if (!derivative.apply(still, next)) return {};
  rate = std::max(rate, next.tail(n).norm() / still.norm());
  if (rate > 0 && std::isfinite(rate)) derivative.set_rate(rate);

  Eigen::MatrixXd basis(2 * n, most + 1), h = Eigen::MatrixXd::Zero(most + 1, most);
  basis.col(0) = x.normalized();
  Eigen::Index size = 0;
  while (size < most) {
    if (!derivative.apply(basis.col(size), next)) return {};
    const auto space = basis.leftCols(size + 1);
    for (int pass = 0; pass < 2; ++pass) { // twice is enough
      const Eigen::VectorXd along = space.transpose() * next;
      next -= space * along;
      h.col(size).head(size + 1) += along;
    }
    const double left = next.norm();
    h(size + 1, size) = left;
    ++size;
    if (!(left > 1e-12 * h.topLeftCorner(size, size).norm())) break; // invariant
    basis.col(size) = next / left;
  }
  const std::optional<ComplexEigen> ritz = eigenvectors(h.topLeftCorner(size, size));
  if (!ritz) return {};
  std::vector<std::complex<double>> out;
  Eigen::Index largest = 0;
  ritz->values.cwiseAbs().maxCoeff(&largest);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double residual = h(size, size - 1) * std::abs(ritz->vectors(size - 1, i));
    if (i == largest || residual < settled * std::abs(ritz->values[i])) out.push_back(ritz->values[i]);
  }
  return out;
}

} // namespace flyball
