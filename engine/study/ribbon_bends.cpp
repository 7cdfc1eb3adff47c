#include "engine/study/ribbon_bends.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/study/ribbon_meetings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace flyball {
namespace {

using KnownPoints = std::map<std::size_t, RibbonPoint>; // by place

constexpr double line_error = 0.01; // of an edge's height
constexpr double least_height = 1e-9;
constexpr std::size_t most_points = 200;

// Where the number turns back, with both ends.
std::vector<std::size_t> ends_of_sheets(std::span<const RibbonPlace> places) {
  std::vector<std::size_t> out{0};
  for (std::size_t i = 1; i + 1 < places.size(); ++i)
    if ((places[i].number - places[i - 1].number) * (places[i + 1].number - places[i].number) < 0)
      out.push_back(i);
  out.push_back(places.size() - 1);
  return out;
}

// Between the lowest and the highest of each edge over points of one sheet, lower ones first; no less than
// rounding.
std::vector<double> heights(KnownPoints::const_iterator first, KnownPoints::const_iterator last) {
  std::vector<double> least, most;
  for (auto at = first; at != std::next(last); ++at)
    for (std::size_t e = 0; e < 2 * at->second.extents.size(); ++e) {
      const double x = ribbon_edge(at->second, e);
      if (e >= least.size()) {
        least.push_back(std::numeric_limits<double>::infinity());
        most.push_back(-least.back());
      }
      if (!std::isfinite(x)) continue;
      least[e] = std::min(least[e], x);
      most[e] = std::max(most[e], x);
    }
  for (std::size_t e = 0; e < most.size(); ++e)
    most[e] = std::max(most[e] - least[e], least_height * std::max(std::abs(most[e]), std::abs(least[e])));
  return most;
}

// Whether a line past the middle one of three points leaves more than that of an edge out.
bool bends(const RibbonPoint& before, const RibbonPoint& point, const RibbonPoint& after,
           std::span<const double> heights) {
  const std::size_t edges = 2 * point.extents.size();
  if (before.extents.size() != point.extents.size() || after.extents.size() != point.extents.size())
    return true; // the band ends there
  const double part = (point.number - before.number) / (after.number - before.number);
  for (std::size_t e = 0; e < edges; ++e) {
    const double from = ribbon_edge(before, e), at = ribbon_edge(point, e), to = ribbon_edge(after, e);
    if (std::isfinite(from) != std::isfinite(at) || std::isfinite(at) != std::isfinite(to)) return true;
    if (std::isfinite(at) && std::abs(std::lerp(from, to, part) - at) > line_error * heights[e]) return true;
  }
  return false;
}

} // namespace

std::vector<RibbonPoint> friction_ribbon_at_bends(const Mechanism& mechanism, const std::string& address,
                                                  std::span<const RibbonPlace> places,
                                                  std::span<const std::size_t> first,
                                                  const std::atomic<bool>* cancel) {
  if (places.empty()) return {};
  KnownPoints known;
  const std::vector<std::size_t> sheets = ends_of_sheets(places);
  std::set<std::size_t> wanted(first.begin(), first.end());
  wanted.insert(sheets.begin(), sheets.end());
  for (std::size_t s = 1; s < sheets.size(); ++s) // of two points nothing bends
    wanted.insert(std::midpoint(sheets[s - 1], sheets[s]));
  while (!wanted.empty()) {
    for (const std::size_t i : wanted) {
      if (is_cancelled(cancel)) break;
      known.emplace(i, ribbon_point(mechanism, address, places[i], cancel));
    }
    wanted.clear();
    if (is_cancelled(cancel) || known.size() > most_points) break;
    for (std::size_t s = 1; s < sheets.size(); ++s) {
      const auto begin = known.find(sheets[s - 1]), end = known.find(sheets[s]);
      const std::vector<double> scale = heights(begin, end);
      for (auto before = begin; before != end && std::next(before) != end; ++before) {
        const auto at = std::next(before), after = std::next(at);
        if (!bends(before->second, at->second, after->second, scale)) continue;
        for (const auto& [from, to] :
             {std::pair(before->first, at->first), std::pair(at->first, after->first)})
          if (to - from > 1) wanted.insert(from + (to - from) / 2);
      }
    }
  }
  std::vector<RibbonPoint> out;
  std::vector<RibbonPlace> there;
  for (auto& [i, point] : known) {
    out.push_back(std::move(point));
    there.push_back(places[i]);
  }
  add_slow_change(mechanism, address, there, out, cancel);
  add_meetings(mechanism, address, there, out, cancel);
  return out;
}

} // namespace flyball
