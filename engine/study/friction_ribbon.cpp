#include "engine/study/friction_ribbon.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/study/slow_change.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace flyball {
namespace {

constexpr double line_error = 0.01;      // see friction_ribbon_at_bends()
constexpr std::size_t most_points = 200; // of it
constexpr double meeting_error = 1e-3;   // of the way between two places
constexpr double least_jump = 0.1;       // of a band's height
constexpr double height_of_rounding = 1e-9;
constexpr double persists =
    0.3; // of a jump, where the way between two points is halved: what is steep halves

// Lower ones first.
double edge(const RibbonPoint& point, std::size_t e) {
  const std::size_t n = point.extents.size();
  return e < n ? point.extents[e].low : point.extents[e - n].high;
}

// Of several joints with friction that move by themselves.
void add_slow_change(const Mechanism& mechanism, const std::string& address,
                     std::span<const RibbonPlace> places, const std::atomic<bool>* cancel,
                     std::vector<RibbonPoint>& points) {
  if (find_frictions(mechanism).size() < 2 || points.size() < 2 || points.size() < places.size()) return;
  for (const RibbonPoint& point : points)
    if (point.extents.size() != points.front().extents.size() || point.extents.empty() ||
        std::ranges::any_of(point.extents, &BandExtent::stands))
      return;
  std::vector<std::string> names;
  for (const BandExtent& extent : points.front().extents)
    names.push_back(extent.name);
  SlowChange slow = find_slow_change(mechanism, address, places, names, cancel);
  points.front().no_way = std::move(slow.message);
  for (const std::vector<HysteresisPoint>& way : slow.way)
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].slow.push_back(way[i]);
}

RibbonPoint ribbon_point(const Mechanism& mechanism, const std::string& address, const RibbonPlace& place,
                         const std::atomic<bool>* cancel) {
  FrictionBandOptions options;
  options.start = place.start;
  options.errors = false;
  options.cancel = cancel;
  RibbonPoint point{place.number, {}};
  FrictionBand band = find_friction_band(with_parameter(mechanism, address, place.number), options);
  const bool bounded = std::ranges::all_of(band.extents, [](const BandExtent& extent) {
    return std::isfinite(extent.low) && std::isfinite(extent.high);
  });
  if (!band.found || !bounded || (!band.whole && !band.folds)) return point;
  point.extents = std::move(band.extents);
  point.folds = band.folds;
  return point;
}

// Between the lowest and the highest of each edge, lower ones first; of the points that have a band.
std::vector<double> heights(const std::map<std::size_t, RibbonPoint>& points) {
  std::vector<double> least, most;
  for (const auto& [i, point] : points)
    for (std::size_t e = 0; e < 2 * point.extents.size(); ++e) {
      const double x = edge(point, e);
      if (e >= least.size()) {
        least.push_back(x);
        most.push_back(x);
      }
      least[e] = std::min(least[e], x);
      most[e] = std::max(most[e], x);
    }
  for (std::size_t e = 0; e < most.size(); ++e)
    most[e] -= least[e];
  return most;
}

// Whether a line past the middle one of three points leaves more than that of an edge out.
bool bends(const RibbonPoint& before, const RibbonPoint& point, const RibbonPoint& after,
           std::span<const double> heights) {
  const std::size_t edges = 2 * point.extents.size();
  if (before.extents.size() != point.extents.size() || after.extents.size() != point.extents.size())
    return true; // the band ends there
  const double part = (point.number - before.number) / (after.number - before.number);
  for (std::size_t e = 0; e < edges; ++e)
    if (std::abs(std::lerp(edge(before, e), edge(after, e), part) - edge(point, e)) > line_error * heights[e])
      return true;
  return false;
}

// How far each edge goes from one point to the next, lower ones first; none where no band passes a fold, past
// which alone another band may meet it.
std::vector<double> edge_steps(const RibbonPoint& a, const RibbonPoint& b) {
  std::vector<double> out;
  if ((!a.folds && !b.folds) || a.extents.size() != b.extents.size()) return out;
  for (std::size_t e = 0; e < 2 * a.extents.size(); ++e)
    out.push_back(std::abs(edge(b, e) - edge(a, e)));
  return out;
}

