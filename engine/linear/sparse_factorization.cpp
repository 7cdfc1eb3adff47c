#include "engine/linear/sparse_factorization.hpp"

#include "engine/linear/elimination_order.hpp"
#include "engine/linear/multifrontal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

// rho, where the largest entry of each row and column is 1. Much more than that, to drown what is negative in
// K along the rows; not so much that what rounding leaves of it elsewhere would count.
constexpr double augmentation = 10;

std::size_t slot_at(int i) {
  return static_cast<std::size_t>(i);
}

} // namespace

struct SparseFactorization::State {
  bool analysed = false, factored = false; // this pattern; with these values
  SparsePattern pattern;
  std::vector<double> given;
  double zero = 0;

  // The matrix with repeated entries summed up, by columns in the order of elimination; of the upper triangle
  // the transposed.
  std::vector<int> order, place; // unknown by place, place by unknown
  Multifrontal::Columns columns;
  std::vector<int> slot; // of the given entries in `lower`, or where -1 - it is negative in `upper`
  std::vector<double> lower, upper; // equilibrated
  // Of each row of J the slots of its entries, and those of the products of any two of them.
  struct Entry {
    int motion; // place
    int slot;
    bool below; // the multiplier comes after the motion
  };
  std::vector<int> first_entry; // by row, and the end
  std::vector<Entry> entries;
  std::vector<int> multiplier; // place, by row
  std::vector<int> products;
  std::vector<bool> left_out; // by place: redundant rows among others

  Multifrontal factors;
  Eigen::VectorXd scale, largest;      // by place
  Eigen::VectorXd wanted, left, terms; // of a solve: right-hand side, what is left of it, sizes of its sums
  Eigen::MatrixXd null_space;

  void analyse();
  void lay_out();
  void find_rows();
  int find_slot(int i, int j) const;
  void equilibrate();
  void augment(std::vector<double>& with_lower, std::vector<double>& with_upper) const;
  double leave(const Eigen::VectorXd& x);
  void substitute(Eigen::VectorXd& x);

  double gradient(const Entry& e) const {
    return upper.empty() || e.below ? lower[slot_at(e.slot)] : upper[slot_at(e.slot)];
  }
  // Calls work(i, j, slot) for every entry of the lower triangle.
  template <class Work>
  void for_entries(const Work& work) const {
    for (int j = 0; j < pattern.size; ++j)
      for (int e = columns.start[slot_at(j)]; e < columns.start[slot_at(j) + 1]; ++e)
        work(columns.row[slot_at(e)], j, slot_at(e));
  }
};

void SparseFactorization::State::analyse() {
  order = elimination_order(pattern);
  lay_out();
  const std::vector<int> post = Multifrontal::postorder(columns);
  std::vector<int> reordered(order.size());
  for (std::size_t p = 0; p < post.size(); ++p)
    reordered[p] = order[slot_at(post[p])];
  order = std::move(reordered);
  lay_out();
  find_rows();
  slot.resize(pattern.rows.size());
  for (std::size_t e = 0; e < slot.size(); ++e) {
    const int i = place[slot_at(pattern.rows[e])], j = place[slot_at(pattern.columns[e])];
    const int found = find_slot(std::max(i, j), std::min(i, j));
    slot[e] = !pattern.symmetric && i < j ? -1 - found : found;
  }
  lower.resize(columns.row.size());
  upper.resize(pattern.symmetric ? 0 : columns.row.size());
  factors.analyse(columns);
}

// The augmented matrix's entries in this order.
void SparseFactorization::State::lay_out() {
  const auto n = slot_at(pattern.size);
  place.resize(n);
  for (std::size_t p = 0; p < n; ++p)
    place[slot_at(order[p])] = static_cast<int>(p);
  std::vector<std::vector<int>> rows(n), tied(n);
  for (std::size_t e = 0; e < pattern.rows.size(); ++e) {
    const auto [first, second] = std::minmax(pattern.rows[e], pattern.columns[e]);
    const auto [j, i] = std::minmax(place[slot_at(first)], place[slot_at(second)]);
    rows[slot_at(j)].push_back(i);
    if (second >= pattern.motions) tied[slot_at(second)].push_back(place[slot_at(first)]);
  }
  for (const std::vector<int>& all : tied)
    for (const int i : all)
      for (const int j : all)
        if (j <= i) rows[slot_at(j)].push_back(i);
  columns.start.assign(1, 0);
  columns.row.clear();
  for (std::size_t j = 0; j < n; ++j) {
    rows[j].push_back(static_cast<int>(j));
    std::ranges::sort(rows[j]);
    rows[j].erase(std::unique(rows[j].begin(), rows[j].end()), rows[j].end());
    columns.row.insert(columns.row.end(), rows[j].begin(), rows[j].end());
    columns.start.push_back(static_cast<int>(columns.row.size()));
  }
}

