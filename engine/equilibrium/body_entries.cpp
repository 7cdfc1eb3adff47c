#include "engine/equilibrium/body_entries.hpp"

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace flyball {

void BodyEntries::clear(int unknowns, bool symmetric) {
  pattern_.clear(unknowns, symmetric);
  values_.clear();
  bodies_ = 0;
  loose_.assign(static_cast<std::size_t>(unknowns), false);
  turns_apart_.clear();
}

void BodyEntries::add(int row, int column, const Value& value) {
  pattern_.rows.push_back(row + 1);
  pattern_.columns.push_back(column + 1);
  values_.push_back(value);
}

void BodyEntries::add_body(int node, const Mat6& stiffness, const Mat6& metric) {
  const bool symmetric = pattern_.symmetric;
  const int at = 6 * node;
  bodies_ = std::max(bodies_, node + 1);
  for (int j = 0; j < 6; ++j)
    for (int i = symmetric ? j : 0; i < 6; ++i)
      add(at + i, at + j,
          {symmetric ? (stiffness(i, j) + stiffness(j, i)) / 2 : stiffness(i, j), metric(i, j), 0});
}

// Point masses feel no turns, neither their own nor each other's.
void BodyEntries::add_between(int a, int b, const Mat6& ab, const Mat6& ba, const Mat6& metric_ab) {
  for (const int i : {0, 3})
    for (const int j : {0, 3}) {
      const bool shifts = i == 3 && j == 3;
      if (shifts || !ab.block<3, 3>(i, j).isZero(0) || !ba.block<3, 3>(j, i).isZero(0) ||
          !metric_ab.block<3, 3>(i, j).isZero(0))
        add_block(a, i, b, j, ab, ba, metric_ab);
    }
}

void BodyEntries::add_block(int a, int first_i, int b, int first_j, const Mat6& ab, const Mat6& ba,
                            const Mat6& metric_ab) {
  for (int j = first_j; j < first_j + 3; ++j)
    for (int i = first_i; i < first_i + 3; ++i) {
      if (pattern_.symmetric) {
        add(6 * a + i, 6 * b + j, {(ab(i, j) + ba(j, i)) / 2, metric_ab(i, j), 0});
      } else {
        add(6 * a + i, 6 * b + j, {ab(i, j), metric_ab(i, j), 0});
        add(6 * b + j, 6 * a + i, {ba(j, i), metric_ab(i, j), 0});
      }
    }
}

void BodyEntries::add_row(int row, int node, const Vec6& gradient) {
  if (node < 0) return;
  for (int i = gradient.head<3>().isZero(0) ? 3 : 0; i < 6; ++i) {
    add(row, 6 * node + i, {0, 0, gradient[i]});
    if (!pattern_.symmetric) add(6 * node + i, row, {0, 0, gradient[i]});
  }
}

void BodyEntries::hold_all_by_metric() {
  for (Value& value : values_)
    std::swap(value.stiffness, value.metric);
  take_turns_apart();
  number();
}

// Of bodies that loops hold at their mass centres.
void BodyEntries::take_turns_apart() {
  apart_.assign(static_cast<std::size_t>(bodies_), 0);
  const auto turning = [&](int place) { // the body, if it is a turn
    const int u = place - 1;
    return u < 6 * bodies_ && u % 6 < 3 ? u / 6 : -1;
  };
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const int a = turning(pattern_.rows[e]), b = turning(pattern_.columns[e]);
    if (a == b) continue;
    for (const int n : {a, b})
      if (n >= 0) apart_[static_cast<std::size_t>(n)] = -1;
  }
  for (std::size_t n = 0; n < apart_.size(); ++n) {
    if (apart_[n] < 0) continue;
    apart_[n] = static_cast<int>(turns_apart_.size());
    turns_apart_.emplace_back(static_cast<int>(6 * n), Mat3::Zero());
  }
  if (turns_apart_.empty()) return;
  drop([&](std::size_t e) {
    const int n = turning(pattern_.rows[e]);
    const int at = n < 0 ? -1 : apart_[static_cast<std::size_t>(n)];
    if (at < 0) return false;
    const int i = pattern_.rows[e] - 1 - 6 * n, j = pattern_.columns[e] - 1 - 6 * n;
    Mat3& block = turns_apart_[static_cast<std::size_t>(at)].second;
    block(i, j) = block(j, i) = values_[e].stiffness;
    return true;
  });
  for (auto& [u, block] : turns_apart_)
    block = block.inverse().eval();
}

