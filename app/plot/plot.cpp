#include "app/plot/plot.hpp"

namespace flyball {

const PlotAxis& axis_of(const Plot& plot, int axis) {
  return axis == 0 ? plot.x : plot.y;
}

std::string axis_text(const std::string& label, const std::string& unit) {
  return unit.empty() ? label : label.empty() ? "[" + unit + "]" : label + " [" + unit + "]";
}

bool is_logarithmic(const Plot& plot, const PlotLook& look, int axis) {
  return look.logarithmic[static_cast<std::size_t>(axis)].value_or(axis_of(plot, axis).logarithmic);
}

bool is_shown(const PlotCurve& curve, const PlotLook& look) {
  return !curve.hidden && !look.hidden.contains(curve.name);
}

bool is_shown(const PlotBand& band, const PlotLook& look) {
  return !look.hidden.contains(band.name);
}

bool is_shown(const PlotReference& reference, const PlotLook& look) {
  return !reference.in_legend || !look.hidden.contains(reference.label);
}

double rim_of(const Plot& plot, const PlotCurve& curve) {
  constexpr double line = 1, hatched = 0.7; // points
  return !plot.heat ? 0 : curve.hatching ? hatched : line;
}

} // namespace flyball
