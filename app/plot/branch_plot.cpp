#include "app/plot/branch_plot.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

Plot branch_plot(const Mechanism& m, const std::string& address, const ResponseDiagram& d,
                 const PlottedQuantity& shown) {
  const ResponsePoint& first = d.branches.front().points.front();
  Plot plot;
  plot.title = m.name;
  plot.x.label = address;
  plot.x.unit = parameter_unit(m, address);
  if (shown.measure) {
    plot.y.label = first.measures[shown.index].name;
    plot.y.unit = first.measures[shown.index].unit;
  } else {
    const CoordinateSolution& c = first.coordinates[shown.index];
    plot.y.label = plotted_name(first, shown);
    plot.y.unit = shown.speed ? (c.angle ? "rad/s" : "m/s") : c.angle ? "rad" : "m";
  }
  for (const ResponseBranch& b : d.branches) {
    for (std::size_t i = 0; i < b.points.size();) {
      const bool stable = b.points[i].stable == true;
      PlotCurve curve;
      curve.line = stable ? PlotLine::solid : PlotLine::dashed;
      curve.color = stable ? 0 : 1;
      curve.name = stable ? "stable" : "not stable";
      const auto add = [&](const ResponsePoint& point) {
        const double value = plotted_value(point, shown);
        if (std::isfinite(value)) curve.points.push_back({point.parameter, value});
        return std::isfinite(value);
      };
      bool defined = true;
      while (i < b.points.size() && (b.points[i].stable == true) == stable && defined)
        defined = add(b.points[i++]);
      // Up to the point where the next part begins, so that no gap is left.
      if (i < b.points.size() && defined) add(b.points[i]);
      if (!curve.points.empty()) plot.curves.push_back(std::move(curve));
    }
  }
  for (const SpecialPoint& s : d.special) {
    const double value = plotted_value(s.at, shown);
    if (!std::isfinite(value)) continue;
    std::string label(word(s.type));
    std::ranges::replace(label, '_', ' ');
    plot.marks.push_back({{s.at.parameter, value}, fmt::format("{} {:.5g}", label, s.at.parameter)});
  }
  return plot;
}

std::optional<PlottedQuantity> find_plotted(const Mechanism& m,
                                            const std::vector<CoordinateSolution>& coordinates,
                                            const std::string& name) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (const auto found = found_number(coordinates[i]); found && found->name == name)
      return PlottedQuantity{i, false, coordinates[i].speed.has_value()};
  const int measure = measure_index(m, name);
  if (measure < 0) return std::nullopt;
  return PlottedQuantity{static_cast<std::size_t>(measure), true};
}

std::string plotted_names(const Mechanism& m, const std::vector<CoordinateSolution>& coordinates) {
  std::string known;
  const auto add = [&](const std::string& name) { known += (known.empty() ? "" : ", ") + name; };
  for (const CoordinateSolution& c : coordinates)
    if (const auto found = found_number(c)) add(found->name);
  for (const NamedMeasure& measure : m.measures)
    add(measure.name);
  return known;
}

std::string plotted_name(const ResponsePoint& point, const PlottedQuantity& quantity) {
  if (quantity.measure) return point.measures[quantity.index].name;
  return coordinate_label(point.coordinates[quantity.index]) + (quantity.speed ? ".speed" : "");
}

double plotted_value(const ResponsePoint& point, const PlottedQuantity& quantity) {
  if (!quantity.measure) {
    const CoordinateSolution& c = point.coordinates[quantity.index];
    if (quantity.speed) return c.speed.value_or(0);
    return c.speed ? std::numeric_limits<double>::quiet_NaN() : c.value;
  }
  return point.measures[quantity.index].value.value_or(std::numeric_limits<double>::quiet_NaN());
}

} // namespace flyball
