#include "app/plot/layout_heat.hpp"

#include "app/plot/colors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

constexpr std::size_t most_cells = 192; // a side

bool complete(const PlotHeat& heat) {
  return !heat.x.empty() && !heat.y.empty() && heat.values.size() == heat.x.size() * heat.y.size();
}

// The grid's points in groups small enough to be drawn, in pixels.
struct Strip {
  double from = 0, to = 0;
  std::size_t index = 0;
};

std::vector<Strip> strips_of(const std::vector<double>& grid, const PlotRuler& ruler, double low,
                             double high) {
  std::vector<Strip> strips;
  const std::size_t step = (grid.size() + most_cells - 1) / most_cells;
  for (std::size_t i = 0; i < grid.size(); i += step) {
    const std::size_t last = std::min(i + step, grid.size()) - 1;
    double from = ruler.pixel(cell_range(grid, i, ruler.logarithmic)[0]);
    double to = ruler.pixel(cell_range(grid, last, ruler.logarithmic)[1]);
    if (from > to) std::swap(from, to);
    from = std::max(from, low);
    to = std::min(to, high);
    if (to > from) strips.push_back({from, to, i + (last - i) / 2});
  }
  return strips;
}

std::optional<std::size_t> cell_of(const std::vector<double>& grid, double value, bool logarithmic) {
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const PlotRange range = cell_range(grid, i, logarithmic);
    if (value >= range[0] && value <= range[1]) return i;
  }
  return std::nullopt;
}

} // namespace

PlotRange heat_range(const PlotHeat& heat) {
  if (heat.range && (!heat.logarithmic || (*heat.range)[0] > 0))
    return drawable_range(*heat.range, heat.logarithmic);
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (double value : heat.values)
    if (std::isfinite(value) && (!heat.logarithmic || value > 0)) {
      lower = std::min(lower, value);
      upper = std::max(upper, value);
    }
  if (lower > upper) return heat.logarithmic ? PlotRange{0.1, 10} : PlotRange{0, 1};
  if (lower == upper && !heat.logarithmic) {
    const double half = lower == 0 ? 0.5 : std::abs(lower) / 10;
    return drawable_range({lower - half, upper + half}, false);
  }
  return drawable_range({lower, upper}, heat.logarithmic);
}

std::vector<PlotCell> heat_cells(const PlotHeat& heat, const PlotLayout& layout) {
  std::vector<PlotCell> cells;
  if (!complete(heat)) return cells;
  const PlotRange range = heat_range(heat);
  const PlotRuler part{range[0], range[1], 0, 1, heat.logarithmic};
  const auto columns = strips_of(heat.x, layout.x, layout.area.left, layout.area.right);
  for (const Strip& row : strips_of(heat.y, layout.y, layout.area.top, layout.area.bottom)) {
    bool joined = false; // the cell before reaches to this one
    for (const Strip& column : columns) {
      const double t = part.pixel(heat.values[row.index * heat.x.size() + column.index]);
      if (!std::isfinite(t)) {
        joined = false;
        continue;
      }
      // Of 256 colours, so that neighbours are often the same.
      const std::uint32_t color = heat_color(std::round(255 * std::clamp(t, 0., 1.)) / 255);
      if (joined && cells.back().color == color)
        cells.back().box.right = column.to;
      else
        cells.push_back({{column.from, row.from, column.to, row.to}, color});
      joined = true;
    }
  }
  return cells;
}

std::optional<std::array<std::size_t, 2>> heat_cell(const PlotHeat& heat, double x, double y,
                                                    bool x_logarithmic, bool y_logarithmic) {
  if (!complete(heat)) return std::nullopt;
  const auto i = cell_of(heat.x, x, x_logarithmic), j = cell_of(heat.y, y, y_logarithmic);
  if (!i || !j) return std::nullopt;
  return std::array{*i, *j};
}

} // namespace flyball
