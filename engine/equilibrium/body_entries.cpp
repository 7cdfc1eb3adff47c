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
  alone_.clear();
  first_line_.clear();
  lines_.clear();
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
  take_bodies_apart();
  number();
}

// The body of a motion, by its place in the pattern; -1: a multiplier.
int BodyEntries::body_at(int place) const {
  return place <= 6 * bodies_ ? (place - 1) / 6 : -1;
}

// Bodies that meet no other but by rows.
void BodyEntries::take_bodies_apart() {
  find_bodies_apart();
  take_lines();
  for (std::size_t n = 0; n < alone_.size(); ++n)
    if (alone_[n]) leave_rows_of(n);
}

namespace {

// Entries of one row by one body's motion come one after the other.
struct LineReader {
  int row = -1, body = -1;
  bool begins(int next_row, int next_body) {
    const bool same = row == next_row && body == next_body;
    row = next_row;
    body = next_body;
    return !same;
  }
};

} // namespace

// Which they are, their metric, and how many lines they have. Much lighter ones than the rest stay: they
// would leave of their rows what they do themselves, and nothing of the others.
void BodyEntries::find_bodies_apart() {
  constexpr double light = 1e-3; // beside the heaviest
  constexpr int many = 24;       // lines of one body, which all would meet
  const auto count = static_cast<std::size_t>(bodies_);
  alone_.assign(count, true);
  blocks_.assign(count, Mat6::Zero());
  first_line_.assign(count + 1, 0);
  LineReader reader;
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const int a = body_at(pattern_.rows[e]), b = body_at(pattern_.columns[e]);
    const auto at = static_cast<std::size_t>(b);
    if (a < 0) {
      if (reader.begins(pattern_.rows[e], b)) ++first_line_[at + 1];
    } else if (a == b) {
      const int i = pattern_.rows[e] - 1 - 6 * a, j = pattern_.columns[e] - 1 - 6 * a;
      blocks_[at](i, j) = blocks_[at](j, i) = values_[e].stiffness;
    } else {
      alone_[static_cast<std::size_t>(a)] = alone_[at] = false;
    }
  }
  double heaviest = 0;
  for (const Mat6& block : blocks_)
    heaviest = std::max(heaviest, block.diagonal().minCoeff());
  for (std::size_t n = 0; n < count; ++n) {
    const int own = first_line_[n + 1];
    if (own > many || !(blocks_[n].diagonal().minCoeff() > light * heaviest)) alone_[n] = false;
    first_line_[n + 1] = first_line_[n] + (alone_[n] ? own : 0);
  }
}

// From the entries to lists of their own.
void BodyEntries::take_lines() {
  lines_.resize(static_cast<std::size_t>(first_line_.back()));
  next_line_.assign(first_line_.begin(), first_line_.end() - 1);
  LineReader reader;
  drop([&](std::size_t e) {
    const int b = body_at(pattern_.columns[e]);
    const auto at = static_cast<std::size_t>(b);
    if (b < 0 || !alone_[at]) return false;
    if (body_at(pattern_.rows[e]) >= 0) return true;
    if (reader.begins(pattern_.rows[e], b))
      lines_[static_cast<std::size_t>(next_line_[at]++)] = {pattern_.rows[e] - 1, Vec6::Zero()};
    Line& own = lines_[static_cast<std::size_t>(next_line_[at] - 1)];
    own.gradient[pattern_.columns[e] - 1 - 6 * b] += values_[e].fixed;
    return true;
  });
}

// What is left of a body's rows when its motion is eliminated: - G B^-1 G^T.
void BodyEntries::leave_rows_of(std::size_t n) {
  blocks_[n] = blocks_[n].inverse().eval();
  for (int i = first_line_[n]; i < first_line_[n + 1]; ++i) {
    const Line& a = lines_[static_cast<std::size_t>(i)];
    const Vec6 moved = blocks_[n] * a.gradient;
    for (int j = first_line_[n]; j <= i; ++j) {
      const Line& b = lines_[static_cast<std::size_t>(j)];
      const double twice = a.row == b.row && i != j ? 2 : 1;
      add(std::max(a.row, b.row), std::min(a.row, b.row), {-twice * moved.dot(b.gradient), 0, 0});
    }
  }
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
  for (std::size_t n = 0; n < alone_.size(); ++n)
    if (alone_[n]) std::fill_n(place_.begin() + static_cast<std::ptrdiff_t>(6 * n), 6, -1);
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
