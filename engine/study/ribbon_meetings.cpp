#include "engine/study/ribbon_meetings.hpp"

#include "engine/linear/interruption.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flyball {
namespace {

constexpr double meeting_error = 1e-3; // of the way between two places
constexpr double least_jump = 0.1;     // of a band's height
constexpr double height_of_rounding = 1e-9;
constexpr double persists =
    0.3; // of a jump, where the way between two points is halved: what is steep halves

// How far each edge goes from one point to the next, lower ones first; none where no band passes a fold, past
// which alone another band may meet it.
std::vector<double> edge_steps(const RibbonPoint& a, const RibbonPoint& b) {
  std::vector<double> out;
  if ((!a.folds && !b.folds) || a.extents.size() != b.extents.size()) return out;
  for (std::size_t e = 0; e < 2 * a.extents.size(); ++e)
    out.push_back(std::abs(ribbon_edge(b, e) - ribbon_edge(a, e)));
  return out;
}

// The same of edges that may jump there, others zero: of bounded bands with a height that is no rounding.
std::vector<double> edge_jumps(const RibbonPoint& a, const RibbonPoint& b) {
  std::vector<double> out = edge_steps(a, b);
  for (std::size_t e = 0; e < out.size(); ++e) {
    const std::size_t n = a.extents.size();
    const BandExtent &from = a.extents[e % n], &to = b.extents[e % n];
    const double height = std::min(from.high - from.low, to.high - to.low);
    const double size = std::max(std::abs(from.low), std::abs(from.high));
    if (!std::isfinite(out[e]) || !(height > height_of_rounding * size) || !(out[e] > least_jump * height))
      out[e] = 0;
  }
  return out;
}

// The largest step of those edges, in parts of what they are at first.
double largest_part(const RibbonPoint& a, const RibbonPoint& b, std::span<const double> jumps) {
  const std::vector<double> steps = edge_steps(a, b);
  double most = 0;
  for (std::size_t e = 0; e < steps.size(); ++e)
    if (jumps[e] > 0) most = std::max(most, steps[e] / jumps[e]);
  return most;
}

} // namespace

void add_meetings(const Mechanism& mechanism, const std::string& address, std::span<const RibbonPlace> places,
                  std::vector<RibbonPoint>& points, const std::atomic<bool>* cancel) {
  std::vector<RibbonPoint> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && out.back().number != points[i].number) {
      RibbonPoint before = out.back(), after = points[i];
      const double close = meeting_error * std::abs(after.number - before.number);
      const std::vector<double> jumps = edge_jumps(before, after);
      bool meet = std::ranges::any_of(jumps, [](double jump) { return jump > 0; });
      while (meet && std::abs(after.number - before.number) > close && !is_cancelled(cancel)) {
        const double middle = std::midpoint(before.number, after.number);
        RibbonPoint there = ribbon_point(mechanism, address, {middle, places[i].start}, cancel);
        if (there.extents.empty()) break; // as it may be just where they touch
        const double first = largest_part(before, there, jumps), second = largest_part(there, after, jumps);
        meet = std::max(first, second) > persists;
        (first > second ? after : before) = std::move(there);
      }
      if (meet && !is_cancelled(cancel)) {
        after.meets = true;
        out.push_back(std::move(before));
        out.push_back(std::move(after));
      }
    }
    out.push_back(std::move(points[i]));
  }
  points = std::move(out);
}

} // namespace flyball