void BodyEntries::hold_above(const std::vector<double>& noise) {
  largest_.assign(loose_.size(), 0);
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const double size =
        values_[e].fixed != 0 ? std::numeric_limits<double>::infinity() : std::abs(values_[e].stiffness);
    for (int at : {pattern_.rows[e] - 1, pattern_.columns[e] - 1})
      largest_[static_cast<std::size_t>(at)] = std::max(largest_[static_cast<std::size_t>(at)], size);
  }
  bool any = false;
  for (std::size_t n = 0; n < noise.size(); ++n)
    for (std::size_t u = 6 * n; u < 6 * n + 6; ++u)
      if (largest_[u] <= noise[n]) loose_[u] = any = true;
  if (any)
    drop([&](std::size_t e) {
      return loose_[static_cast<std::size_t>(pattern_.rows[e] - 1)] ||
             loose_[static_cast<std::size_t>(pattern_.columns[e] - 1)];
    });
  number();
}

template <class Drops>
void BodyEntries::drop(Drops drops) {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < values_.size(); ++e) {
    if (drops(e)) continue;
    pattern_.rows[kept] = pattern_.rows[e];
    pattern_.columns[kept] = pattern_.columns[e];
    values_[kept++] = values_[e];
  }
  pattern_.rows.resize(kept);
  pattern_.columns.resize(kept);
  values_.resize(kept);
}

// Numbers what is solved for.
void BodyEntries::number() {
  place_.assign(loose_.size(), 0);
  for (const auto& [u, block] : turns_apart_)
    std::fill_n(place_.begin() + u, 3, -1);
  int next = 0;
  for (std::size_t u = 0; u < loose_.size(); ++u)
    place_[u] = loose_[u] || place_[u] < 0 ? -1 : next++;
  pattern_.size = next;
  for (std::vector<int>* list : {&pattern_.rows, &pattern_.columns})
    for (int& i : *list)
      i = place_[static_cast<std::size_t>(i - 1)] + 1;
}

const std::vector<double>& BodyEntries::sum(double stiffness, double metric) {
  sum_.resize(values_.size());
  for (std::size_t e = 0; e < values_.size(); ++e)
    sum_[e] = stiffness * values_[e].stiffness + metric * values_[e].metric + values_[e].fixed;
  return sum_;
}

void BodyEntries::gather(Eigen::VectorXd& unknowns, Eigen::VectorXd& held) const {
  held.resize(pattern_.size);
  for (std::size_t u = 0; u < place_.size(); ++u)
    if (const int at = place_[u]; at >= 0) held[at] = unknowns[static_cast<Eigen::Index>(u)];
  for (const auto& [u, inverse] : turns_apart_)
    unknowns.segment<3>(u) = inverse * unknowns.segment<3>(u).eval();
}

void BodyEntries::spread(const Eigen::Ref<const Eigen::VectorXd>& held, Eigen::VectorXd& unknowns) const {
  unknowns.resize(static_cast<Eigen::Index>(place_.size()));
  for (std::size_t u = 0; u < place_.size(); ++u) {
    const auto at = static_cast<Eigen::Index>(u);
    if (place_[u] >= 0)
      unknowns[at] = held[place_[u]];
    else if (loose_[u])
      unknowns[at] = 0;
  }
}

} // namespace flyball
