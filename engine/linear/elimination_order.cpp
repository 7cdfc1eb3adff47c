#include "engine/linear/elimination_order.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <vector>

namespace flyball {
namespace {

std::size_t node(int i) {
  return static_cast<std::size_t>(i);
}

// Unknowns by place.
std::vector<int> minimum_degree(int size, const std::vector<Eigen::Triplet<char>>& edges) {
  if (size == 0) return {};
  Eigen::SparseMatrix<char> graph(size, size);
  graph.setFromTriplets(edges.begin(), edges.end(), [](char a, char) { return a; });
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> unknown;
  Eigen::AMDOrdering<int>()(Eigen::SparseMatrix<char>(graph.selfadjointView<Eigen::Lower>()), unknown);
  return {unknown.indices().data(), unknown.indices().data() + size};
}

} // namespace

std::vector<int> elimination_order(const SparsePattern& pattern) {
  const int size = pattern.size, motions = pattern.motions;
  std::vector<std::vector<int>> tied(node(size - motions)); // motions, by multiplier
  std::vector<Eigen::Triplet<char>> edges;
  for (std::size_t e = 0; e < pattern.rows.size(); ++e) {
    const auto [j, i] = std::minmax(pattern.rows[e], pattern.columns[e]);
    if (i < motions)
      edges.emplace_back(i, j);
    else
      tied[node(i - motions)].push_back(j);
  }
  for (std::vector<int>& all : tied) {
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        edges.emplace_back(all[a], all[b]);
  }
  const std::vector<int> motion = minimum_degree(motions, edges);
  std::vector<int> place(node(motions));
  for (int p = 0; p < motions; ++p)
    place[node(motion[node(p)])] = p;

  std::vector<std::vector<int>> next(node(motions) + 1); // multipliers, by the place that they follow
  for (int u = motions; u < size; ++u) {
    std::vector<int>& places = tied[node(u - motions)];
    for (int& m : places)
      m = place[node(m)];
    std::ranges::sort(places);
    int last = places.empty() ? motions - 1 : places.front();
    for (const int p : places)
      if (p == last + 1) ++last;
    next[node(last + 1)].push_back(u);
  }
  std::vector<int> order;
  order.reserve(node(size));
  for (int p = -1; p < motions; ++p) {
    if (p >= 0) order.push_back(motion[node(p)]);
    order.insert(order.end(), next[node(p + 1)].begin(), next[node(p + 1)].end());
  }
  return order;
}

} // namespace flyball
