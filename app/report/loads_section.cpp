#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

const char* flags(bool varying, bool nonunique) {
  return varying && nonunique ? "changes with the phase; not unique"
         : varying            ? "changes with the phase"
         : nonunique          ? "not unique"
                              : "";
}

double drive_speed(const Mechanism& m, const Solution& s, const DriveTorque& d) {
  for (const CoordinateSolution& c : s.coordinates)
    if (c.speed && c.joint == d.joint && c.index == d.index) return *c.speed;
  const int joint = joint_index(m, d.joint);
  if (joint < 0) return 0;
  const auto& drive =
      m.joints[static_cast<std::size_t>(joint)].coordinates[static_cast<std::size_t>(d.index)].drive;
  return drive ? drive->speed : 0;
}

Html drives(const Mechanism& m, const Solution& s) {
  const std::vector<DriveTorque>& all = s.drive_torques;
  if (all.empty()) return {};
  HtmlTable table(
      {{"Drive", false}, {"Speed"}, {"Torque or force"}, {"Power"}, {"Over all phases", false}, {"", false}});
  for (const DriveTorque& d : all) {
    const std::string_view unit = force_unit_of(d.angle);
    const double speed = drive_speed(m, s, d);
    Html range;
    if (d.given)
      range = "gives " + quantity(d.given->torque, unit, 9) + ", load " + quantity(d.given->load, unit, 9);
    if (d.varying && d.range)
      range = quantity(d.range->least, unit) + " to " + quantity(d.range->most, unit) + ", mean " +
              quantity(d.range->mean, unit);
    table.row({coordinate_label(d), quantity(speed, d.angle ? "rad/s" : "m/s"), quantity(d.value, unit, 9),
               quantity(d.value * speed, "W"), range, flags(d.varying, d.nonunique)});
  }
  return heading_of("Drives") +
         paragraph_of("What each drive exerts, positive along its coordinate; of one by torque what its "
                      "torque exceeds its load by.") +
         table.html();
}

// What is rounding beside the largest reaction is shown as zero.
Vec3 without_rounding(const Vec3& v, double largest) {
  return v.unaryExpr([&](double x) { return std::abs(x) < 1e-12 * largest ? 0. : x; });
}

// Of joints and bearings: N, N m.
struct LargestLoads {
  double force = 0, torque = 0;
};
LargestLoads largest_loads(const Solution& s) {
  LargestLoads out;
  const auto take = [&](const auto& all) {
    for (const auto& each : all)
      out = {std::max(out.force, each.force.norm()), std::max(out.torque, each.torque.norm())};
  };
  take(s.reactions);
  take(s.bearings);
  return out;
}

void wrench_row(HtmlTable& table, const std::string& name, const Vec3& force, const Vec3& torque,
                const LargestLoads& largest, const OpenWrench& open, const char* told) {
  const Vec3 f = without_rounding(force, largest.force),
             t = without_rounding(torque, std::max(largest.torque, largest.force));
  table.row({name, vector_quantity(f, "N", 5, open.force), quantity(f.norm(), "N", 5),
             vector_quantity(t, "N m", 5, open.torque), quantity(t.norm(), "N m", 5), told});
}

Html reactions(const Solution& s) {
  if (s.reactions.empty()) return {};
  HtmlTable table(
      {{"Joint", false}, {"Force (x, y, z)"}, {"Size"}, {"Torque (x, y, z)"}, {"Size"}, {"", false}});
  for (const Reaction& r : s.reactions) {
    wrench_row(table, r.joint, r.force, r.torque, largest_loads(s), r.open, flags(r.varying, r.nonunique()));
    if (r.nonunique())
      wrench_row(table, "unique part", r.open.force.unique_part(r.force), r.open.torque.unique_part(r.torque),
                 largest_loads(s), {}, "");
  }
  Html out = heading_of("Reactions") +
             paragraph_of(
                 "What the parent exerts on the child through the joint, its spring, stop, damper and drive "
                 "included: in world axes at the drawn phase, torques about the joint's point.") +
             table.html();
  if (s.reactions_nonunique)
    out += element("p",
                   "Not unique: the loops are redundant, and of many possible reactions these have the least "
                   "multipliers. What is open is marked by ≈; the unique part is what lies across it.",
                   {{"class", "note"}}) +
           "\n";
  return out;
}

Html bearings(const Solution& s) {
  if (s.bearings.empty()) return {};
  HtmlTable table(
      {{"Bearing", false}, {"Force (x, y, z)"}, {"Size"}, {"Torque (x, y, z)"}, {"Size"}, {"", false}});
  for (const BearingForce& b : s.bearings)
    wrench_row(table, b.bearing, b.force, b.torque, largest_loads(s), {}, flags(b.varying, false));
  return heading_of("Bearings") +
         paragraph_of("What each exerts on its second body, its damping included: in world axes at the drawn "
                      "phase, torques about the bearing's point.") +
         table.html();
}

Html gears(const Solution& s) {
  if (s.gears.empty()) return {};
  HtmlTable table({{"Gear", false}, {"On its first joint"}, {"On its second joint"}, {"", false}});
  for (const GearReaction& g : s.gears)
    table.row({g.joint, quantity(g.a, force_unit_of(g.angle_a), 9),
               quantity(g.b, force_unit_of(g.angle_b), 9), flags(g.varying, g.nonunique)});
  return heading_of("Gears") +
         paragraph_of("Along the coordinates of their two joints, whose reactions include it.") +
         table.html();
}

Html springs(const std::vector<SpringLoad>& all) {
  if (all.empty()) return {};
  HtmlTable table({{"Spring", false},
                   {"Kind", false},
                   {"Coordinate or length"},
                   {"Deflection"},
                   {"Force or torque"},
                   {"Energy"}});
  for (const SpringLoad& s : all) {
    const std::string_view unit = coordinate_unit_of(s.angle);
    table.row({s.name, s.kind, quantity(s.at, unit), quantity(s.deflection, unit),
               quantity(s.force, force_unit_of(s.angle)), quantity(s.energy, "J", 4)});
  }
  return heading_of("Springs and stops") +
         paragraph_of("On a joint positive along its coordinate; between bodies, tension is positive.") +
         table.html();
}

} // namespace

OptionalSection loads_section(const ReportContents& contents) {
  const Html body = drives(*contents.mechanism, contents.solution) + springs(contents.springs) +
                    reactions(contents.solution) + bearings(contents.solution) + gears(contents.solution);
  if (body.empty()) return std::nullopt;
  return ReportSection{"loads", "Loads", body};
}

} // namespace flyball
