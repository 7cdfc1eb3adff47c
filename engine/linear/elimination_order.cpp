#include "engine/linear/elimination_order.hpp"

#include "engine/linear/mumps.hpp"

#include <algorithm>

namespace flyball {

// Minimum fill would begin with the multipliers, which meet few. But these have nothing on the diagonal, are
// no pivots until something that they meet has been one, and to wait costs much. So they are left out of the
// graph, where what they tie meets instead, and each follows the first that it meets: a body, as a rule,
// whose motions come one after the other.
std::vector<int> elimination_order(const SparsePattern& pattern) {
  const auto count = static_cast<std::size_t>(pattern.size), entries = pattern.rows.size();
  const auto row = [&](std::size_t e) { return static_cast<std::size_t>(pattern.rows[e] - 1); };
  const auto column = [&](std::size_t e) { return static_cast<std::size_t>(pattern.columns[e] - 1); };
  std::vector<bool> held(count, false); // has something on the diagonal
  for (std::size_t e = 0; e < entries; ++e)
    if (row(e) == column(e)) held[row(e)] = true;
  std::vector<int> number(count, 0);
  SparsePattern graph;
  for (std::size_t u = 0; u < count; ++u)
    if (held[u]) number[u] = ++graph.size;
  if (graph.size == 0 || graph.size == pattern.size) return {};

  std::vector<std::vector<int>> met(count); // by multiplier
  for (std::size_t e = 0; e < entries; ++e) {
    const std::size_t i = row(e), j = column(e);
    if (held[i] && held[j]) {
      graph.rows.push_back(number[i]);
      graph.columns.push_back(number[j]);
    } else if (held[i] != held[j]) {
      met[held[i] ? j : i].push_back(number[held[i] ? i : j]);
    }
  }
  for (const std::vector<int>& all : met)
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        graph.rows.push_back(all[a]);
        graph.columns.push_back(all[b]);
      }
  Mumps order;
  order.open(graph);
  order.run(Mumps::analyse);
  if (order.failed()) return {};

  // Multipliers by the place that they follow.
  const auto place = [&](int n) { return order.data.sym_perm[n - 1]; };
  std::vector<std::vector<int>> next(static_cast<std::size_t>(graph.size) + 1);
  for (std::size_t u = 0; u < count; ++u) {
    if (held[u]) continue;
    std::vector<int>& all = met[u];
    std::ranges::sort(all, {}, place);
    int at = all.empty() ? graph.size : place(all[0]);
    for (int n : all)
      if (place(n) == at + 1) ++at;
    next[static_cast<std::size_t>(at)].push_back(static_cast<int>(u));
  }
  std::vector<std::size_t> unknown(static_cast<std::size_t>(graph.size) + 1);
  for (std::size_t u = 0; u < count; ++u)
    if (held[u]) unknown[static_cast<std::size_t>(place(number[u]))] = u;
  std::vector<int> out(count);
  int at = 0;
  for (std::size_t p = 0; p < unknown.size(); ++p) {
    if (p > 0) out[unknown[p]] = ++at;
    for (int u : next[p])
      out[static_cast<std::size_t>(u)] = ++at;
  }
  return out;
}

} // namespace flyball
