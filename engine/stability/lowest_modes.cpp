#include "engine/stability/lowest_modes.hpp"

#include "engine/kkt/motion_products.hpp"
#include "engine/linear/krylov.hpp"
#include "engine/solve/newton.hpp"

#include <algorithm>
#include <random>

namespace flyball {
namespace {

using Complex = std::complex<double>;

constexpr double good = 1e-8;      // largest residual of a mode
constexpr double infinite = 1e-13; // of the largest 1/s: then s is infinite
// Of the rate that eigenvalues are sought about: what rounding leaves of a double zero, a direction that
// nothing resists and its rate.
constexpr double no_stiffness = 1e-6;
constexpr int more = 3;        // asked for beyond the modes wanted
constexpr int most_rates = 12; // tried where there are directions without stiffness

// s^2 M + s (C + G) + K as a polynomial of s - rate, whose constant term is factored.
class ShiftedMotion {
 public:
  ShiftedMotion(const Problem& problem, const Unknowns& z, Workspace& w) : problem_(problem), z_(z), w_(w) {
    evaluate(problem, z, 0, w);
    products.linearize(problem, z, w.kinematics, w.residual);
    shift_to(0);
  }

  MotionProducts products;

  bool on_tree() const { return problem_.form == KktForm::tree; }

  // Factors K + rate (C + G) + rate^2 M. Only trees can have a rate.
  void shift_to(double rate) {
    rate_ = rate;
    if (on_tree())
      tree_.linearize_motion(problem_, z_, w_, rate, rate != 0 && products.velocity_matters());
    else
      sparse_.linearize(problem_, z_, w_);
    factors().factor();
  }
  double rate() const { return rate_; }

  // Directions that feel no stiffness, beside those that feel nothing at all.
  bool singular() { return factors().null_count() > factors().force_free_count(); }

  // x with the constant term times x and constraint forces, by `lambda`, equal to rhs.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
    none_.setZero(problem_.system.rows);
    factors().solve(rhs, none_, x, lambda);
  }
  Eigen::VectorXd lambda;

  // About the lowest rate, 1/s: by a few inverse iterations on what moves at all. Zero where nothing resists.
  double about_lowest() {
    constexpr int iterations = 4;
    KktSystem& e = factors();
    Eigen::VectorXd x(products.coordinates()), y;
    std::mt19937 random(3);
    for (double& entry : x)
      entry = static_cast<double>(random()) / 2147483648. - 1;
    const auto quotient = [&](bool with_metric) {
      Eigen::VectorXd kx, mx;
      products.stiffness(x, kx);
      if (with_metric)
        e.metric(x, mx);
      else
        products.mass(x, mx);
      const double mass = x.dot(mx);
      return mass > 0 ? std::abs(x.dot(kx)) / mass : 0;
    };
    const bool shifted = singular();
    if (shifted) e.factor(quotient(true));
    for (int i = 0; i < iterations; ++i) {
      e.metric(x, y);
      solve(y, x);
      const double size = x.norm();
      if (!(size > 0)) break;
      x /= size;
    }
    const double lowest = std::sqrt(quotient(false));
    if (shifted) e.factor();
    return std::isfinite(lowest) ? lowest : 0;
  }

