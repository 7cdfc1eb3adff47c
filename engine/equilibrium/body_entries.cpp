#include "engine/equilibrium/body_entries.hpp"

#include <cmath>
#include <limits>

namespace flyball {

void BodyEntries::clear(int unknowns, bool symmetric) {
  pattern_.clear(unknowns, symmetric);
  values_.clear();
  loose_.assign(static_cast<std::size_t>(unknowns), false);
}

void BodyEntries::add(int row, int column, const Value& value) {
  pattern_.rows.push_back(row + 1);
  pattern_.columns.push_back(column + 1);
  values_.push_back(value);
}

void BodyEntries::add_body(int node, const Mat6& stiffness, const Mat6& metric) {
  const bool symmetric = pattern_.symmetric;
  const int at = 6 * node;
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
  for (int i = 0; i < 6; ++i) {
    add(row, 6 * node + i, {0, 0, gradient[i]});
    if (!pattern_.symmetric) add(6 * node + i, row, {0, 0, gradient[i]});
  }
}

void BodyEntries::hold_all_by_metric() {
  for (Value& value : values_)
    std::swap(value.stiffness, value.metric);
  number();
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
  if (any) drop_loose();
  number();
}

void BodyEntries::drop_loose() {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const auto row = static_cast<std::size_t>(pattern_.rows[e] - 1);
    const auto column = static_cast<std::size_t>(pattern_.columns[e] - 1);
    if (loose_[row] || loose_[column]) continue;
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
  place_.resize(loose_.size());
  int next = 0;
  for (std::size_t u = 0; u < loose_.size(); ++u)
    place_[u] = loose_[u] ? -1 : next++;
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

void BodyEntries::gather(const Eigen::VectorXd& unknowns, Eigen::VectorXd& held) const {
  held.resize(pattern_.size);
  for (std::size_t u = 0; u < place_.size(); ++u)
    if (const int at = place_[u]; at >= 0) held[at] = unknowns[static_cast<Eigen::Index>(u)];
}

void BodyEntries::spread(const Eigen::Ref<const Eigen::VectorXd>& held, Eigen::VectorXd& unknowns) const {
  unknowns.resize(static_cast<Eigen::Index>(place_.size()));
  for (std::size_t u = 0; u < place_.size(); ++u) {
    const int at = place_[u];
    unknowns[static_cast<Eigen::Index>(u)] = at >= 0 ? held[at] : 0;
  }
}

} // namespace flyball
