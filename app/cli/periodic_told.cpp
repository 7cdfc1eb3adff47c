#include "app/cli/periodic_told.hpp"

#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

Json range_json(const PeriodicRange& range) {
  return {{"mean", number_json(range.mean)},
          {"min", number_json(range.least)},
          {"max", number_json(range.most)},
          {"error_estimate", number_json(range.error)}};
}

Json vector_json(const PeriodicVector& vector) {
  Json out = {{"size", range_json(vector.size)},
              {"x", range_json(vector.component[0])},
              {"y", range_json(vector.component[1])},
              {"z", range_json(vector.component[2])}};
  if (vector.nonunique()) out["unique"] = {!vector.open[0], !vector.open[1], !vector.open[2]};
  if (vector.unique_size) out["unique_size"] = range_json(*vector.unique_size);
  return out;
}

Json wrench_json(const PeriodicReaction& r) {
  Json out = {{"force", vector_json(r.force)}, {"torque", vector_json(r.torque)}};
  if (r.nonunique()) out["nonunique"] = true;
  return out;
}

using SpringPart = std::optional<PeriodicRange> PeriodicSpring::*;
constexpr std::array<std::pair<const char*, SpringPart>, 4> spring_parts{{{"spring", &PeriodicSpring::spring},
                                                                          {"damper", &PeriodicSpring::damper},
                                                                          {"stop", &PeriodicSpring::stop},
                                                                          {"sum", &PeriodicSpring::sum}}};

Json spring_json(const PeriodicSpring& s) {
  Json out = Json::object();
  for (const auto& [key, part] : spring_parts)
    if (s.*part) out[key] = range_json(*(s.*part));
  return out;
}

// As many decimals as the error leaves.
std::string in_digits(double value, double error) {
  const double digits = std::isfinite(error) && error > 0 ? std::floor(-std::log10(error)) : 9;
  const int decimals = static_cast<int>(std::clamp(digits, 0., 15.));
  if (std::abs(value) < 0.5 * std::pow(10, -decimals)) value = 0; // no sign
  return fmt::format("{:.{}f}", value, decimals);
}

std::vector<std::string> range_row(const std::string& name, const PeriodicRange& range,
                                   std::string_view unit) {
  if (!std::isfinite(range.mean))
    return {name, "-", "-", "-", std::string(unit), "not defined throughout, or does not come back"};
  return {name,
          in_digits(range.mean, range.error),
          in_digits(range.least, range.error),
          in_digits(range.most, range.error),
          std::string(unit),
          std::isfinite(range.error) ? fmt::format("± {:.1g}", range.error) : "error not known"};
}

// Of what is no more than rounding there are no rows.
bool told(const PeriodicRange& range) {
  return !std::isfinite(range.mean) || !std::isfinite(range.error) ||
         std::max(std::abs(range.least), std::abs(range.most)) > range.error;
}

void add_vector(std::vector<std::vector<std::string>>& rows, const std::string& name,
                const PeriodicVector& vector, std::string_view unit) {
  if (!told(vector.size)) return;
  rows.push_back(range_row(name + (vector.nonunique() ? " (not unique)" : ""), vector.size, unit));
  if (vector.unique_size) rows.push_back(range_row("  unique part", *vector.unique_size, unit));
  for (std::size_t c = 0; c < 3; ++c)
    if (told(vector.component[c]))
      rows.push_back(range_row(std::string("  ") + "xyz"[c] + (vector.open[c] ? " (not unique)" : ""),
                               vector.component[c], unit));
}

