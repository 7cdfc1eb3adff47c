#include "app/plot/branch_plot.hpp"

#include "app/plot/friction_curve.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

// How a point looks, as a curve without points.
PlotCurve look_of(const ResponsePoint& point) {
  if (!point.frictions.empty()) return friction_curve(slips_on_friction(point), point.stable);
  if (!point.stable &&
      point.stability_reason == StabilityReason::neutral) // stable, but for where in its family
    return {.name = "neutral", .points = {}, .line = PlotLine::dotted, .color = plot_color::neutral};
  const bool stable = point.stable == true;
  return {.name = stable ? "stable" : "not stable",
          .points = {},
          .line = stable ? PlotLine::solid : PlotLine::dashed,
          .color = stable ? plot_color::blue : plot_color::vermillion};
}

} // namespace

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
      PlotCurve curve = look_of(b.points[i]);
      const auto add = [&](const ResponsePoint& point) {
        const double value = plotted_value(point, shown);
        if (std::isfinite(value)) curve.points.push_back({point.parameter, value});
        return std::isfinite(value);
      };
      bool defined = true;
      while (i < b.points.size() && look_of(b.points[i]).name == curve.name && defined)
        defined = add(b.points[i++]);
      // Up to the point where the next part begins, so that no gap is left.
      if (i < b.points.size() && defined) add(b.points[i]);
      if (!curve.points.empty()) plot.curves.push_back(std::move(curve));
    }
  }
  double largest = 0; // of the varied number, beside which rounding is zero
  for (const ResponseBranch& b : d.branches)
    for (const ResponsePoint& point : b.points)
      largest = std::max(largest, std::abs(point.parameter));
  for (const SpecialPoint& s : d.special) {
    const double value = plotted_value(s.at, shown);
    if (!std::isfinite(value)) continue;
    std::string label(word(s.type));
    std::ranges::replace(label, '_', ' ');
    const double at = std::abs(s.at.parameter) < 1e-12 * largest ? 0 : s.at.parameter;
    plot.marks.push_back({{s.at.parameter, value}, fmt::format("{} {:.5g}", label, at)});
  }
  return plot;
}

bool slips_somewhere(const ResponseDiagram& diagram, std::size_t coordinate) {
  return std::ranges::any_of(diagram.branches, [&](const ResponseBranch& branch) {
    return !branch.points.empty() && !branch.points.front().frictions.empty() &&
           branch.points.front().coordinates[coordinate].speed.has_value();
  });
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

std::optional<PlottedQuantity> find_plotted(const Mechanism& m, const ResponseDiagram& d,
                                            const std::string& name) {
  const std::vector<CoordinateSolution>& all = d.branches.front().points.front().coordinates;
  if (const auto found = find_plotted(m, all, name)) return found;
  for (std::size_t i = 0; i < all.size(); ++i) { // in the first state it does the other
    if (!slips_somewhere(d, i)) continue;
    for (const bool speed : {false, true})
      if (name == coordinate_label(all[i]) + (speed ? ".speed" : "")) return PlottedQuantity{i, false, speed};
  }
  return std::nullopt;
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
