#include "app/plot/branch_plot.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flyball {

Plot branch_plot(const Mechanism& m, const std::string& address, const ResponseDiagram& d,
                 std::size_t coordinate) {
  const CoordinateSolution& shown = d.branches.front().points.front().coordinates[coordinate];
  const std::string unit = parameter_unit(m, address);
  Plot plot;
  plot.title = m.name;
  plot.x.label = address;
  plot.x.unit = unit;
  plot.y.label = coordinate_label(shown);
  plot.y.unit = shown.angle ? "rad" : "m";
  for (const ResponseBranch& b : d.branches) {
    for (std::size_t i = 0; i < b.points.size();) {
      const bool stable = b.points[i].stable == true;
      PlotCurve curve;
      curve.line = stable ? PlotLine::solid : PlotLine::dashed;
      curve.color = stable ? 0 : 1;
      curve.name = stable ? "stable" : "not stable";
      for (; i < b.points.size() && (b.points[i].stable == true) == stable; ++i)
        curve.points.push_back({b.points[i].parameter, b.points[i].coordinates[coordinate].value});
      // Up to the point where the next part begins, so that no gap is left.
      if (i < b.points.size())
        curve.points.push_back({b.points[i].parameter, b.points[i].coordinates[coordinate].value});
      plot.curves.push_back(std::move(curve));
    }
  }
  for (const SpecialPoint& s : d.special) {
    std::string label(word(s.type));
    std::ranges::replace(label, '_', ' ');
    plot.marks.push_back({{s.at.parameter, s.at.coordinates[coordinate].value},
                          fmt::format("{} {:.5g}", label, s.at.parameter)});
  }
  return plot;
}

} // namespace flyball
