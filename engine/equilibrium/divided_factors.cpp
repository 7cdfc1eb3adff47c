#include "engine/equilibrium/divided_factors.hpp"

#include "engine/equilibrium/elimination_order.hpp"
#include "engine/system/side_by_side.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr int many = 15000; // unknowns; fewer take some milliseconds, and sweeps keep all cores busy anyway

} // namespace

void DividedFactors::begin(const SparsePattern& pattern) {
  close();
  if (!pattern.symmetric || pattern.size < many) return;
  const std::vector<Side> side = halve(pattern);
  const auto count = static_cast<std::size_t>(std::ranges::count(side, Side::between));
  // What is between is full. It should be no more than a part of what there is anyway.
  if (count == 0 || count * (count + 1) / 2 > pattern.rows.size() / 2) return;
  distribute(pattern, side);
  if (halves_[0].unknowns.empty() || halves_[1].unknowns.empty()) return;
  open_ = analyse();
  if (!open_) close();
}

bool DividedFactors::analyse() {
  std::atomic<bool> done = true;
  side_by_side(halves_.size(), [&](std::size_t i) {
    Half& half = halves_[i];
    half.order = elimination_order(half.pattern, half.last, half.mumps.copy());
    half.mumps.open(half.pattern);
    half.mumps.prepare(half.order);
    half.left.assign(half.last.size() * half.last.size(), 0);
    half.mumps.leave(half.last, half.left.data());
    half.mumps.data.a = half.values.data();
    half.mumps.run(Mumps::analyse);
    if (half.mumps.failed()) done = false;
  });
  root_.open(root_pattern_);
  root_.prepare(root_order_);
  root_.data.a = root_values_.data();
  root_.run(Mumps::analyse);
  return done && !root_.failed();
}

void DividedFactors::close() {
  for (Half& half : halves_)
    half.mumps.close();
  root_.close();
  open_ = false;
}

void DividedFactors::distribute(const SparsePattern& pattern, const std::vector<Side>& side) {
  between_.clear();
  of_root_.clear();
  for (Half& half : halves_) {
    half.unknowns.clear();
    half.entries.clear();
    half.pattern.clear(0, true);
  }
  const auto half_of = [&](Side s) -> Half& { return halves_[s == Side::first ? 0 : 1]; };
  std::vector<int> number(side.size()); // from 1, in its half or between
  std::vector<int> entries(side.size(), 0);
  for (std::size_t u = 0; u < side.size(); ++u) {
    std::vector<int>& all = side[u] == Side::between ? between_ : half_of(side[u]).unknowns;
    all.push_back(static_cast<int>(u));
    number[u] = static_cast<int>(all.size());
  }
  for (std::size_t e = 0; e < pattern.rows.size(); ++e) {
    const auto i = static_cast<std::size_t>(pattern.rows[e] - 1),
               j = static_cast<std::size_t>(pattern.columns[e] - 1);
    ++entries[i];
    if (i != j) ++entries[j];
    const auto [a, b] = std::minmax({number[i] - 1, number[j] - 1});
    if (side[i] == Side::between && side[j] == Side::between) {
      of_root_.push_back({e, place(static_cast<std::size_t>(b), static_cast<std::size_t>(a))});
      continue;
    }
    Half& half = half_of(std::min(side[i], side[j]));
    const int own = static_cast<int>(half.unknowns.size());
    half.pattern.rows.push_back(number[i] + (side[i] == Side::between ? own : 0));
    half.pattern.columns.push_back(number[j] + (side[j] == Side::between ? own : 0));
    half.entries.push_back(e);
  }
  norm_ = *std::ranges::max_element(entries);
  for (Half& half : halves_) {
    const int own = static_cast<int>(half.unknowns.size());
    half.pattern.size = own + static_cast<int>(between_.size());
    half.values.resize(half.entries.size());
    half.x.resize(half.pattern.size);
    half.last.clear();
    for (int u = own + 1; u <= half.pattern.size; ++u)
      half.last.push_back(u);
  }
  root_pattern_.clear(static_cast<int>(between_.size()), true);
  for (int j = 1; j <= root_pattern_.size; ++j)
    for (int i = j; i <= root_pattern_.size; ++i) {
      root_pattern_.rows.push_back(i);
      root_pattern_.columns.push_back(j);
    }
  root_values_.resize(root_pattern_.rows.size());
}

std::size_t DividedFactors::place(std::size_t i, std::size_t j) const {
  return j * between_.size() - j * (j + 1) / 2 + i;
}

bool DividedFactors::factor(const std::vector<double>& values, double zero) {
  std::atomic<bool> done = true;
  side_by_side(halves_.size(), [&](std::size_t i) {
    Half& half = halves_[i];
    for (std::size_t e = 0; e < half.entries.size(); ++e)
      half.values[e] = values[half.entries[e]];
    half.mumps.set_zero(-norm_ * zero);
    if (!half.mumps.run_factorise()) done = false;
  });
  if (!done) { // the whole may need what they hold
    close();
    return false;
  }
  if (halves_[0].mumps.nullity() + halves_[1].mumps.nullity() > 0 || !add_up(values, zero)) return false;
  root_.set_zero(-norm_ * zero);
  return root_.run_factorise() && root_.nullity() == 0;
}

// What the halves leave of the unknowns between them, and what these are by themselves. False where a half is
// nearly singular: it leaves large numbers, and in their differences a pivot of `zero` may be rounding. (Nets
// of rods, whose spins are pivots of zero, did not come to rest with twenty times as much.)
bool DividedFactors::add_up(const std::vector<double>& values, double zero) {
  const double most = zero / std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < between_.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const std::size_t at = i * between_.size() + j;
      const double a = halves_[0].left[at], b = halves_[1].left[at];
      if (!(std::abs(a) < most && std::abs(b) < most)) return false;
      root_values_[place(i, j)] = a + b;
    }
  for (const OfRoot& of : of_root_)
    root_values_[of.place] += values[of.entry];
  return true;
}

// The halves one after the other: their steps are too small to be made at once.
void DividedFactors::solve(Eigen::VectorXd& x) {
  const auto count = static_cast<Eigen::Index>(between_.size());
  root_x_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i)
    root_x_[i] = x[between_[static_cast<std::size_t>(i)]];
  for (Half& half : halves_) {
    half.x.tail(count).setZero();
    for (std::size_t i = 0; i < half.unknowns.size(); ++i)
      half.x[static_cast<Eigen::Index>(i)] = x[half.unknowns[i]];
    half.reduced.setZero(count);
    half.mumps.reduce(half.x.data(), half.reduced.data());
    root_x_ += half.reduced;
  }
  root_.run_substitute(root_x_.data());
  for (Half& half : halves_) {
    half.reduced = root_x_;
    half.mumps.expand(half.x.data(), half.reduced.data());
    for (std::size_t i = 0; i < half.unknowns.size(); ++i)
      x[half.unknowns[i]] = half.x[static_cast<Eigen::Index>(i)];
  }
  for (Eigen::Index i = 0; i < count; ++i)
    x[between_[static_cast<std::size_t>(i)]] = root_x_[i];
}

int DividedFactors::negative() const {
  return halves_[0].mumps.negative() + halves_[1].mumps.negative() + root_.negative();
}

} // namespace flyball