// The same of edges that may jump there, others zero: of bands with a height that is no rounding.
std::vector<double> edge_jumps(const RibbonPoint& a, const RibbonPoint& b) {
  std::vector<double> out = edge_steps(a, b);
  for (std::size_t e = 0; e < out.size(); ++e) {
    const std::size_t n = a.extents.size();
    const BandExtent &from = a.extents[e % n], &to = b.extents[e % n];
    const double height = std::min(from.high - from.low, to.high - to.low);
    const double size = std::max(std::abs(from.low), std::abs(from.high));
    if (!(height > height_of_rounding * size) || !(out[e] > least_jump * height)) out[e] = 0;
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

std::vector<RibbonPoint> friction_ribbon(const Mechanism& mechanism, const std::string& address,
                                         std::span<const RibbonPlace> places, const std::atomic<bool>* cancel,
                                         const std::function<void(std::size_t)>& progress) {
  std::vector<RibbonPoint> out;
  for (const RibbonPlace& place : places) {
    if (is_cancelled(cancel)) break;
    out.push_back(ribbon_point(mechanism, address, place, cancel));
    if (progress) progress(out.size());
  }
  add_slow_change(mechanism, address, places, cancel, out);
  return out;
}

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
      if (meet) {
        after.meets = true;
        out.push_back(std::move(before));
        out.push_back(std::move(after));
      }
    }
    out.push_back(std::move(points[i]));
  }
  points = std::move(out);
}

std::vector<RibbonPoint> friction_ribbon_at_bends(const Mechanism& mechanism, const std::string& address,
                                                  std::span<const RibbonPlace> places,
                                                  std::span<const std::size_t> first,
                                                  const std::atomic<bool>* cancel) {
  std::map<std::size_t, RibbonPoint> known; // by place
  std::set<std::size_t> wanted(first.begin(), first.end());
  while (!wanted.empty() && !is_cancelled(cancel)) {
    for (const std::size_t i : wanted) {
      if (is_cancelled(cancel)) break;
      known.emplace(i, ribbon_point(mechanism, address, places[i], cancel));
    }
    wanted.clear();
    const std::vector<double> scale = heights(known);
    if (known.size() < 3 || known.size() > most_points) break;
    for (auto at = std::next(known.begin()); std::next(at) != known.end(); ++at) {
      const auto before = std::prev(at), after = std::next(at);
      if (!bends(before->second, at->second, after->second, scale)) continue;
      for (const auto& [from, to] : {std::pair(before->first, at->first), std::pair(at->first, after->first)})
        if (to - from > 1) wanted.insert(from + (to - from) / 2);
    }
  }
  std::vector<RibbonPoint> out;
  std::vector<RibbonPlace> there;
  for (auto& [i, point] : known) {
    out.push_back(std::move(point));
    there.push_back(places[i]);
  }
  add_slow_change(mechanism, address, there, cancel, out);
  add_meetings(mechanism, address, there, out, cancel);
  return out;
}

std::vector<RibbonPlace> ribbon_places(const ResponseBranch& branch) {
  std::vector<RibbonPlace> places;
  for (const ResponsePoint& point : branch.points)
    places.push_back({point.parameter, start_values(point.coordinates)});
  return places;
}

std::vector<std::vector<RibbonPoint>>
friction_ribbons(const Mechanism& mechanism, const std::string& address, const ResponseDiagram& diagram,
                 const std::atomic<bool>* cancel,
                 const std::function<void(std::size_t, std::size_t)>& progress) {
  std::vector<std::vector<RibbonPoint>> out;
  for (const ResponseBranch& branch : diagram.branches) {
    const std::vector<RibbonPlace> places = ribbon_places(branch);
    if (!branch.points.empty() && !branch.points.front().frictions.empty()) { // it has no band
      out.emplace_back();
      for (const RibbonPlace& place : places)
        out.back().push_back({place.number, {}});
      continue;
    }
    out.push_back(friction_ribbon(mechanism, address, places, cancel, [&](std::size_t done) {
      if (progress) progress(done, places.size());
    }));
  }
  return out;
}

std::vector<HysteresisPoint> hysteresis(std::span<const RibbonPoint> points, std::string_view name) {
  std::vector<HysteresisPoint> slow;
  for (const RibbonPoint& point : points)
    if (const BandExtent* extent = find_extent(point, name); extent && !point.slow.empty())
      slow.push_back(point.slow[static_cast<std::size_t>(extent - point.extents.data())]);
  if (slow.size() == points.size()) return slow;
  std::vector<const BandExtent*> extents;
  for (std::size_t i = 0; i < points.size(); ++i) {
    extents.push_back(find_extent(points[i], name));
    if (!extents.back() || !extents.back()->stands || points[i].folds) return {};
    if (i > 1 && (points[i].number - points[i - 1].number) * (points[1].number - points[0].number) <= 0)
      return {};
  }
  std::vector<HysteresisPoint> out(extents.size());
  if (out.size() < 2) return {};
  double at = extents.front()->value;
  for (int round = 0; round < 2; ++round) { // the first one forgets where it began
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i].forth = at = std::clamp(at, extents[i]->low, extents[i]->high);
    for (std::size_t i = out.size(); i-- > 0;)
      out[i].back = at = std::clamp(at, extents[i]->low, extents[i]->high);
  }
  return out;
}

const BandExtent* find_extent(const RibbonPoint& point, std::string_view name) {
  const auto found = std::ranges::find(point.extents, name, &BandExtent::name);
  return found == point.extents.end() ? nullptr : &*found;
}

} // namespace flyball