 private:
  KktSystem& factors() { return on_tree() ? static_cast<KktSystem&>(tree_) : sparse_; }
  const Problem& problem_;
  const Unknowns& z_;
  Workspace& w_;
  TreeKkt tree_;
  SparseKkt sparse_;
  double rate_ = 0;
  Eigen::VectorXd none_;
};

struct Pair {
  Complex s;
  Eigen::VectorXcd shape; // scaled
};

struct Pairs {
  std::vector<Pair> pairs;
  // No other eigenvalue is within this distance of the rate.
  double complete_to = 0;
};

// Without velocity terms: M x'' + K x = 0 with M = L^T L, so that L (K + rate^2 M)^-1 L^T is symmetric with
// the eigenvalues 1/(rate^2 - s^2).
std::optional<Pairs> undamped_pairs(ShiftedMotion& motion, Eigen::Index count, double unit) {
  MotionProducts& products = motion.products;
  Eigen::VectorXd force, step;
  const auto found =
      largest_symmetric(products.momenta(), count, [&](const Eigen::VectorXd& p, Eigen::VectorXd& out) {
        products.momentum_transposed(p, force);
        motion.solve(force, step);
        products.momentum(unit * unit * step, out);
      });
  if (!found) return {};
  Pairs out;
  const double largest = found->values.size() > 0 ? std::abs(found->values[0]) : 0;
  bool all = found->values.size() < count;
  for (Eigen::Index i = 0; i < found->values.size(); ++i) {
    const double value = found->values[i];
    if (!(std::abs(value) > infinite * largest)) {
      all = true;
      break;
    }
    const double square = motion.rate() * motion.rate() - unit * unit / value; // of s
    products.momentum_transposed(found->vectors.col(i), force);
    motion.solve(force, step);
    const Eigen::VectorXcd shape = (step / step.norm()).cast<Complex>();
    out.complete_to = unit / std::sqrt(std::abs(value));
    if (std::abs(square) <= no_stiffness * no_stiffness * motion.rate() * motion.rate()) {
      out.pairs.push_back({0, shape});
    } else if (square < 0) {
      out.pairs.push_back({Complex(0, std::sqrt(-square)), shape});
    } else {
      out.pairs.push_back({std::sqrt(square), shape});
      out.pairs.push_back({-std::sqrt(square), shape});
    }
  }
  if (all) out.complete_to = std::numeric_limits<double>::infinity();
  return out;
}

// s = rate + t: (P + t D' + t^2 M) x = 0 with P = K + rate D + rate^2 M and D' = D + 2 rate M. With p = t L x
//   [-P^-1 (D' x + L^T p); L x] = [x; p] / t.
// Momenta rather than rates of the coordinates: small differences of these move much, and rounding in them
// would cost digits. Time is counted in 1/unit and x weighed so that both halves are of one size at low
// rates.
std::optional<Pairs> general_pairs(ShiftedMotion& motion, Eigen::Index count, double unit) {
  MotionProducts& products = motion.products;
  const Eigen::Index n = products.coordinates(), m = products.momenta();
  Eigen::VectorXd x(n), momentum, velocity, force, step;
  for (Eigen::Index i = 0; i < n; ++i)
    x[i] = i % 2 == 0 ? 1 : -0.7;
  for (int i = 0; i < 3; ++i) {
    products.mass(x, force);
    motion.solve(force, x);
    x /= x.norm();
  }
  products.momentum(x, momentum);
  const double weight = std::max(momentum.norm(), 1e-150);
  const auto found = largest_of_any(n + m, count, [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
    x = in.head(n) / weight;
    products.momentum(x, momentum);
    products.velocity(x, velocity);
    products.momentum_transposed(2 * motion.rate() * momentum + unit * in.tail(m), force);
    motion.solve(velocity + force, step);
    out.resize(n + m);
    out << -unit * weight * step, momentum;
  });
  if (!found) return {};
  Pairs out;
  const double largest = found->values.size() > 0 ? std::abs(found->values[0]) : 0;
  bool all = found->values.size() < count;
  for (Eigen::Index i = 0; i < found->values.size(); ++i) {
    const Complex value = found->values[i];
    if (!(std::abs(value) > infinite * largest)) {
      all = true;
      break;
    }
    out.complete_to = unit / std::abs(value);
    const Complex s = motion.rate() + unit / value;
    if (s.imag() < 0) continue;
    const Eigen::VectorXcd shape = found->vectors.col(i).head(n);
    out.pairs.push_back({s, shape / shape.norm()});
  }
  if (all) out.complete_to = std::numeric_limits<double>::infinity();
  return out;
}

// Eigenvalues that are zero but for rounding count as often as they have shapes of their own.
void merge_zeros(std::vector<Pair>& pairs, double rate) {
  constexpr double own = 1e-3;
  std::vector<Eigen::VectorXcd> shapes; // orthonormal
  std::erase_if(pairs, [&](Pair& pair) {
    if (!(std::abs(pair.s) <= no_stiffness * rate)) return false;
    pair.s = 0;
    Eigen::VectorXcd rest = pair.shape;
    for (const Eigen::VectorXcd& shape : shapes)
      rest -= shape * shape.dot(rest);
    if (!(rest.norm() > own)) return true;
    shapes.push_back(rest / rest.norm());
    return false;
  });
}

Eigen::VectorXcd by_parts(const Product& product, const Eigen::VectorXcd& x) {
  Eigen::VectorXd real, imaginary;
  product(x.real(), real);
  product(x.imag(), imaginary);
  return real + Complex(0, 1) * imaginary;
}

// The terms of (s^2 M + s D + K) x.
struct Terms {
  Eigen::VectorXcd mass, velocity, stiffness; // without s
  Terms(MotionProducts& p, const Eigen::VectorXcd& x)
      : mass(by_parts([&](const auto& in, auto& out) { p.mass(in, out); }, x)),
        velocity(by_parts([&](const auto& in, auto& out) { p.velocity(in, out); }, x)),
        stiffness(by_parts([&](const auto& in, auto& out) { p.stiffness(in, out); }, x)) {}
  // Minus those that change with t = s - rate.
  Eigen::VectorXcd moving(Complex s, double rate) const {
    return -(s - rate) * (velocity + (s + rate) * mass);
  }
};

// Of (s^2 M + s D + K) x with the constraint forces that balance it best, relative to the terms. Coordinates
// are differences of the bodies' motions, and a spring between two that move alike hardly feels what it would
// of either: that is what the stiffness is made of.
double residual_of(ShiftedMotion& motion, const Pair& pair) {
  MotionProducts& p = motion.products;
  const Eigen::VectorXcd& x = pair.shape;
  const Complex s = pair.s;
  const double rate = motion.rate();
  const Eigen::VectorXcd mass = by_parts([&](const auto&in, auto&out) { p.mass(in, out); }, x),
                         velocity = by_parts([&](const auto&in, auto&out) { p.velocity(in, out); }, x),
                         stiffness = by_parts([&](const auto&in, auto&out) { p.stiffness(in, out); }, x);
  const Product constraints = [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
    Eigen::VectorXd step;
    motion.solve(in, step);
    p.constraint_transposed(motion.lambda, out);
  };
  const Eigen::VectorXcd closing = by_parts(constraints, -(s - rate) * (velocity + (s + rate) * mass));
  const double made_of = std::hypot(p.stiffness_terms(x.real()), p.stiffness_terms(x.imag()));
  const double left = (s * s * mass + s * velocity + stiffness + closing).norm();
  const double terms = (std::norm(s) + rate * rate) * mass.norm() + (std::abs(s) + rate) * velocity.norm() +
                       made_of + closing.norm();
  return terms > 0 ? left / terms : 0;
}

} // namespace

