// What the results rest on: assumptions, choices of the solver, what is unlikely, and what they were made by.
#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "app/report/versions.hpp"
#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Drives by torque, or those left to themselves, by name.
template <class Is>
Html drives(const Mechanism& m, const Is& is) {
  Html out;
  for (const Joint& joint : m.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      if (const auto& drive = joint.coordinates[i].drive; drive && is(*drive))
        out += (out.empty() ? Html() : Html(", ")) + coordinate_name(joint, static_cast<int>(i));
  return out;
}

Html speeds(const Mechanism& m) {
  Html out;
  for (const Joint& joint : m.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      if (const auto& drive = joint.coordinates[i].drive; drive && !finds_speed(*drive))
        out += (out.empty() ? Html() : Html(", ")) + coordinate_name(joint, static_cast<int>(i)) + " at " +
               quantity(drive->speed, is_angle(joint.type, static_cast<int>(i)) ? "rad/s" : "m/s");
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  const std::vector<std::string_view> views(words.begin(), words.end());
  return word_list(views, "and");
}

bool damped(const Mechanism& m) {
  const auto damper = [](const Coordinate& c) { return is_damped(c); };
  return std::ranges::any_of(m.joints,
                             [&](const Joint& j) { return std::ranges::any_of(j.coordinates, damper); }) ||
         std::ranges::any_of(m.forces, [](const Force& f) {
           return is_of_air(f.type) || (f.type == ForceType::spring && is_damped(f)) ||
                  std::ranges::any_of(f.bearing_damping, [](double c) { return c != 0; });
         });
}

bool dragged(const Mechanism& m) {
  return std::ranges::any_of(m.forces, [](const Force& f) { return is_of_air(f.type); });
}

Html air_of(const Mechanism& m) {
  if (!m.air.turns_with.empty()) return Html("Turns with ") + m.air.turns_with + ", as if fixed in it.";
  if (m.air.wind.isZero(0)) return Html("At rest in the world.");
  return Html("A wind of ") + vector_quantity(m.air.wind, "m/s", 9) + ", the same everywhere.";
}

} // namespace

OptionalSection assumptions_section(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  const SystemSummary& system = contents.system;
  HtmlTerms terms;
  terms.term("Bodies", rubs_anywhere(m)
                           ? "Rigid, joined by ideal joints without play; dry friction (Coulomb's) where the "
                             "scene has it, the same sticking and slipping."
                           : "Rigid, joined by ideal joints without play or dry friction.");
  terms.term("Ground", "Fixed; the world's axes are an inertial frame, right-handed.");
  terms.term("Gravity", m.gravity.isZero() ? Html("None.")
                                           : vector_quantity(m.gravity, "m/s^2", 9) + ", size " +
                                                 quantity(m.gravity.norm(), "m/s^2", 9) + ".");
  const Html driven = speeds(m), by_torque = drives(m, [](const Drive&d) { return d.torque.has_value(); }),
             free = drives(m, [](const Drive&d) { return d.keeps == DriveKeeps::momentum; });
  if (!driven.empty() || (by_torque.empty() && free.empty()))
    terms.term("Drives", driven.empty() ? Html("None: an equilibrium at rest.")
                                        : "Constant speeds, whatever torque they take: " + driven + ".");
  if (!by_torque.empty())
    terms.term("Drives by torque",
               "Each turns at the speed at which its torque less its load is what turning takes: " +
                   by_torque + ". Stability is told with the torques, which may change with the state.");
  if (!free.empty())
    terms.term("Left to themselves",
               "Each keeps the angular or linear momentum that its given speed makes in the drawn pose, and "
               "its speed follows: " +
                   free + ". Stability is told at these momenta.");
  terms.term("Steady state", "Every other coordinate is constant.");
  terms.term("Damping", damped(m)
                            ? "Viscous dampers count in stability and modes; they move no steady state of "
                              "coordinates that stand still."
                            : "None.");
  if (dragged(m)) terms.term("Air", air_of(m));
  terms.term("Size", std::to_string(system.bodies) + (system.bodies == 1 ? " body, " : " bodies, ") +
                         std::to_string(system.free_coordinates) + " free and " +
                         std::to_string(system.driven_coordinates) + " driven coordinates, " +
                         std::to_string(system.constraint_equations) + " constraint equations.");
  terms.term("Loops", system.cut_joints.empty()
                          ? Html("None.")
                          : Html("Closed by constraint equations at " + joined(system.cut_joints) + "."));
  if (!system.implicit_joints.empty())
    terms.term("Free joints",
               "Added for bodies that no joint holds: " + joined(system.implicit_joints) + ".");
  if (contents.solution.reactions_nonunique)
    terms.term("Redundancy", "The loops are redundantly constrained; multipliers are those of least norm.");
  Html body = terms.html();
  if (!system.notes.empty()) body += heading_of("Choices of the solver") + list_of(system.notes);
  if (!system.in.empty()) body += heading_of("In the equations") + list_of(system.in);
  if (!system.left_out.empty()) body += heading_of("Left out of the equations") + list_of(system.left_out);
  return ReportSection{"assumptions", "Assumptions", body};
}

OptionalSection warnings_section(const ReportContents& contents) {
  HtmlTable table({{"Where", false}, {"What", false}});
  for (const SceneError& warning : contents.warnings)
    table.row({warning.where(), warning.expected()});
  Html body = table.empty() ? paragraph_of("None: nothing in the scene is unlikely.")
                            : paragraph_of("Allowed, and yet unlikely:") + table.html();
  if (contents.cut_short)
    body +=
        paragraph_of("The computation was cut short by its time limit: curves may be missing or end early.");
  return ReportSection{"warnings", "Warnings", body};
}

OptionalSection versions_section(const ReportContents& contents) {
  HtmlTerms terms;
  for (const auto& [name, version] : program_versions())
    terms.term(name, version);
  if (!contents.scene.empty()) terms.term("Scene", contents.scene);
  if (!contents.date.empty()) terms.term("Date of the report", element("time", contents.date));
  terms.term("Units", "SI units and radians, unless another unit stands beside the number.");
  return ReportSection{"versions", "Versions", terms.html()};
}

} // namespace flyball
