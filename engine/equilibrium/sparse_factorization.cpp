#include "engine/equilibrium/sparse_factorization.hpp"

#include "engine/equilibrium/divided_factors.hpp"
#include "engine/equilibrium/elimination_order.hpp"
#include "engine/equilibrium/mumps.hpp"

#include <algorithm>
#include <limits>

namespace flyball {

struct SparseFactorization::State {
  Mumps whole;
  DividedFactors halves;
  bool begun = false, factored = false; // with this pattern; with these values
  bool divided = false;                 // the factors at hand are those of halves
  SparsePattern pattern;
  std::vector<int> order;
  std::vector<double> given, scaled; // values of the matrix, and of the equilibrated one
  double zero = 0;
  Eigen::VectorXd scale, largest;      // of each row and column
  Eigen::VectorXd wanted, left, terms; // of a solve: right-hand side, what is left of it, sizes of its sums
  Eigen::MatrixXd null_space;

  // Rows and columns to largest entries of one, by square roots from both sides (Ruiz, A scaling algorithm to
  // equilibrate both rows and columns norms in matrices, 2001). Afresh, so that no answer depends on those
  // before.
  void equilibrate() {
    constexpr double even = 1.2; // further apart rows need another pass
    const std::size_t count = given.size();
    scale.setOnes(pattern.size);
    scaled.resize(count);
    for (int pass = 0;; ++pass) {
      largest.setZero(pattern.size);
      for (std::size_t e = 0; e < count; ++e) {
        const Eigen::Index i = pattern.rows[e] - 1, j = pattern.columns[e] - 1;
        scaled[e] = given[e] * (scale[i] * scale[j]);
        const double size = std::abs(scaled[e]);
        largest[i] = std::max(largest[i], size);
        largest[j] = std::max(largest[j], size);
      }
      bool done = true;
      for (double& x : largest) {
        x = x > 0 ? 1 / std::sqrt(x) : 1;
        done = done && x < even && x * even > 1;
      }
      if (done || pass == 6) return;
      scale.array() *= largest.array();
    }
  }

  void substitute(Eigen::VectorXd& x) {
    if (divided)
      halves.solve(x);
    else
      whole.run_substitute(x.data());
  }

  // What x leaves of what is wanted, compared with the terms of each equation (Oettli and Prager, 1964), or
  // with a thousandth of the largest of all.
  double leave(const Eigen::VectorXd& x) {
    left = wanted;
    terms = wanted.cwiseAbs();
    const auto take = [&](Eigen::Index row, double term) {
      left[row] -= term;
      terms[row] += std::abs(term);
    };
    for (std::size_t e = 0; e < scaled.size(); ++e) {
      const Eigen::Index i = pattern.rows[e] - 1, j = pattern.columns[e] - 1;
      take(i, scaled[e] * x[j]);
      if (pattern.symmetric && i != j) take(j, scaled[e] * x[i]);
    }
    const double floor = std::max(1e-3 * terms.maxCoeff(), 1e-300);
    return (left.array().abs() / terms.array().max(floor)).maxCoeff();
  }

  void begin(const SparsePattern& p) {
    begun = false;
    pattern = p;
    whole.close();
    halves.begin(pattern);
    begun = true;
  }

  bool factor_whole() {
    if (!whole.is_open()) {
      order = pattern.symmetric ? elimination_order(pattern, {}, 0) : std::vector<int>{};
      whole.open(pattern);
      whole.prepare(order);
      whole.run(Mumps::analyse);
    }
    whole.data.a = scaled.data();
    whole.set_zero(zero);
    if (!whole.failed() && whole.run_factorise()) return true;
    whole.close();
    return false;
  }
};

SparseFactorization::SparseFactorization() = default;
SparseFactorization::~SparseFactorization() = default;
SparseFactorization::SparseFactorization(SparseFactorization&&) noexcept = default;
SparseFactorization& SparseFactorization::operator=(SparseFactorization&&) noexcept = default;

bool SparseFactorization::factor(const SparsePattern& pattern, const std::vector<double>& values,
                                 double zero) {
  if (!state_) state_ = std::make_unique<State>();
  State& s = *state_;
  const bool known = s.begun && s.pattern == pattern;
  if (known && s.factored && s.zero == zero && s.given == values) return true;
  s.factored = false;
  if (!known) s.begin(pattern);
  s.given = values;
  s.zero = zero;
  s.equilibrate();
  s.null_space.resize(0, 0);
  s.divided = s.halves.is_open() && s.halves.factor(s.scaled, zero);
  if (s.divided) s.whole.close(); // which holds as much again
  s.factored = s.divided || s.factor_whole();
  s.begun = s.factored;
  return s.factored;
}

bool SparseFactorization::divided() const {
  return state_->divided;
}

void SparseFactorization::solve(Eigen::VectorXd& x, double enough) {
  State& s = *state_;
  x.array() *= s.scale.array();
  s.wanted = x;
  s.substitute(x);
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 4; ++round) {
    const double error = s.leave(x);
    if (!(error > enough) || !(error < 0.5 * before)) break;
    before = error;
    s.substitute(s.left);
    x += s.left;
  }
  x.array() *= s.scale.array();
}

int SparseFactorization::negative() const {
  return state_->divided ? state_->halves.negative() : state_->whole.negative();
}

int SparseFactorization::nullity() const {
  return state_->divided ? 0 : state_->whole.nullity();
}

const Eigen::MatrixXd& SparseFactorization::null_space() {
  State& s = *state_;
  if (s.null_space.cols() == nullity()) return s.null_space;
  s.null_space.setZero(s.pattern.size, nullity());
  s.whole.setting(Mumps::null_space) = -1;
  s.whole.run_substitute(s.null_space.data(), s.null_space.cols());
  s.whole.setting(Mumps::null_space) = 0;
  s.null_space = s.scale.asDiagonal() * s.null_space;
  return s.null_space;
}

} // namespace flyball