int SparseFactorization::State::find_slot(int i, int j) const {
  const auto begin = columns.row.begin() + columns.start[slot_at(j)];
  const auto end = columns.row.begin() + columns.start[slot_at(j) + 1];
  return static_cast<int>(std::lower_bound(begin, end, i) - columns.row.begin());
}

void SparseFactorization::State::find_rows() {
  std::vector<std::vector<int>> tied(slot_at(pattern.size - pattern.motions));
  for (std::size_t e = 0; e < pattern.rows.size(); ++e)
    if (const auto [motion, row] = std::minmax(pattern.rows[e], pattern.columns[e]); row >= pattern.motions)
      tied[slot_at(row - pattern.motions)].push_back(place[slot_at(motion)]);
  first_entry.assign(1, 0);
  entries.clear();
  multiplier.clear();
  products.clear();
  for (std::size_t r = 0; r < tied.size(); ++r) {
    std::vector<int>& all = tied[r];
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    const int m = place[slot_at(pattern.motions) + r];
    for (std::size_t a = 0; a < all.size(); ++a) {
      const bool below = all[a] < m;
      entries.push_back({all[a], below ? find_slot(m, all[a]) : find_slot(all[a], m), below});
      for (std::size_t b = 0; b <= a; ++b)
        products.push_back(find_slot(all[a], all[b]));
    }
    multiplier.push_back(m);
    first_entry.push_back(static_cast<int>(entries.size()));
  }
}

// Rows and columns to largest entries of one, by square roots from both sides (Ruiz, A scaling algorithm to
// equilibrate both rows and columns norms in matrices, 2001). Afresh, so that no answer depends on those
// before.
void SparseFactorization::State::equilibrate() {
  constexpr double even = 1.2; // further apart rows need another pass
  std::ranges::fill(lower, 0);
  std::ranges::fill(upper, 0);
  for (std::size_t e = 0; e < slot.size(); ++e)
    if (slot[e] >= 0)
      lower[slot_at(slot[e])] += given[e];
    else
      upper[slot_at(-1 - slot[e])] += given[e];
  scale.setOnes(pattern.size);
  for (int pass = 0;; ++pass) {
    largest.setZero(pattern.size);
    for_entries([&](int i, int j, std::size_t e) {
      const double entry =
          upper.empty() ? std::abs(lower[e]) : std::max(std::abs(lower[e]), std::abs(upper[e]));
      const double size = entry * (scale[i] * scale[j]);
      largest[i] = std::max(largest[i], size);
      largest[j] = std::max(largest[j], size);
    });
    bool done = true;
    for (double& x : largest) {
      x = x > 0 ? 1 / std::sqrt(x) : 1;
      done = done && x < even && x * even > 1;
    }
    if (done || pass == 6) break;
    scale.array() *= largest.array();
  }
  for_entries([&](int i, int j, std::size_t e) {
    lower[e] *= scale[i] * scale[j];
    if (!upper.empty()) upper[e] *= scale[i] * scale[j];
  });
}

// Adds rho J^T J.
void SparseFactorization::State::augment(std::vector<double>& with_lower,
                                         std::vector<double>& with_upper) const {
  const int* product = products.data();
  for (std::size_t r = 0; r < multiplier.size(); ++r)
    for (int a = first_entry[r]; a < first_entry[r + 1]; ++a)
      for (int b = first_entry[r]; b <= a; ++b) {
        const std::size_t e = slot_at(*product++);
        const double added = augmentation * gradient(entries[slot_at(a)]) * gradient(entries[slot_at(b)]);
        with_lower[e] += added;
        if (!upper.empty()) with_upper[e] += added;
      }
}

