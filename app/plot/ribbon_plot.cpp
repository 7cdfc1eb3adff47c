#include "app/plot/ribbon_plot.hpp"

namespace flyball {

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