LowestModes find_lowest_modes(const Problem& problem, const Unknowns& z, int count, Workspace& w) {
  LowestModes out;
  if (problem.system.nv == 0 || count <= 0) return out;
  ShiftedMotion motion(problem, z, w);
  if (motion.products.momenta() == 0) return out;
  const double lowest = motion.about_lowest();
  double unit = lowest > 0 ? lowest : 1;
  if (motion.singular()) {
    if (!motion.on_tree()) {
      out.failure = "The modes were not computed: some direction has no stiffness.";
      return out;
    }
    motion.shift_to(unit);
  }
  const bool damped = motion.products.velocity_matters() || !problem.symmetric();
  std::vector<Pair> pairs;
  for (int tries = 0;; ++tries) {
    auto found =
        damped ? general_pairs(motion, 2 * (count + more), unit) : undamped_pairs(motion, count + more, unit);
    if (!found || tries == most_rates) {
      out.failure = "The modes were not found: the iteration for them does not converge.";
      return out;
    }
    // Near the rate is near zero where the rate is small beside them.
    const double near = found->complete_to - motion.rate();
    pairs = std::move(found->pairs);
    merge_zeros(pairs, motion.rate());
    std::erase_if(pairs, [&](const Pair& p) { return std::abs(p.s) > near * (1 + 1e-9); });
    if (motion.rate() == 0 || found->complete_to == std::numeric_limits<double>::infinity() ||
        pairs.size() >= static_cast<std::size_t>(count))
      break;
    unit = motion.rate() / 4;
    motion.shift_to(unit);
  }
  std::ranges::stable_sort(pairs, {}, [](const Pair& p) { return std::abs(p.s); });
  if (pairs.size() > static_cast<std::size_t>(count)) pairs.resize(static_cast<std::size_t>(count));
  for (const Pair& pair : pairs) {
    const double residual = residual_of(motion, pair);
    if (!(residual <= good)) {
      out.modes.clear();
      out.failure = "The modes were not found: one does not solve its equations.";
      return out;
    }
    out.modes.push_back(describe_mode(problem, z.q, pair.shape, pair.s, residual));
  }
  sort_modes(out.modes);
  return out;
}

} // namespace flyball
