#include "app/cli/friction_told.hpp"

#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value ? number_json(*value) : Json(nullptr);
}

std::string bound(double value) {
  return std::isfinite(value) ? fmt::format("{:.12g}", value) : std::string("no bound");
}

std::string percent(double part) {
  return fmt::format("{:.4g} %", 100 * part);
}

} // namespace

Json to_json(const FrictionBand& band) {
  Json out;
  out["band"] = band.found ? Json::object() : Json(nullptr);
  for (const BandExtent& extent : band.extents)
    out["band"][extent.name] = {number_json(extent.low), number_json(extent.high)};
  out["band_error_estimate"] = band.found ? Json::object() : Json(nullptr);
  for (const BandExtent& extent : band.extents)
    out["band_error_estimate"][extent.name] = or_null(extent.error);
  out["band_whole"] = band.whole;
  out["band_folds"] = band.folds;
  out["band_at_least"] = band.at_least;
  out["band_message"] = band.message;
  return out;
}

Json to_json(const FrictionReport& f) {
  Json out = to_json(f.band);
  Json& holding = out["holding"] = {{"takes", or_null(f.drawn.takes)},
                                    {"at_least", number_json(f.drawn.at_least)},
                                    {"first", f.drawn.first.empty() ? Json(nullptr) : Json(f.drawn.first)},
                                    {"joints", Json::object()},
                                    {"message", f.drawn.message}};
  for (const HeldJoint& joint : f.drawn.joints)
    holding["joints"][coordinate_label(joint)] = {{"limit", number_json(joint.limit)},
                                                  {"force", or_null(joint.force)}};
  out["held_speeds"] = Json::object();
  for (const HeldSpeeds& held : f.speeds)
    out["held_speeds"][coordinate_label(held)] = {{"speed", number_json(held.speed)},
                                                  {"lower", or_null(held.lower)},
                                                  {"upper", or_null(held.upper)},
                                                  {"insensitivity", or_null(held.insensitivity())}};
  out["run_time_s"] = f.run_time_s;
  return out;
}

std::string band_lines(const FrictionBand& band) {
  std::string out;
  for (const BandExtent& extent : band.extents)
    out += fmt::format("\n   friction holds {} {}from {} to {} {}", printable(extent.name),
                       band.at_least ? "at least " : "", bound(extent.low), bound(extent.high), extent.unit);
  if (!band.message.empty())
    out += (band.found ? "\n   " : "\n   its band of friction is not found: ") + printable(band.message);
  return out;
}

std::string to_text(const FrictionReport& f) {
  std::size_t width = 0;
  for (const BandExtent& extent : f.band.extents)
    width = std::max(width, extent.name.size());
  for (const HeldJoint& joint : f.drawn.joints)
    width = std::max(width, coordinate_label(joint).size());
  std::string out =
      "\nband within which friction holds it" + std::string(f.band.at_least ? ", at least" : "") + "\n";
  for (const BandExtent& extent : f.band.extents)
    out += fmt::format("  {:{}}  {:>18} to {:<18} {}{}\n", printable(extent.name), width, bound(extent.low),
                       bound(extent.high), extent.unit,
                       extent.error ? fmt::format("  ± {:.1g}", *extent.error) : "");
  if (!f.band.message.empty()) out += "  " + printable(f.band.message) + "\n";
  if (f.band.found)
    out += "  Within it the joints with friction stand still until something pushes them beyond their "
           "limits; stability is\n  told of the motion once they slip.\n";
  out += "\nin the drawn pose\n  " + printable(f.drawn.message) + "\n";
  for (const HeldJoint& joint : f.drawn.joints) {
    const char* unit = joint.angle ? "N m" : "N";
    out +=
        fmt::format("  {:{}}  limit {:.9g} {}", printable(coordinate_label(joint)), width, joint.limit, unit);
    if (joint.force)
      out += fmt::format(", needed {:.9g} {}{}", *joint.force, unit,
                         joint.limit > 0 ? " (" + percent(std::abs(*joint.force) / joint.limit) + ")" : "");
    out += "\n";
  }
  if (!f.speeds.empty()) out += "\nspeeds at which friction holds the steady state where it stands\n";
  for (const HeldSpeeds& held : f.speeds) {
    const char* unit = held.angle ? "rad/s" : "m/s";
    const auto text = [&](const std::optional<double>& speed, const char* none) {
      return speed ? fmt::format("{:.12g} {}", *speed, unit) : std::string(none);
    };
    out += fmt::format("  {:{}}  {} to {}", printable(coordinate_label(held)), width,
                       text(held.lower, "rest"), text(held.upper, "any"));
    if (const auto part = held.insensitivity()) out += ", insensitivity " + percent(*part);
    out += "\n";
  }
  out += fmt::format("  {:.1f} ms\n", f.run_time_s * 1e3);
  return out;
}

} // namespace flyball::cli
