#include "engine/kkt/body_entries.hpp"

#include "engine/system/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace flyball {
namespace {

// Calls work(list) for each, side by side.
template <class Lists, class Work>
void for_lists(Lists& lists, const Work& work) {
  side_by_side(lists.size(), [&](std::size_t i) { work(lists[i]); });
}

} // namespace

void BodyEntries::clear(int bodies, int multipliers, bool symmetric, std::size_t lists, Zeros zeros) {
  keep_zeros_ = zeros == Zeros::kept;
  first_multiplier_ = static_cast<std::size_t>(6 * bodies);
  const int unknowns = 6 * bodies + multipliers;
  pattern_.clear(unknowns, symmetric);
  lists_.resize(lists);
  for (List& list : lists_) {
    list.rows.clear();
    list.columns.clear();
    list.values.clear();
  }
  unconstrained_.assign(static_cast<std::size_t>(unknowns), false);
}

void BodyEntries::List::add(int row, int column, const Value& value) {
  rows.push_back(row);
  columns.push_back(column);
  values.push_back(value);
}

void BodyEntries::add_body(std::size_t list, int node, const Mat6& stiffness, const Mat6& metric) {
  const bool symmetric = pattern_.symmetric;
  const int at = 6 * node;
  for (int j = 0; j < 6; ++j)
    for (int i = symmetric ? j : 0; i < 6; ++i)
      lists_[list].add(
          at + i, at + j,
          {symmetric ? (stiffness(i, j) + stiffness(j, i)) / 2 : stiffness(i, j), metric(i, j), 0});
}

// Point masses feel no turns, neither their own nor each other's.
void BodyEntries::add_between(std::size_t list, int a, int b, const Mat6& ab, const Mat6& ba,
                              const Mat6& metric_ab) {
  for (const int i : {0, 3})
    for (const int j : {0, 3}) {
      const bool shifts = i == 3 && j == 3;
      if (shifts || keep_zeros_ || !ab.block<3, 3>(i, j).isZero(0) || !ba.block<3, 3>(j, i).isZero(0) ||
          !metric_ab.block<3, 3>(i, j).isZero(0))
        add_block(lists_[list], a, i, b, j, ab, ba, metric_ab);
    }
}

void BodyEntries::add_block(List& list, int a, int first_i, int b, int first_j, const Mat6& ab,
                            const Mat6& ba, const Mat6& metric_ab) {
  for (int j = first_j; j < first_j + 3; ++j)
    for (int i = first_i; i < first_i + 3; ++i) {
      if (pattern_.symmetric) {
        list.add(6 * a + i, 6 * b + j, {(ab(i, j) + ba(j, i)) / 2, metric_ab(i, j), 0});
      } else {
        list.add(6 * a + i, 6 * b + j, {ab(i, j), metric_ab(i, j), 0});
        list.add(6 * b + j, 6 * a + i, {ba(j, i), metric_ab(i, j), 0});
      }
    }
}

void BodyEntries::add_row(std::size_t list, int row, int node, const Vec6& gradient) {
  if (node < 0) return;
  for (int i = !keep_zeros_ && gradient.head<3>().isZero(0) ? 3 : 0; i < 6; ++i) {
    lists_[list].add(row, 6 * node + i, {0, 0, gradient[i]});
    if (!pattern_.symmetric) lists_[list].add(6 * node + i, row, {0, 0, gradient[i]});
  }
}

void BodyEntries::keep_all_with_metric() {
  for_lists(lists_, [&](List& list) {
    for (Value& value : list.values)
      std::swap(value.stiffness, value.metric);
  });
  number();
}

void BodyEntries::drop_unconstrained_below(const std::vector<double>& noise) {
  const std::size_t motions = 6 * noise.size();
  largest_.assign(motions, 0);
  const auto measure = [&](const List& list) {
    for (std::size_t e = 0; e < list.values.size(); ++e) {
      const Value& value = list.values[e];
      const double size =
          value.fixed != 0 ? std::numeric_limits<double>::infinity() : std::abs(value.stiffness);
      for (const int at : {list.rows[e], list.columns[e]})
        if (const auto u = static_cast<std::size_t>(at); u < motions)
          largest_[u] = std::max(largest_[u], size);
    }
  };
  // Each its own motions; the last, of what is between the others, theirs.
  const std::span<const List> all = lists_;
  if (all.size() > 1) {
    const std::span<const List> apart = all.first(all.size() - 1);
    for_lists(apart, measure);
  }
  measure(all.back());
  bool any = false;
  for (std::size_t u = 0; u < motions; ++u)
    if (largest_[u] <= noise[u / 6]) unconstrained_[u] = any = true;
  if (any) for_lists(lists_, [&](List& list) { drop_unconstrained(list); });
  number();
}

void BodyEntries::drop_unconstrained(List& list) const {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < list.values.size(); ++e) {
    const int row = list.rows[e], column = list.columns[e];
    if (unconstrained_[static_cast<std::size_t>(row)] || unconstrained_[static_cast<std::size_t>(column)])
      continue;
    list.rows[kept] = row;
    list.columns[kept] = column;
    list.values[kept++] = list.values[e];
  }
  list.rows.resize(kept);
  list.columns.resize(kept);
  list.values.resize(kept);
}

// Numbers what is solved for, and tells the matrix.
void BodyEntries::number() {
  place_.resize(unconstrained_.size());
  int next = 0;
  for (std::size_t u = 0; u < unconstrained_.size(); ++u) {
    if (u == first_multiplier_) pattern_.motions = next;
    place_[u] = unconstrained_[u] ? -1 : next++;
  }
  pattern_.size = next;
  if (first_multiplier_ == unconstrained_.size()) pattern_.motions = next;
  std::size_t entries = 0;
  for (List& list : lists_) {
    list.begin = entries;
    entries += list.values.size();
  }
  pattern_.rows.resize(entries);
  pattern_.columns.resize(entries);
  sum_.resize(entries);
  for_lists(lists_, [&](const List& list) {
    for (std::size_t e = 0; e < list.values.size(); ++e) {
      pattern_.rows[list.begin + e] = place_[static_cast<std::size_t>(list.rows[e])];
      pattern_.columns[list.begin + e] = place_[static_cast<std::size_t>(list.columns[e])];
    }
  });
}

const std::vector<double>& BodyEntries::sum(double stiffness, double metric) {
  for_lists(lists_, [&](const List& list) {
    double* out = sum_.data() + list.begin;
    for (const Value& value : list.values)
      *out++ = stiffness * value.stiffness + metric * value.metric + value.fixed;
  });
  return sum_;
}

void BodyEntries::gather(const Eigen::VectorXd& unknowns, Eigen::VectorXd& reduced) const {
  reduced.resize(pattern_.size);
  for (std::size_t u = 0; u < place_.size(); ++u)
    if (const int at = place_[u]; at >= 0) reduced[at] = unknowns[static_cast<Eigen::Index>(u)];
}

void BodyEntries::spread(const Eigen::Ref<const Eigen::VectorXd>& reduced, Eigen::VectorXd& unknowns) const {
  unknowns.resize(static_cast<Eigen::Index>(place_.size()));
  for (std::size_t u = 0; u < place_.size(); ++u)
    unknowns[static_cast<Eigen::Index>(u)] = place_[u] >= 0 ? reduced[place_[u]] : 0;
}

} // namespace flyball
