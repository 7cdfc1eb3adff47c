#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

namespace flyball {
namespace {

std::vector<Html> range_cells(const std::string& name, const PeriodicRange& range, std::string_view unit) {
  const auto within = [&](double value) {
    return std::isfinite(range.error) ? quantity_within(value, range.error, unit) : quantity(value, unit);
  };
  if (!std::isfinite(range.mean)) return {name, "–", "–", "–", "–"};
  return {name, within(range.mean), within(range.least), within(range.most),
          std::isfinite(range.error) ? magnitude(range.error, unit) : Html("not known")};
}

const char* not_unique(bool open) {
  return open ? ", not unique" : "";
}

Html ranges_table(const PeriodicState& s) {
  HtmlTable table({{"Over a period", false}, {"Mean"}, {"Least"}, {"Most"}, {"Error of each"}});
  for (const PeriodicCoordinate& c : s.coordinates) {
    table.row(range_cells(coordinate_label(c) + (c.goes_on() ? ", less its even share" : ""), c.range,
                          coordinate_unit_of(c.angle)));
    if (c.goes_on())
      table.row(range_cells("speed of " + coordinate_label(c), c.rate, c.angle ? "rad/s" : "m/s"));
  }
  for (const PeriodicMeasure& m : s.measures)
    table.row(range_cells(m.name, m.range, m.unit));
  for (const PeriodicTorque& t : s.drive_torques) {
    table.row(range_cells("Drive of " + coordinate_label(t) + not_unique(t.nonunique), t.range,
                          force_unit_of(t.angle)));
    table.row(range_cells("Power of " + coordinate_label(t), t.power, "W"));
  }
  return table.html();
}

void vector_rows(HtmlTable& table, const std::string& name, const PeriodicVector& vector,
                 std::string_view unit) {
  // What is no more than rounding is not told.
  const auto told = [](const PeriodicRange& range) {
    return !std::isfinite(range.mean) || !std::isfinite(range.error) ||
           std::max(std::abs(range.least), std::abs(range.most)) > range.error;
  };
  if (!told(vector.size)) return;
  table.row(range_cells(name + not_unique(vector.nonunique()), vector.size, unit));
  if (vector.unique_size) table.row(range_cells("unique part", *vector.unique_size, unit));
  for (std::size_t c = 0; c < 3; ++c)
    if (told(vector.component[c]))
      table.row(range_cells(std::string("along ") + "xyz"[c] + not_unique(vector.open[c]),
                            vector.component[c], unit));
}

Html loads_tables(const PeriodicState& s) {
  Html out;
  const auto add = [&](const char* title, const char* words, const HtmlTable& table) {
    if (!table.empty()) out += heading_of(title) + paragraph_of(words) + table.html();
  };
  const auto head = [](const char* of) {
    return HtmlTable({{of, false}, {"Mean"}, {"Least"}, {"Most"}, {"Error of each"}});
  };
  const auto wrenches = [&](const char* title, const char* of, const char* words,
                            const std::vector<PeriodicReaction>& all) {
    HtmlTable table = head(of);
    for (const PeriodicReaction& r : all) {
      vector_rows(table, r.name + ", force", r.force, "N");
      vector_rows(table, r.name + ", torque", r.torque, "N m");
    }
    add(title, words, table);
  };
  wrenches("Reactions", "Joint",
           "What the parent exerts on the child through the joint, its spring, stop, damper and drive "
           "included: its size, and along the world's axes; torques about the joint's point. Where loops are "
           "redundant those of the least multipliers, which are marked as not unique.",
           s.reactions);
  wrenches("Bearings", "Bearing", "What each exerts on its second body, torques about the bearing's point.",
           s.bearings);
  HtmlTable gears = head("Gear");
  for (const PeriodicGear& g : s.gears) {
    gears.row(range_cells(g.joint + ", on its first joint" + not_unique(g.nonunique), g.a,
                          force_unit_of(g.angle_a)));
    gears.row(range_cells(g.joint + ", on its second joint" + not_unique(g.nonunique), g.b,
                          force_unit_of(g.angle_b)));
  }
  add("Gears", "Along the coordinates of their two joints, whose reactions include it.", gears);
  HtmlTable springs = head("Spring or damper");
  for (const PeriodicSpring& spring : s.springs)
    for (const auto& [words, part] :
         std::initializer_list<std::pair<const char*, const std::optional<PeriodicRange>&>>{
             {", spring", spring.spring},
             {", damper", spring.damper},
             {", stop", spring.stop},
             {", sum", spring.sum}})
      if (part)
        springs.row(range_cells(coordinate_label(spring) + words, *part, force_unit_of(spring.angle)));
  add("Springs, dampers and stops",
      "On a joint positive along its coordinate; between bodies, tension is positive.", springs);
  return out;
}

Html multipliers(const PeriodicState& s) {
  HtmlTable table({{"Multiplier", false}, {"Size"}, {"Growth"}});
  for (std::size_t i = 0; i < s.floquet.growth.size(); ++i) {
    const std::complex<double> mu = s.floquet.multipliers[i];
    Html value = quantity(mu.real(), "", 9);
    if (mu.imag() != 0)
      value += Html(mu.imag() < 0 ? " − " : " + ") + quantity(std::abs(mu.imag()), "", 9) + " i";
    table.row({value, quantity(std::abs(mu), "", 9), quantity(s.floquet.growth[i], "1/s")});
  }
  if (table.empty()) return {};
  return heading_of("Floquet multipliers") +
         paragraph_of(Html("What a period makes of motions beside it, to about ") +
                      magnitude(s.floquet.error, "") + ".") +
         table.html();
}

// What its section tells of a motion, or of why there is none.
Html told(const PeriodicState& s) {
  const bool found = s.status == PeriodicStatus::found;
  Html body = element("p", s.message, {{"class", found ? "lead" : "lead refusal"}}) + "\n";
  HtmlTerms terms;
  if (found) {
    const bool own = s.drive_periods == 0;
    terms.term("Period", own ? quantity_within(s.period, s.period_error, "s") : quantity(s.period, "s", 10));
    terms.term("Fails to come back by", magnitude(s.residual, "") + " (scaled)");
    body += ranges_table(s) + loads_tables(s) + multipliers(s) + heading_of("How it was found");
  }
  terms.term("Run time", duration(s.run_time_s));
  return body + terms.html();
}

} // namespace

OptionalSection periodic_section(const ReportContents& contents) {
  if (!contents.periodic) return std::nullopt;
  return ReportSection{"periodic-motion", "Periodic motion", told(*contents.periodic)};
}

OptionalSection cycle_section(const ReportContents& contents) {
  if (!contents.cycle) return std::nullopt;
  const bool found = contents.cycle->status == PeriodicStatus::found;
  const bool own = !found || contents.cycle->drive_periods == 0;
  Html body;
  if (found)
    body = paragraph_of(
        own ? "Swings about the steady state grow: this is the motion, with a period of its own, "
              "that was found beside it."
            : "Swings about the steady state grow: this is the motion in step with the drives "
              "that was found beside it.");
  return ReportSection{"limit-cycle", own ? "Limit cycle" : "Periodic motion", body + told(*contents.cycle)};
}

} // namespace flyball
