#include "engine/study/friction_ribbon.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/study/slow_change.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

bool is_followed(const RibbonPoint& point) {
  return !point.extents.empty() && !point.folds &&
         std::ranges::all_of(point.extents, [](const BandExtent& extent) {
           return extent.stable_low != false && extent.stable_high != false;
         });
}

// What several joints with friction that move by themselves do along one stretch.
void add_slow_change(const Mechanism& mechanism, const std::string& address,
                     std::span<const RibbonPlace> places, const std::atomic<bool>* cancel,
                     std::span<RibbonPoint> points) {
  for (const RibbonPoint& point : points)
    if (point.extents.size() != points.front().extents.size() ||
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

} // namespace

RibbonPoint ribbon_point(const Mechanism& mechanism, const std::string& address, const RibbonPlace& place,
                         const std::atomic<bool>* cancel) {
  FrictionBandOptions options;
  options.start = place.start;
  options.errors = options.past_folds = false;
  options.cancel = cancel;
  RibbonPoint point{place.number, {}};
  FrictionBand band = find_friction_band(with_parameter(mechanism, address, place.number), options);
  point.message = std::move(band.message);
  if (!band.found) return point;
  point.extents = std::move(band.extents);
  point.folds = band.folds;
  return point;
}

std::vector<RibbonPoint> friction_ribbon(const Mechanism& mechanism, const std::string& address,
                                         std::span<const RibbonPlace> places, const std::atomic<bool>* cancel,
                                         const std::function<void(std::size_t)>& progress) {
  std::vector<RibbonPoint> out;
  for (const RibbonPlace& place : places) {
    if (is_cancelled(cancel)) break;
    out.push_back(ribbon_point(mechanism, address, place, cancel));
    if (progress) progress(out.size());
  }
  add_slow_change(mechanism, address, places, out, cancel);
  return out;
}

void add_slow_change(const Mechanism& mechanism, const std::string& address,
                     std::span<const RibbonPlace> places, std::vector<RibbonPoint>& points,
                     const std::atomic<bool>* cancel) {
  if (find_frictions(mechanism).size() < 2) return;
  for (const auto& [begin, end] : slow_stretches(points))
    add_slow_change(mechanism, address, places.subspan(begin, end - begin), cancel,
                    std::span(points).subspan(begin, end - begin));
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

std::vector<RibbonStretch> slow_stretches(std::span<const RibbonPoint> points) {
  std::vector<RibbonStretch> out;
  std::size_t begin = 0;
  const auto step = [&](std::size_t i) { return points[i].number - points[i - 1].number; };
  const auto end_at = [&](std::size_t end) {
    if (end > begin + 1) out.push_back({begin, end});
    begin = end;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool turns = i > begin && (step(i) == 0 || (i > begin + 1 && step(i) * step(i - 1) < 0));
    if (turns || points[i].meets || !is_followed(points[i])) end_at(i);
    if (!is_followed(points[i])) begin = i + 1;
  }
  end_at(points.size());
  return out;
}

std::vector<HysteresisPoint> hysteresis(std::span<const RibbonPoint> points, std::string_view name) {
  const std::vector<RibbonStretch> stretches = slow_stretches(points);
  if (stretches.size() != 1 || stretches[0].end - stretches[0].begin != points.size()) return {};
  std::vector<HysteresisPoint> slow;
  std::vector<const BandExtent*> extents;
  for (const RibbonPoint& point : points) {
    const BandExtent* extent = find_extent(point, name);
    if (!extent) return {};
    if (!point.slow.empty())
      slow.push_back(point.slow[static_cast<std::size_t>(extent - point.extents.data())]);
    extents.push_back(extent);
  }
  if (slow.size() == points.size()) return slow;
  if (!std::ranges::all_of(extents, [](const BandExtent* extent) { return extent->stands; })) return {};
  std::vector<HysteresisPoint> out(extents.size());
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

double ribbon_edge(const RibbonPoint& point, std::size_t e) {
  const std::size_t n = point.extents.size();
  return e < n ? point.extents[e].low : point.extents[e - n].high;
}

} // namespace flyball
