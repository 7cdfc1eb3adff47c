#include "app/plot/friction_curve.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

bool slips_on_friction(const ResponsePoint& point) {
  return std::ranges::any_of(point.frictions, &FrictionForce::slips);
}

PlotCurve friction_curve(bool slips, std::optional<bool> stable) {
  PlotCurve curve{.name = slips ? "slips on friction" : "held as drawn", .points = {}, .width = 2.4};
  curve.color = slips ? plot_color::purple : plot_color::green;
  if (stable == true) return curve;
  curve.name += stable ? ", unstable" : ", undecided";
  curve.line = stable ? PlotLine::dashed : PlotLine::dotted;
  return curve;
}

std::string friction_note(const ResponsePoint& point) {
  std::string out;
  for (const FrictionForce& force : point.frictions) {
    out += (out.empty() ? "" : ", ") + coordinate_label(force);
    const std::string unit = force.angle ? " N m" : " N";
    if (force.slips)
      out += " slips against " + rounded_text(force.limit, 4) + unit;
    else if (force.value)
      out += " is held by " + rounded_text(std::abs(*force.value), 2) + " of " +
             rounded_text(force.limit, 4) + unit;
    else
      out += " is held";
  }
  return out;
}

} // namespace flyball
