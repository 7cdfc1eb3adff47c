#include "app/plot/ribbon_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Whether the same band was drawn along another branch or sheet: past folds it may be that of several. States
// about which it is lie well within it, so that it need not be known better than its points tell.
bool is_drawn(const Plot& plot, const RibbonPoint& point, const BandExtent& extent) {
  constexpr double alike = 0.25;  // of the band's height
  constexpr double beyond = 0.02; // of a band's length: where bands meet is known to less
  if (!point.folds) return false;
  const double most = alike * (extent.high - extent.low);
  for (const PlotBand& band : plot.bands) {
    if (band.name != held) continue;
    const double past = beyond * std::abs(band.points.back()[0] - band.points.front()[0]);
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

// The same without what is drawn already, but for a point beside it.
void add_new(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  std::vector<bool> drawn;
  for (const RibbonPoint& point : points)
    drawn.push_back(is_drawn(plot, point, *find_extent(point, name)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (drawn[i]) continue;
    std::size_t end = i;
    while (end < points.size() && !drawn[end])
      ++end;
    const std::size_t from = i > 0 ? i - 1 : i, to = std::min(end + 1, points.size());
    add_part(plot, points.subspan(from, to - from), name);
    i = end;
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
