#include "engine/study/friction_ribbon.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/study/slow_change.hpp"

#include <algorithm>

namespace flyball {
namespace {

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

} // namespace

std::vector<RibbonPoint> friction_ribbon(const Mechanism& mechanism, const std::string& address,
                                         std::span<const RibbonPlace> places, const std::atomic<bool>* cancel,
                                         const std::function<void(std::size_t)>& progress) {
  std::vector<RibbonPoint> out;
  for (const RibbonPlace& place : places) {
    if (is_cancelled(cancel)) break;
    FrictionBandOptions options;
    options.start = place.start;
    options.through_folds = options.errors = false;
    options.cancel = cancel;
    RibbonPoint point{place.number, {}};
    FrictionBand band = find_friction_band(with_parameter(mechanism, address, place.number), options);
    if (band.found && band.whole) point.extents = std::move(band.extents);
    out.push_back(std::move(point));
    if (progress) progress(out.size());
  }
  add_slow_change(mechanism, address, places, cancel, out);
  return out;
}

std::vector<std::vector<RibbonPoint>>
friction_ribbons(const Mechanism& mechanism, const std::string& address, const ResponseDiagram& diagram,
                 const std::atomic<bool>* cancel,
                 const std::function<void(std::size_t, std::size_t)>& progress) {
  std::vector<std::vector<RibbonPoint>> out;
  for (const ResponseBranch& branch : diagram.branches) {
    std::vector<RibbonPlace> places;
    for (const ResponsePoint& point : branch.points)
      places.push_back({point.parameter, start_values(point.coordinates)});
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
    if (!extents.back() || !extents.back()->stands) return {};
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
