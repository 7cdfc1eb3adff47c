#include "app/plot/axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

constexpr double largest = 1e300, smallest = 1e-300;
constexpr double narrowest = 1e-11; // of the larger end: labels need digits, and doubles have 16

struct Extent {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  bool logarithmic = false;
  void add(double value) {
    if (!std::isfinite(value) || (logarithmic && value <= 0)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  bool empty() const { return lower > upper; }
};

Extent shown_extent(const Plot& plot, const PlotLook& look, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  Extent extent;
  extent.logarithmic = is_logarithmic(plot, look, axis);
  for (const PlotCurve& curve : plot.curves)
    if (is_shown(curve, look))
      for (const auto& p : curve.points)
        // A point that the other axis cannot show takes no room on this one.
        if (std::isfinite(p[1 - k])) extent.add(p[k]);
  for (const PlotBand& band : plot.bands)
    if (is_shown(band, look))
      for (const auto& [x, lower, upper] : band.points) {
        if (!std::isfinite(x) || !std::isfinite(lower) || !std::isfinite(upper)) continue;
        extent.add(axis == 0 ? x : lower);
        extent.add(axis == 0 ? x : upper);
      }
  for (const PlotMark& mark : plot.marks)
    if (std::isfinite(mark.at[1 - k])) extent.add(mark.at[k]);
  for (const PlotReference& reference : plot.references)
    if (reference.axis == axis && is_shown(reference, look)) extent.add(reference.at);
  if (plot.marker) extent.add(axis == 0 ? plot.marker->x : plot.marker->y);
  return extent;
}

// A heat map reaches to the edges of its cells, and what is drawn over it does not make it smaller.
Extent heat_extent(const PlotHeat& heat, int axis, bool logarithmic) {
  const std::vector<double>& grid = axis == 0 ? heat.x : heat.y;
  Extent extent;
  extent.logarithmic = logarithmic;
  for (std::size_t i : {std::size_t{0}, grid.size() - 1})
    if (i < grid.size())
      for (double end : cell_range(grid, i, logarithmic))
        extent.add(end);
  return extent;
}

} // namespace

PlotRange drawable_range(PlotRange range, bool logarithmic) {
  auto [lower, upper] = range;
  if (std::isnan(lower) || std::isnan(upper)) return logarithmic ? PlotRange{0.1, 10} : PlotRange{0, 1};
  if (lower > upper) std::swap(lower, upper);
  const double least = logarithmic ? smallest : -largest;
  lower = std::clamp(lower, least, largest);
  upper = std::clamp(upper, least, largest);
  const double width = std::max(narrowest * std::max(std::abs(lower), std::abs(upper)), smallest);
  if (upper - lower >= width) return {lower, upper};
  const double middle = lower + (upper - lower) / 2;
  if (logarithmic) return {middle * (1 - narrowest), middle * (1 + narrowest)};
  return {middle - width / 2, middle + width / 2};
}

PlotRange axis_range(const Plot& plot, const PlotLook& look, int axis) {
  const bool logarithmic = is_logarithmic(plot, look, axis);
  const PlotAxis& own = axis_of(plot, axis);
  for (const std::optional<PlotRange>& fixed : {look.range[static_cast<std::size_t>(axis)], own.range})
    if (fixed && (!logarithmic || ((*fixed)[0] > 0 && (*fixed)[1] > 0)))
      return drawable_range(*fixed, logarithmic);
  Extent extent = shown_extent(plot, look, axis);
  if (plot.heat) {
    const Extent heat = heat_extent(*plot.heat, axis, logarithmic);
    if (!heat.empty()) return drawable_range({heat.lower, heat.upper}, logarithmic);
  }
  if (extent.empty()) return logarithmic ? PlotRange{0.1, 10} : PlotRange{0, 1};
  const double lower = std::clamp(extent.lower, -largest, largest),
               upper = std::clamp(extent.upper, -largest, largest);
  if (logarithmic) {
    const double decades = std::log10(upper / std::max(lower, smallest));
    const double grown = decades > 1e-6 ? std::pow(10., own.room * decades) : 2;
    return drawable_range({lower / grown, upper * grown}, true);
  }
  // A curve that is flat but for rounding is drawn flat.
  const double size = std::max(std::abs(lower), std::abs(upper));
  const bool flat = upper - lower <= std::max(1e-9 * size, own.noise);
  const double room = !flat ? own.room * (upper - lower) : size > own.noise ? size / 10 : 0.1;
  return drawable_range({lower - room, upper + room}, false);
}

PlotRange cell_range(const std::vector<double>& grid, std::size_t i, bool logarithmic) {
  const auto between = [&](double a, double b) {
    return logarithmic && a > 0 && b > 0 ? std::sqrt(a) * std::sqrt(b) : a + (b - a) / 2;
  };
  // Beyond the first and last the cells are as wide as inwards.
  const auto beyond = [&](double end, double inner) {
    const double edge = between(end, inner);
    return logarithmic && end > 0 && edge > 0 ? end / edge * end : end + (end - edge);
  };
  const std::size_t last = grid.size() - 1;
  if (last == 0) {
    const double half = grid[0] == 0 ? 0.5 : std::abs(grid[0]) / 2;
    return {grid[0] - half, grid[0] + half};
  }
  return {i == 0 ? beyond(grid[0], grid[1]) : between(grid[i - 1], grid[i]),
          i == last ? beyond(grid[last], grid[last - 1]) : between(grid[i], grid[i + 1])};
}

double PlotRuler::pixel(double value) const {
  const double part = logarithmic ? value > 0 ? std::log(value / lower) / std::log(upper / lower)
                                              : std::numeric_limits<double>::quiet_NaN()
                                  : (value - lower) / (upper - lower);
  return from + part * (to - from);
}

double PlotRuler::value(double pixel) const {
  const double part = (pixel - from) / (to - from);
  return logarithmic ? lower * std::pow(upper / lower, part) : lower + part * (upper - lower);
}

PlotRange PlotRuler::range_between(double from_pixel, double to_pixel) const {
  return drawable_range({value(from_pixel), value(to_pixel)}, logarithmic);
}

} // namespace flyball
