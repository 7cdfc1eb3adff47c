#include "app/plot/ribbon_plot.hpp"

namespace flyball {
namespace {

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

} // namespace

void add_ribbon(Plot& plot, std::span<const RibbonPoint> points, std::string_view name) {
  std::size_t begin = 0;
  const auto add = [&](std::size_t end) {
    if (end - begin < 2) return;
    PlotBand band{"held by friction", {}, plot_color::green};
    PlotCurve rising{.name = "edge as it rises", .points = {}, .color = plot_color::green, .width = 1.4},
        falling{.name = "edge as it falls", .points = {}, .color = plot_color::orange, .width = 1.4};
    for (std::size_t i = begin; i < end; ++i) {
      const BandExtent& extent = *find_extent(points[i], name);
      band.points.push_back({points[i].number, extent.low, extent.high});
      rising.points.push_back({points[i].number, extent.low});
      falling.points.push_back({points[i].number, extent.high});
    }
    plot.bands.push_back(std::move(band));
    plot.curves.push_back(std::move(rising));
    plot.curves.push_back(std::move(falling));
    add_way(plot, points.subspan(begin, end - begin), name);
  };
  double direction = 0; // in which the number goes
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double step = i > begin ? points[i].number - points[i - 1].number : 0;
    if (!find_extent(points[i], name)) {
      add(i);
      begin = i + 1;
      direction = 0;
    } else if (step * direction < 0) { // beyond a fold
      add(i);
      begin = i;
      direction = 0;
    } else if (step != 0) {
      direction = step;
    }
  }
  add(points.size());
}

} // namespace flyball