std::vector<std::vector<std::string>> load_rows(const PeriodicState& s) {
  std::vector<std::vector<std::string>> rows;
  const auto open = [](bool nonunique) { return nonunique ? " (not unique)" : ""; };
  for (const auto list : {&PeriodicState::reactions, &PeriodicState::bearings})
    for (const PeriodicReaction& r : s.*list) {
      add_vector(rows, printable(r.name) + ", force", r.force, "N");
      add_vector(rows, printable(r.name) + ", torque", r.torque, "N m");
    }
  for (const PeriodicGear& g : s.gears) {
    rows.push_back(range_row(printable(g.joint) + ", on its first joint" + open(g.nonunique), g.a,
                             g.angle_a ? "N m" : "N"));
    rows.push_back(range_row(printable(g.joint) + ", on its second joint" + open(g.nonunique), g.b,
                             g.angle_b ? "N m" : "N"));
  }
  return rows;
}

std::vector<std::vector<std::string>> spring_rows(const PeriodicState& s) {
  std::vector<std::vector<std::string>> rows;
  for (const PeriodicSpring& spring : s.springs)
    for (const auto& [words, part] : spring_parts)
      if (spring.*part)
        rows.push_back(
            range_row(shown_label(spring) + ", " + words, *(spring.*part), spring.angle ? "N m" : "N"));
  return rows;
}

std::string advance_text(const PeriodicCoordinate& c) {
  if (!c.goes_on()) return "";
  return c.angle ? fmt::format(", less {:.6g} turns a period", c.advance / (2 * std::numbers::pi))
                 : fmt::format(", less {:.6g} m a period", c.advance);
}

} // namespace

Json to_json(const PeriodicState& s) {
  const bool found = s.status == PeriodicStatus::found;
  Json out = {{"status", word(s.status)}, {"message", s.message}};
  for (const char* key :
       {"period_s", "period_error", "drive_periods", "coordinates", "drive_torques", "drive_powers",
        "reactions", "bearings", "joint_springs", "springs", "measures", "start", "stable",
        "stability_reason", "floquet", "residual", "iterations", "history", "segments"})
    out[key] = nullptr;
  out["evaluations"] = s.evaluations;
  out["run_time_s"] = s.run_time_s;
  if (!found) return out;
  out["period_s"] = number_json(s.period);
  out["period_error"] = number_json(s.period_error);
  out["drive_periods"] = s.drive_periods;
  out["coordinates"] = Json::object();
  for (const PeriodicCoordinate& c : s.coordinates) {
    Json& entry = out["coordinates"][coordinate_label(c)] = range_json(c.range);
    if (!c.goes_on()) continue;
    entry["advance"] = number_json(c.advance);
    entry["rate"] = range_json(c.rate);
  }
  out["drive_torques"] = Json::object();
  for (const PeriodicTorque& t : s.drive_torques)
    out["drive_torques"][coordinate_label(t)] = range_json(t.range);
  for (const PeriodicTorque& t : s.drive_torques)
    if (t.nonunique) out["drive_torques"][coordinate_label(t)]["nonunique"] = true;
  out["drive_powers"] = Json::object();
  for (const PeriodicTorque& t : s.drive_torques)
    out["drive_powers"][coordinate_label(t)] = range_json(t.power);
  out["reactions"] = Json::object();
  for (const PeriodicReaction& r : s.reactions)
    out["reactions"][r.name] = wrench_json(r);
  for (const PeriodicGear& g : s.gears) {
    Json& entry = out["reactions"][g.joint] = {{"a", range_json(g.a)}, {"b", range_json(g.b)}};
    if (g.nonunique) entry["nonunique"] = true;
  }
  out["bearings"] = Json::object();
  for (const PeriodicReaction& b : s.bearings)
    out["bearings"][b.name] = wrench_json(b);
  out["joint_springs"] = out["springs"] = Json::object();
  for (const PeriodicSpring& spring : s.springs)
    out[spring.between_points ? "springs" : "joint_springs"][coordinate_label(spring)] = spring_json(spring);
  out["measures"] = Json::object();
  for (const PeriodicMeasure& m : s.measures) {
    out["measures"][m.name] = range_json(m.range);
    out["measures"][m.name]["unit"] = m.unit;
  }
  out["start"] = Json::object();
  for (const PeriodicCoordinate& c : s.coordinates) {
    const auto at = std::ranges::find_if(s.start.coordinates, [&](const StateCoordinate& x) {
      return x.joint == c.joint && x.index == c.index;
    });
    if (at != s.start.coordinates.end())
      out["start"][coordinate_label(c)] = {{"value", number_json(at->value)},
                                           {"rate", number_json(at->rate)}};
  }
  if (s.stable) out["stable"] = *s.stable;
  if (s.stability_reason) out["stability_reason"] = word(*s.stability_reason);
  out["floquet"] = floquet_json(s.floquet);
  out["residual"] = number_json(s.residual);
  out["iterations"] = s.iterations;
  out["history"] = Json::array();
  for (const double h : s.history)
    out["history"].push_back(number_json(h));
  out["segments"] = s.segments;
  return out;
}

