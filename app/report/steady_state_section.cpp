#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

// Of a coordinate, or of its speed: nothing where rounding is all that there is of it.
Html everyday(double value, double error, double shown, std::string_view unit) {
  constexpr double rounding = 1e-15; // rad, m, rad/s, m/s
  return quantity(std::abs(value) <= std::max(error, rounding) ? 0 : value * shown, unit);
}

Html coordinates_table(const Solution& s) {
  HtmlTable table(
      {{"Coordinate", false}, {"Value"}, {"Estimated error"}, {"In everyday units"}, {"", false}});
  for (const CoordinateSolution& c : s.coordinates) {
    const std::string label = coordinate_label(c);
    if (c.speed) {
      const std::string_view unit = c.angle ? "rad/s" : "m/s";
      const double shown = c.angle ? 30 / std::numbers::pi : 1000;
      table.row({"speed of " + label, quantity_within(*c.speed, c.speed_error, unit),
                 magnitude(c.speed_error, unit),
                 everyday(*c.speed, c.speed_error, shown, c.angle ? "rpm" : "mm/s"),
                 c.dependent ? "closes a loop" : "found"});
      continue;
    }
    if (c.driven) {
      table.row({label, "driven", "", "", ""});
      continue;
    }
    const std::string_view unit = coordinate_unit_of(c.angle);
    const double shown = c.angle ? 180 / std::numbers::pi : 1000;
    table.row({label, quantity_within(c.value, c.error, unit), magnitude(c.error, unit),
               everyday(c.value, c.error, shown, c.angle ? "°" : "mm"), c.dependent ? "closes a loop" : ""});
  }
  return table.html();
}

Html measures_table(const Mechanism& m, const Solution& s) {
  HtmlTable table({{"Measure", false}, {"Value"}, {"Estimated error"}, {"Expression", false}, {"", false}});
  for (std::size_t i = 0; i < s.measures.size(); ++i) {
    const MeasureSolution& measure = s.measures[i];
    const Html value = !measure.value  ? Html(measure.reason)
                       : measure.error ? quantity_within(*measure.value, *measure.error, measure.unit)
                                       : quantity(*measure.value, measure.unit);
    table.row({measure.name, value, measure.error ? magnitude(*measure.error, measure.unit) : Html("-"),
               m.measures[i].text,
               (measure.nonunique ? "Not unique: loops are redundant. " : "") + m.measures[i].description});
  }
  return table.empty() ? Html() : heading_of("Measures, at the drawn phase") + table.html();
}

// How the solver arrived.
Html solver_terms(const Solution& s) {
  HtmlTerms terms;
  Html how = std::to_string(s.iterations) + (s.iterations == 1 ? " iteration" : " iterations");
  if (s.fallback) how += " (fallback: " + std::string(word(*s.fallback)) + ")";
  terms.term("Newton-Raphson", how);
  terms.term("Run time", duration(s.run_time_s));
  if (std::isfinite(s.residual))
    terms.term("Residual", magnitude(s.residual, "") + " of the largest scaled equation");
  Html history;
  for (const double h : s.history)
    if (std::isfinite(h)) history += (history.empty() ? Html() : Html(", ")) + magnitude(h, "");
  if (!history.empty()) terms.term("Residual by evaluation", history + " (scaled)");
  if (s.condition) terms.term("Condition number", magnitude(*s.condition, "") + " of the scaled equations");
  if (s.potential) terms.term("Amended potential", quantity(*s.potential, "J", 9));
  return terms.html();
}

Html unheld_table(const Solution& s) {
  HtmlTable table({{"Coordinate", false}, {"Force that nothing holds"}});
  for (const UnheldCoordinate& c : s.unheld)
    table.row({coordinate_label(c), quantity(c.force, force_unit_of(c.angle))});
  return table.empty() ? Html() : heading_of("What nothing holds") + table.html();
}

} // namespace

OptionalSection steady_state_section(const ReportContents& contents) {
  const Solution& s = contents.solution;
  const bool found = s.status == Status::converged;
  Html body = element("p", s.message, {{"class", found ? "lead" : "lead refusal"}}) + "\n";
  if (found) {
    if (!s.coordinates.empty()) body += coordinates_table(s);
    body += measures_table(*contents.mechanism, s);
    body += heading_of("How it was found") + solver_terms(s);
  } else {
    body += unheld_table(s) + heading_of("What was tried") + solver_terms(s);
  }
  return ReportSection{"steady-state", found ? "Steady state" : "No steady state", body};
}

OptionalSection sensitivities_section(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  HtmlTable table({{"Coordinate", false}, {"Slider", false}, {"Rate"}});
  for (const Sensitivity& s : contents.solution.sensitivities)
    for (const Sensitivity::Rate& r : s.rates) {
      const int joint = joint_index(m, r.joint);
      const JointType type = joint < 0 ? JointType::free : m.joints[static_cast<std::size_t>(joint)].type;
      const bool angle = is_angle(type, r.index);
      const std::string unit = std::string(coordinate_unit_of(angle)) + (r.speed ? "/s" : "");
      table.row({(r.speed ? "speed of " : "") + coordinate_label(r), s.address,
                 rate_quantity(m, r.value, r.speed ? "(" + unit + ")" : unit, s.address)});
    }
  if (table.empty()) return std::nullopt;
  return ReportSection{
      "sensitivities", "Sensitivities",
      paragraph_of("How fast each coordinate of the steady state, and each speed that is found, changes with "
                   "each slider.") +
          table.html()};
}

} // namespace flyball
