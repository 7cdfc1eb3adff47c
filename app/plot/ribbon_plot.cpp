#include "app/plot/ribbon_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace flyball {
namespace {

constexpr const char* held = "held by friction";
constexpr double nothing = std::numeric_limits<double>::quiet_NaN(); // breaks a line

void add_way(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  const std::vector<HysteresisPoint> way = hysteresis(points, name);
  if (way.empty()) return;
  PlotCurve curve{.name = "slow rise and fall",
                  .points = {},
                  .line = PlotLine::dashed,
                  .color = plot_color::sky_blue,
                  .width = 1.4};
  for (std::size_t i = 0; i < way.size(); ++i)
    curve.points.push_back({points[i].number, way[i].forth});
  for (std::size_t i = way.size(); i-- > 0;)
    curve.points.push_back({points[i].number, way[i].back});
  curve.points.push_back({points[0].number, way[0].forth});
  plot.curves.push_back(std::move(curve));
}

// Whether the same band was drawn along another branch or sheet. Past folds it may be that of several, and
// states about which it is lie well within it, so that it need not be known better than its points tell.
// `past`: how far beyond what is drawn the number may be.
bool is_drawn(const Plot& plot, const RibbonPoint& point, const BandExtent& extent, double past = 0) {
  const double alike = point.folds ? 0.25 : 0.02; // of the band's height
  const double most = alike * (extent.high - extent.low);
  if (!std::isfinite(most)) return false;
  for (const PlotBand& band : plot.bands) {
    if (band.name != held) continue;
    for (std::size_t i = 1; i < band.points.size(); ++i) {
      const auto& [from, low_from, high_from] = band.points[i - 1];
      const auto& [to, low_to, high_to] = band.points[i];
      if (from == to || std::min(from, to) - past > point.number || std::max(from, to) + past < point.number)
        continue;
      const double part = std::clamp((point.number - from) / (to - from), 0., 1.);
      if (std::abs(std::lerp(low_from, low_to, part) - extent.low) <= most &&
          std::abs(std::lerp(high_from, high_to, part) - extent.high) <= most)
        return true;
    }
  }
  return false;
}

// What a slow change follows of an edge; broken where it would run away.
void add_edge(Plot& plot, std::span<const RibbonPoint> points, std::string_view name, bool rising) {
  PlotCurve curve{.name = rising ? "edge as it rises" : "edge as it falls",
                  .points = {},
                  .color = rising ? plot_color::green : plot_color::orange,
                  .width = 1.4};
  bool any = false;
  for (const RibbonPoint& point : points) {
    const BandExtent& extent = *find_extent(point, name);
    const bool followed = (rising ? extent.stable_low : extent.stable_high) != false;
    curve.points.push_back({point.number, !followed ? nothing : rising ? extent.low : extent.high});
    any = any || followed;
  }
  if (any) plot.curves.push_back(std::move(curve));
}

// Of points at which there is a band, and along which the number goes one way.
void add_part(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  if (points.size() < 2) return;
  PlotBand band{held, {}, plot_color::green};
  for (const RibbonPoint& point : points) {
    const BandExtent& extent = *find_extent(point, name);
    band.points.push_back({point.number, extent.low, extent.high});
  }
  plot.bands.push_back(std::move(band));
  add_edge(plot, points, name, true);
  add_edge(plot, points, name, false);
  for (const auto& [begin, end] : slow_stretches(points))
    add_way(plot, points.subspan(begin, end - begin), name);
}

// A part of the way between two points of a ribbon, as lines between them go.
RibbonPoint point_between(const RibbonPoint& a, const RibbonPoint& b, double part) {
  RibbonPoint out = a;
  out.number = std::lerp(a.number, b.number, part);
  for (BandExtent& extent : out.extents)
    if (const BandExtent* to = find_extent(b, extent.name)) {
      extent.low = std::lerp(extent.low, to->low, part);
      extent.high = std::lerp(extent.high, to->high, part);
    }
  return out;
}

// On the way from a point that is drawn already to one that is not the first that is not.
RibbonPoint first_new(const Plot& plot, const RibbonPoint& drawn, const RibbonPoint& other,
                      std::string_view name) {
  constexpr double close = 1e-4; // of the way
  double before = 0, after = 1;
  if (!is_drawn(plot, drawn, *find_extent(drawn, name))) return drawn; // but for where it ends
  while (after - before > close) {
    const double middle = std::midpoint(before, after);
    const RibbonPoint point = point_between(drawn, other, middle);
    (is_drawn(plot, point, *find_extent(point, name)) ? before : after) = middle;
  }
  return point_between(drawn, other, after);
}

// The same without what is drawn already.
void add_new(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  constexpr double close = 0.05; // of a step, where bands meet is known to less
  double step = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    step = std::max(step, std::abs(points[i].number - points[i - 1].number));
  std::vector<bool> drawn;
  for (const RibbonPoint& point : points)
    drawn.push_back(is_drawn(plot, point, *find_extent(point, name), close * step));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (drawn[i]) continue;
    std::vector<RibbonPoint> part;
    if (i > 0) part.push_back(first_new(plot, points[i - 1], points[i], name));
    for (; i < points.size() && !drawn[i]; ++i)
      part.push_back(points[i]);
    if (i < points.size()) part.push_back(first_new(plot, points[i], points[i - 1], name));
    add_part(plot, part, name);
  }
}

} // namespace

void add_ribbon(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  std::size_t begin = 0;
  double direction = 0; // in which the number goes
  const auto end_at = [&](std::size_t end, std::size_t next) {
    add_new(plot, points.subspan(begin, end - begin), name);
    begin = next;
    direction = 0;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double step = i > begin ? points[i].number - points[i - 1].number : 0;
    if (!find_extent(points[i], name))
      end_at(i, i + 1);
    else if (step * direction < 0) // beyond a fold, which a thin band goes round
      end_at(i, points[i - 1].folds ? i - 1 : i);
    else if (i > begin && points[i].meets)
      end_at(i, i);
    if (step != 0) direction = step;
  }
  end_at(points.size(), points.size());
}

} // namespace flyball
