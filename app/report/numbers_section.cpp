// The numbers that the scene gives: those of its sliders, and all of them.
#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"

namespace flyball {

OptionalSection sliders_section(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  HtmlTable table({{"Parameter", false}, {"Value"}, {"From"}, {"To"}, {"Scale", false}, {"About", false}});
  for (const Slider& s : m.sliders) {
    const std::string unit = parameter_unit(m, s.parameter);
    table.row({s.parameter, quantity(get_parameter(m, s.parameter), unit, 9), quantity(s.from, unit),
               quantity(s.to, unit), s.scale == SliderScale::log ? "logarithmic" : "linear", s.description});
  }
  if (table.empty()) return std::nullopt;
  return ReportSection{
      "parameters", "Parameters",
      paragraph_of("The numbers that the scene has sliders for, as they were for this report. All "
                   "numbers stand at the end.") +
          table.html()};
}

OptionalSection numbers_section(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  HtmlTable table({{"Address", false}, {"Value"}});
  for (const std::string& address : parameter_addresses(m))
    table.row({address, quantity(get_parameter(m, address), parameter_unit(m, address), 12)});
  if (table.empty()) return std::nullopt;
  return ReportSection{"numbers", "All numbers of the scene",
                       element("div", table.html(), {{"class", "columns"}})};
}

OptionalSection laws_section(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  HtmlTable table({{"Of", false}, {"Law", false}});
  for (const Joint& joint : m.joints)
    for (const Formula& f : joint.formulas)
      if (is_drive_law(m, f) || is_force_law(f))
        table.row({"joints." + joint.name + "." + f.key, "= " + f.text});
  for (const Force& force : m.forces)
    for (const Formula& f : force.formulas)
      if (is_force_law(f)) table.row({"forces." + force.name + "." + f.key, "= " + f.text});
  if (table.empty()) return std::nullopt;
  return ReportSection{
      "laws", "Laws",
      paragraph_of("Torques and loads of drives, forces of springs and dampers and coefficients of "
                   "vanes that are expressions of the state.") +
          table.html()};
}

OptionalSection bodies_section(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  const Solution& s = contents.solution;
  const bool found = s.status == Status::converged && s.poses.size() == m.bodies.size();
  const bool moving = found && s.centres.size() == m.bodies.size();
  HtmlTable table({{"Body", false},
                   {"Mass"},
                   {found ? "Mass centre (x, y, z)" : "Mass centre as drawn (x, y, z)"},
                   {"Speed"},
                   {"Acceleration"}});
  for (std::size_t i = 0; i < m.bodies.size(); ++i)
    table.row({m.bodies[i].name, quantity(m.bodies[i].mass, "kg"),
               vector_quantity(found ? s.poses[i].position : m.bodies[i].position, "m", 5),
               moving ? quantity(s.centres[i].velocity.norm(), "m/s", 5) : Html(),
               moving ? quantity(s.centres[i].acceleration.norm(), "m/s^2", 5) : Html()});
  if (table.empty()) return std::nullopt;
  return ReportSection{
      "bodies", "Bodies",
      paragraph_of(found ? "Where they are in the steady state, at the drawn phase of the drives, in "
                           "world axes."
                         : "As they are drawn, in world axes.") +
          table.html()};
}

} // namespace flyball
