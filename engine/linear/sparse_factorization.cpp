#include "engine/linear/sparse_factorization.hpp"

#include "engine/linear/elimination_order.hpp"
#include "engine/linear/mumps.hpp"

#include <algorithm>
#include <limits>

namespace flyball {

struct SparseFactorization::State {
  Mumps mumps;
  bool factored = false; // with these values
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

  bool factor_scaled() {
    if (!mumps.is_open()) {
      order = pattern.symmetric ? elimination_order(pattern) : std::vector<int>{};
      mumps.open(pattern);
      mumps.prepare(order);
      mumps.run(Mumps::analyse);
    }
    mumps.data.a = scaled.data();
    mumps.set_zero(zero);
    if (!mumps.failed() && mumps.run_factorise()) return true;
    mumps.close();
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
  const bool known = s.mumps.is_open() && s.pattern == pattern;
  if (known && s.factored && s.zero == zero && s.given == values) return true;
  s.factored = false;
  if (!known) {
    s.mumps.close();
    s.pattern = pattern;
  }
  s.given = values;
  s.zero = zero;
  s.equilibrate();
  s.null_space.resize(0, 0);
  s.factored = s.factor_scaled();
  return s.factored;
}

void SparseFactorization::solve(Eigen::VectorXd& x, double enough) {
  State& s = *state_;
  x.array() *= s.scale.array();
  s.wanted = x;
  s.mumps.run_substitute(x.data());
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 4; ++round) {
    const double error = s.leave(x);
    if (!(error > enough) || !(error < 0.5 * before)) break;
    before = error;
    s.mumps.run_substitute(s.left.data());
    x += s.left;
  }
  x.array() *= s.scale.array();
}

int SparseFactorization::negative() const {
  return state_->mumps.negative();
}

int SparseFactorization::nullity() const {
  return state_->mumps.nullity();
}

const Eigen::MatrixXd& SparseFactorization::null_space() {
  State& s = *state_;
  if (s.null_space.cols() == nullity()) return s.null_space;
  s.null_space.setZero(s.pattern.size, nullity());
  s.mumps.setting(Mumps::null_space) = -1;
  s.mumps.run_substitute(s.null_space.data(), s.null_space.cols());
  s.mumps.setting(Mumps::null_space) = 0;
  s.null_space = s.scale.asDiagonal() * s.null_space;
  return s.null_space;
}

} // namespace flyball
