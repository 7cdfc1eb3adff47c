#include "engine/equilibrium/halves.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace flyball {
namespace {

class Graph {
 public:
  explicit Graph(const SparsePattern& pattern) : first_(static_cast<std::size_t>(pattern.size) + 1, 0) {
    const auto for_edges = [&](const auto& work) {
      for (std::size_t e = 0; e < pattern.rows.size(); ++e)
        if (pattern.rows[e] != pattern.columns[e]) work(pattern.rows[e] - 1, pattern.columns[e] - 1);
    };
    for_edges([&](int i, int j) {
      ++first_[static_cast<std::size_t>(i) + 1];
      ++first_[static_cast<std::size_t>(j) + 1];
    });
    for (std::size_t u = 1; u < first_.size(); ++u)
      first_[u] += first_[u - 1];
    met_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_edges([&](int i, int j) {
      met_[next[static_cast<std::size_t>(i)]++] = j;
      met_[next[static_cast<std::size_t>(j)]++] = i;
    });
  }

  std::size_t size() const { return first_.size() - 1; }

  std::span<const int> met_by(int u) const {
    const auto at = static_cast<std::size_t>(u);
    return {met_.data() + first_[at], met_.data() + first_[at + 1]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<int> met_;
};

// Unknowns by their distance from one of them. Those that it does not reach follow, as further levels.
struct Levels {
  std::vector<int> level, order, count;

  Levels(const Graph& graph, int start) : level(graph.size(), -1) {
    order.reserve(graph.size());
    reach(graph, start);
    for (int u = 0; order.size() < graph.size(); ++u)
      if (level[static_cast<std::size_t>(u)] < 0) reach(graph, u);
  }

 private:
  void reach(const Graph& graph, int start) {
    std::size_t head = order.size();
    add(start, static_cast<int>(count.size()));
    for (; head < order.size(); ++head)
      for (const int other : graph.met_by(order[head]))
        if (level[static_cast<std::size_t>(other)] < 0)
          add(other, level[static_cast<std::size_t>(order[head])] + 1);
  }

  void add(int u, int at) {
    level[static_cast<std::size_t>(u)] = at;
    order.push_back(u);
    if (count.size() == static_cast<std::size_t>(at)) count.push_back(0);
    ++count[static_cast<std::size_t>(at)];
  }
};

// Even halves, and few unknowns between them: those are factored as a full matrix.
int middle(const Levels& levels) {
  constexpr int price = 8; // of an unknown between, in unknowns of the larger half
  const int all = static_cast<int>(levels.order.size());
  int best = 0, least = std::numeric_limits<int>::max(), before = 0;
  for (std::size_t l = 0; l < levels.count.size(); ++l) {
    const int here = levels.count[l], cost = std::max(before, all - before - here) + price * here;
    if (cost < least) {
      least = cost;
      best = static_cast<int>(l);
    }
    before += here;
  }
  return best;
}

// Bodies whose neighbours are all between are moved by them alone, which may be more than they can follow.
void give_away_pieces(const Graph& graph, std::vector<Side>& side) {
  constexpr std::size_t few = 60; // unknowns, of some five bodies
  std::vector<bool> seen(side.size(), false);
  std::vector<int> piece;
  for (std::size_t start = 0; start < side.size(); ++start) {
    if (side[start] == Side::between || seen[start]) continue;
    piece = {static_cast<int>(start)};
    seen[start] = true;
    bool borders = false;
    for (std::size_t head = 0; head < piece.size(); ++head)
      for (const int other : graph.met_by(piece[head])) {
        const auto at = static_cast<std::size_t>(other);
        borders = borders || side[at] == Side::between;
        if (side[at] == Side::between || seen[at]) continue;
        seen[at] = true;
        piece.push_back(other);
      }
    if (borders && piece.size() <= few)
      for (const int u : piece)
        side[static_cast<std::size_t>(u)] = Side::between;
  }
}

} // namespace

std::vector<Side> halve(const SparsePattern& pattern) {
  if (pattern.size == 0) return {};
  const Graph graph(pattern);
  // From one end: the farthest from the farthest of any.
  int start = 0;
  for (int i = 0; i < 2; ++i)
    start = Levels(graph, start).order.back();
  const Levels levels(graph, start);
  const int between = middle(levels);
  std::vector<Side> side(graph.size());
  for (std::size_t u = 0; u < side.size(); ++u)
    side[u] = levels.level[u] < between   ? Side::first
              : levels.level[u] > between ? Side::second
                                          : Side::between;
  // One stays, should the halves have nothing to do with each other.
  int left = levels.count[static_cast<std::size_t>(between)];
  for (const int u : levels.order) {
    const auto second = [&](int other) { return side[static_cast<std::size_t>(other)] == Side::second; };
    Side& here = side[static_cast<std::size_t>(u)];
    if (here != Side::between || left == 1 || std::ranges::any_of(graph.met_by(u), second)) continue;
    here = Side::first;
    --left;
  }
  give_away_pieces(graph, side);
  return side;
}

} // namespace flyball
