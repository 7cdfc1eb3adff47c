#include "app/plot/ribbon_plot.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

constexpr const char* held = "held by friction";

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

// Whether the same band was drawn along another branch: past folds it may be that of several.
bool is_drawn(const Plot& plot, double number, const BandExtent& extent) {
  constexpr double alike = 0.02; // of the band's height
  const double most = alike * (extent.high - extent.low);
  for (const PlotBand& band : plot.bands) {
    if (band.name != held) continue;
    for (std::size_t i = 1; i < band.points.size(); ++i) {
      const auto& [from, low_from, high_from] = band.points[i - 1];
      const auto& [to, low_to, high_to] = band.points[i];
      if (std::min(from, to) > number || std::max(from, to) < number || from == to) continue;
      const double part = (number - from) / (to - from);
      if (std::abs(std::lerp(low_from, low_to, part) - extent.low) <= most &&
          std::abs(std::lerp(high_from, high_to, part) - extent.high) <= most)
        return true;
    }
  }
  return false;
}

// Of points at which there is a band, and along which the number goes one way.
void add_part(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  if (points.size() < 2) return;
  PlotBand band{held, {}, plot_color::green};
  PlotCurve rising{.name = "edge as it rises", .points = {}, .color = plot_color::green, .width = 1.4},
      falling{.name = "edge as it falls", .points = {}, .color = plot_color::orange, .width = 1.4};
  for (const RibbonPoint& point : points) {
    const BandExtent& extent = *find_extent(point, name);
    band.points.push_back({point.number, extent.low, extent.high});
    rising.points.push_back({point.number, extent.low});
    falling.points.push_back({point.number, extent.high});
  }
  plot.bands.push_back(std::move(band));
  plot.curves.push_back(std::move(rising));
  plot.curves.push_back(std::move(falling));
  std::size_t from = 0; // no way is known through what passes folds
  for (std::size_t i = 0; i <= points.size(); ++i) {
    if (i < points.size() && !points[i].folds) continue;
    add_way(plot, points.subspan(from, i - from), name);
    from = i + 1;
  }
}

// The same without what is drawn already, but for a point beside it.
void add_new(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  std::vector<bool> drawn;
  for (const RibbonPoint& point : points)
    drawn.push_back(is_drawn(plot, point.number, *find_extent(point, name)));
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
    else if (step * direction < 0) // beyond a fold
      end_at(i, i - 1);
    else if (i > begin && points[i].meets)
      end_at(i, i);
    if (step != 0) direction = step;
  }
  end_at(points.size(), points.size());
}

} // namespace flyball