std::string to_text(const PeriodicState& s) {
  std::string out = "\nperiodic motion\n  " + printable(s.message) + "\n";
  if (s.status != PeriodicStatus::found)
    return out + fmt::format("  {} evaluations, {:.1f} ms\n", s.evaluations, s.run_time_s * 1e3);
  std::vector<std::vector<std::string>> rows{{"over a period", "mean", "min", "max", "", ""}};
  for (const PeriodicCoordinate& c : s.coordinates) {
    rows.push_back(range_row(shown_label(c) + advance_text(c), c.range, c.angle ? "rad" : "m"));
    if (c.goes_on())
      rows.push_back(range_row("speed of " + shown_label(c), c.rate, c.angle ? "rad/s" : "m/s"));
  }
  for (const PeriodicMeasure& m : s.measures)
    rows.push_back(range_row(printable(m.name), m.range, m.unit));
  for (const PeriodicTorque& t : s.drive_torques) {
    rows.push_back(range_row(shown_label(t) + ", by the drive" + (t.nonunique ? " (not unique)" : ""),
                             t.range, t.angle ? "N m" : "N"));
    rows.push_back(range_row(shown_label(t) + ", its power", t.power, "W"));
  }
  out += "\n" + aligned(rows, true);
  if (std::vector<std::vector<std::string>> loads = load_rows(s); !loads.empty()) {
    loads.insert(loads.begin(),
                 {"parent on child, and bearings on their second body", "mean", "min", "max", "", ""});
    out += "\n" + aligned(loads, true);
    if (std::ranges::any_of(s.reactions, &PeriodicReaction::nonunique) ||
        std::ranges::any_of(s.gears, &PeriodicGear::nonunique))
      out += "  (not unique): the loops are redundant; of many possible ones these have the least "
             "multipliers.\n";
  }
  if (std::vector<std::vector<std::string>> springs = spring_rows(s); !springs.empty()) {
    springs.insert(springs.begin(), {"springs, dampers and stops", "mean", "min", "max", "", ""});
    out += "\n" + aligned(springs, true);
  }
  if (!s.floquet.multipliers.empty()) {
    out += fmt::format("\nFloquet multipliers, to an estimated {:.1g}\n", s.floquet.error);
    for (std::size_t i = 0; i < s.floquet.growth.size(); ++i)
      out += fmt::format("  {:>+13.9f} {:>+13.9f} i  size {:.9g}, growth {:.6g} 1/s (± {:.1g})\n",
                         s.floquet.multipliers[i].real(), s.floquet.multipliers[i].imag(),
                         std::abs(s.floquet.multipliers[i]), s.floquet.growth[i],
                         s.floquet.error / (std::abs(s.floquet.multipliers[i]) * s.period));
  }
  return out + fmt::format("\nresidual {:.1e}, {} iterations, {} {}, {} evaluations, {:.1f} ms\n", s.residual,
                           s.iterations, s.segments, s.segments == 1 ? "segment" : "segments", s.evaluations,
                           s.run_time_s * 1e3);
}

} // namespace flyball::cli