// What x leaves of what is wanted, compared with the terms of each equation (Oettli and Prager, 1964), or
// with a thousandth of the largest of all.
double SparseFactorization::State::leave(const Eigen::VectorXd& x) {
  left = wanted;
  terms = wanted.cwiseAbs();
  const auto take = [&](int row, double term) {
    left[row] -= term;
    terms[row] += std::abs(term);
  };
  const std::vector<double>& transposed = upper.empty() ? lower : upper;
  for_entries([&](int i, int j, std::size_t e) {
    take(i, lower[e] * x[j]);
    if (i != j) take(j, transposed[e] * x[i]);
  });
  const double floor = std::max(1e-3 * terms.maxCoeff(), 1e-300);
  return (left.array().abs() / terms.array().max(floor)).maxCoeff();
}

// By the augmented matrix, whose right-hand side has rho J^T times that of the rows more.
void SparseFactorization::State::substitute(Eigen::VectorXd& x) {
  for (std::size_t r = 0; r < multiplier.size(); ++r)
    if (const double closing = augmentation * x[multiplier[r]];
        closing != 0 && !left_out[slot_at(multiplier[r])])
      for (int e = first_entry[r]; e < first_entry[r + 1]; ++e)
        x[entries[slot_at(e)].motion] += closing * gradient(entries[slot_at(e)]);
  factors.solve(x);
}

SparseFactorization::SparseFactorization() = default;
SparseFactorization::~SparseFactorization() = default;
SparseFactorization::SparseFactorization(SparseFactorization&&) noexcept = default;
SparseFactorization& SparseFactorization::operator=(SparseFactorization&&) noexcept = default;

void SparseFactorization::factor(const SparsePattern& pattern, const std::vector<double>& values,
                                 double zero) {
  if (!state_) state_ = std::make_unique<State>();
  State& s = *state_;
  const bool known = s.analysed && s.pattern == pattern;
  if (known && s.factored && s.zero == zero && s.given == values) return;
  s.factored = false;
  if (!known) {
    s.analysed = false;
    s.pattern = pattern;
    s.analyse();
    s.analysed = true;
  }
  s.given = values;
  s.zero = zero;
  s.equilibrate();
  s.null_space.resize(0, 0);
  s.largest.setZero(pattern.size); // sums of rows
  s.for_entries([&](int i, int j, std::size_t e) {
    s.largest[i] += std::abs(s.lower[e]);
    if (i != j) s.largest[j] += std::abs(s.lower[e]);
  });
  std::vector<double> with_lower = s.lower, with_upper = s.upper;
  s.augment(with_lower, with_upper);
  s.factors.factor(with_lower, with_upper, pattern.size > 0 ? zero * s.largest.maxCoeff() : 0);
  s.left_out.assign(slot_at(pattern.size), false);
  for (int i = 0; i < s.factors.nullity(); ++i)
    if (const int u = s.factors.null_unknown(i); u >= 0) s.left_out[slot_at(u)] = true;
  s.factored = true;
}

void SparseFactorization::solve(Eigen::VectorXd& x, double enough) {
  State& s = *state_;
  s.wanted.resize(x.size());
  for (Eigen::Index p = 0; p < x.size(); ++p)
    s.wanted[p] = x[s.order[static_cast<std::size_t>(p)]] * s.scale[p];
  Eigen::VectorXd y = s.wanted;
  s.substitute(y);
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 4; ++round) {
    const double error = s.leave(y);
    if (!(error > enough) || !(error < 0.5 * before)) break;
    before = error;
    s.substitute(s.left);
    y += s.left;
  }
  for (Eigen::Index p = 0; p < x.size(); ++p)
    x[s.order[static_cast<std::size_t>(p)]] = y[p] * s.scale[p];
}

int SparseFactorization::negative() const {
  return state_->factors.negative();
}

int SparseFactorization::nullity() const {
  return state_->factors.nullity();
}

const Eigen::MatrixXd& SparseFactorization::null_space() {
  State& s = *state_;
  if (s.null_space.cols() == nullity()) return s.null_space;
  s.null_space.resize(s.pattern.size, nullity());
  Eigen::VectorXd one(s.pattern.size);
  for (int i = 0; i < nullity(); ++i) {
    s.factors.null_vector(i, one);
    for (Eigen::Index p = 0; p < one.size(); ++p)
      s.null_space(s.order[static_cast<std::size_t>(p)], i) = one[p] * s.scale[p];
  }
  return s.null_space;
}

} // namespace flyball
