#include "app/ui/plots/shown_plot.hpp"

namespace flyball {

namespace {

// `unit` may be the scale's own.
template <class Scale>
void name_unit(Scale& scale, const std::string& unit, const ShownUnit& shown) {
  scale.si_unit = unit;
  scale.unit = shown.text;
  scale.factor = shown.factor;
  if (scale.range)
    for (double& end : *scale.range)
      end *= shown.factor;
}

} // namespace

void show_axis(Plot& plot, int axis, const std::string& unit, const DisplayUnits& units) {
  const ShownUnit shown = shown_unit(unit, units);
  const auto k = static_cast<std::size_t>(axis);
  name_unit(axis == 0 ? plot.x : plot.y, unit, shown);
  if (shown.factor == 1) return;
  for (PlotCurve& curve : plot.curves)
    for (auto& point : curve.points)
      point[k] *= shown.factor;
  for (PlotBand& band : plot.bands)
    for (auto& [x, lower, upper] : band.points) {
      (axis == 0 ? x : lower) *= shown.factor;
      if (axis == 1) upper *= shown.factor;
    }
  for (PlotReference& reference : plot.references)
    if (reference.axis == axis) reference.at *= shown.factor;
  for (PlotMark& mark : plot.marks)
    mark.at[k] *= shown.factor;
  if (!plot.heat) return;
  for (double& value : axis == 0 ? plot.heat->x : plot.heat->y)
    value *= shown.factor;
}

void show_heat(PlotHeat& heat, const std::string& unit, const DisplayUnits& units) {
  const ShownUnit shown = shown_unit(unit, units);
  name_unit(heat, unit, shown);
  for (double& value : heat.values)
    value *= shown.factor;
}

} // namespace flyball
