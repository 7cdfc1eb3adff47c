#include "engine/kkt/body_entries.hpp"

#include "engine/system/side_by_side.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace flyball {
namespace {

// Of a body's metric, where as a rule turns about its mass centre and shifts have nothing to do with each
// other.
Mat6 inverse(const Mat6& metric) {
  if (!metric.bottomLeftCorner<3, 3>().isZero(0)) return metric.inverse();
  Mat6 x = Mat6::Zero();
  x.topLeftCorner<3, 3>() = metric.topLeftCorner<3, 3>().inverse();
  x.bottomRightCorner<3, 3>() = metric.bottomRightCorner<3, 3>().inverse();
  return x;
}

// Calls work(list) for each, side by side.
template <class Lists, class Work>
void for_lists(Lists& lists, const Work& work) {
  side_by_side(lists.size(), [&](std::size_t i) { work(lists[i]); });
}

} // namespace

void BodyEntries::clear(int unknowns, bool symmetric, std::size_t lists) {
  pattern_.clear(unknowns, symmetric);
  lists_.resize(lists);
  for (List& list : lists_) {
    list.rows.clear();
    list.columns.clear();
    list.values.clear();
  }
  loose_.assign(static_cast<std::size_t>(unknowns), false);
  alone_.clear();
  first_line_.clear();
  lines_.clear();
}

void BodyEntries::List::add(int row, int column, const Value& value) {
  rows.push_back(row);
  columns.push_back(column);
  values.push_back(value);
}

void BodyEntries::set_apart(const std::vector<int>& lines) {
  alone_.resize(lines.size());
  blocks_.resize(lines.size());
  first_line_.assign(lines.size() + 1, 0);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    alone_[n] = lines[n] >= 0;
    first_line_[n + 1] = first_line_[n] + std::max(lines[n], 0);
  }
  next_line_.assign(first_line_.begin(), first_line_.end() - 1);
  lines_.resize(static_cast<std::size_t>(first_line_.back()));
}

void BodyEntries::add_body(std::size_t list, int node, const Mat6& stiffness, const Mat6& metric) {
  if (apart(node)) {
    blocks_[static_cast<std::size_t>(node)] = inverse(metric);
    return;
  }
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
      if (shifts || !ab.block<3, 3>(i, j).isZero(0) || !ba.block<3, 3>(j, i).isZero(0) ||
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
  if (apart(node)) {
    lines_[static_cast<std::size_t>(next_line_[static_cast<std::size_t>(node)]++)] = {row, gradient};
    return;
  }
  for (int i = gradient.head<3>().isZero(0) ? 3 : 0; i < 6; ++i) {
    lists_[list].add(row, 6 * node + i, {0, 0, gradient[i]});
    if (!pattern_.symmetric) lists_[list].add(6 * node + i, row, {0, 0, gradient[i]});
  }
}

void BodyEntries::hold_all_by_metric() {
  for_lists(lists_, [&](List& list) {
    for (Value& value : list.values)
      std::swap(value.stiffness, value.metric);
    const auto i = static_cast<std::size_t>(&list - lists_.data()), bodies = alone_.size();
    for (std::size_t n = bodies * i / lists_.size(); n < bodies * (i + 1) / lists_.size(); ++n)
      if (alone_[n]) leave_rows_of(n, list);
  });
  number();
}

// What is left of a body's rows when its motion is eliminated: - G B^-1 G^T.
void BodyEntries::leave_rows_of(std::size_t n, List& list) const {
  for (int i = first_line_[n]; i < first_line_[n + 1]; ++i) {
    const Line& a = lines_[static_cast<std::size_t>(i)];
    const Vec6 moved = blocks_[n] * a.gradient;
    for (int j = first_line_[n]; j <= i; ++j) {
      const Line& b = lines_[static_cast<std::size_t>(j)];
      const double twice = a.row == b.row && i != j ? 2 : 1;
      list.add(std::max(a.row, b.row), std::min(a.row, b.row), {-twice * moved.dot(b.gradient), 0, 0});
    }
  }
}

void BodyEntries::hold_above(const std::vector<double>& noise) {
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
    if (largest_[u] <= noise[u / 6]) loose_[u] = any = true;
  if (any) for_lists(lists_, [&](List& list) { drop_loose(list); });
  number();
}

void BodyEntries::drop_loose(List& list) const {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < list.values.size(); ++e) {
    const int row = list.rows[e], column = list.columns[e];
    if (loose_[static_cast<std::size_t>(row)] || loose_[static_cast<std::size_t>(column)]) continue;
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
  place_.assign(loose_.size(), 0);
  for (std::size_t n = 0; n < alone_.size(); ++n)
    if (alone_[n]) std::fill_n(place_.begin() + static_cast<std::ptrdiff_t>(6 * n), 6, -1);
  int next = 0;
  for (std::size_t u = 0; u < loose_.size(); ++u)
    place_[u] = loose_[u] || place_[u] < 0 ? -1 : next++;
  pattern_.size = next;
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
      pattern_.rows[list.begin + e] = place_[static_cast<std::size_t>(list.rows[e])] + 1;
      pattern_.columns[list.begin + e] = place_[static_cast<std::size_t>(list.columns[e])] + 1;
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

void BodyEntries::gather(Eigen::VectorXd& unknowns, Eigen::VectorXd& held) const {
  for (std::size_t n = 0; n < alone_.size(); ++n) {
    if (!alone_[n]) continue;
    auto motion = unknowns.segment<6>(static_cast<Eigen::Index>(6 * n));
    motion = blocks_[n] * motion.eval();
    for (int i = first_line_[n]; i < first_line_[n + 1]; ++i) {
      const Line& line = lines_[static_cast<std::size_t>(i)];
      unknowns[line.row] -= line.gradient.dot(motion);
    }
  }
  held.resize(pattern_.size);
  for (std::size_t u = 0; u < place_.size(); ++u)
    if (const int at = place_[u]; at >= 0) held[at] = unknowns[static_cast<Eigen::Index>(u)];
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
  for (std::size_t n = 0; n < alone_.size(); ++n) {
    if (!alone_[n]) continue;
    Vec6 wrench = Vec6::Zero();
    for (int i = first_line_[n]; i < first_line_[n + 1]; ++i) {
      const Line& line = lines_[static_cast<std::size_t>(i)];
      wrench += unknowns[line.row] * line.gradient;
    }
    unknowns.segment<6>(static_cast<Eigen::Index>(6 * n)) -= blocks_[n] * wrench;
  }
}

} // namespace flyball
