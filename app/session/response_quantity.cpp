#include "app/session/response_quantity.hpp"
#include "app/session/coordinate_words.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr double turns = 1 / (2 * std::numbers::pi);

// The end of the key where it begins like that.
std::optional<std::string> after(const std::string& key, std::string_view begin) {
  if (!key.starts_with(begin)) return std::nullopt;
  return key.substr(begin.size());
}

// Line k of one point belongs with line k of the next: where lines cross, the order changes with them.
template <class Part>
std::vector<double> sorted_parts(const ResponsePoint& point, Part part) {
  std::vector<double> values;
  values.reserve(point.eigenvalues.size());
  for (const std::complex<double>& e : point.eigenvalues)
    values.push_back(part(e));
  std::ranges::sort(values);
  return values;
}

} // namespace

std::vector<ResponseQuantity> response_quantities(const ResponsePoint& point) {
  std::vector<ResponseQuantity> out;
  for (const CoordinateSolution& c : point.coordinates)
    if (const auto found = found_number(c))
      out.push_back({"value " + found->name, found_words(c), "Coordinates", std::string(found->unit), 1});
  for (const MeasureSolution& m : point.measures)
    out.push_back({"measure " + m.name, m.name, "Measures", m.unit, 1});
  for (const DriveTorque& d : point.drive_torques) {
    const std::string name = coordinate_label(d), words = coordinate_words(d), unit = d.angle ? "N m" : "N",
                      kind = d.angle ? "torque" : "force";
    if (d.given) {
      out.push_back({"given " + name, "drive " + kind + " of " + words, "Drives", unit, 1});
      out.push_back({"load " + name, "load on " + words, "Drives", unit, 1});
    }
    if (!d.varying)
      out.push_back({"drive " + name, (d.given ? kind + " less load of " : "drive " + kind + " of ") + words,
                     "Drives", unit, 1});
  }
  for (const Reaction& r : point.reactions)
    out.push_back({"force " + r.joint, "force through " + r.joint, "Reactions", "N", 1});
  for (const Reaction& r : point.reactions)
    out.push_back({"torque " + r.joint, "torque through " + r.joint, "Reactions", "N m", 1});
  if (!point.eigenvalues.empty()) {
    out.push_back({"growth", "largest real part", "Eigenvalues", "1/s", 1});
    out.push_back({"real", "real parts", "Eigenvalues", "1/s", 1});
    out.push_back({"frequency", "frequencies", "Eigenvalues", "Hz", turns});
  }
  return out;
}

void add_quantities(std::vector<ResponseQuantity>& to, const std::vector<ResponseQuantity>& more) {
  for (const ResponseQuantity& each : more) {
    if (std::ranges::find(to, each.key, &ResponseQuantity::key) != to.end()) continue;
    const auto last = std::find_if(to.rbegin(), to.rend(),
                                   [&](const ResponseQuantity& q) { return q.group == each.group; });
    to.insert(last == to.rend() ? to.end() : last.base(), each);
  }
}

bool needs_reactions(const std::string& key) {
  constexpr std::array<std::string_view, 5> beginnings{"drive ", "given ", "load ", "force ", "torque "};
  return std::ranges::any_of(beginnings, [&](std::string_view each) { return key.starts_with(each); });
}

std::vector<double> quantity_values(const ResponsePoint& point, const std::string& key) {
  if (const auto name = after(key, "value ")) {
    for (const CoordinateSolution& c : point.coordinates) {
      const auto found = found_number(c);
      if (found && found->name == *name) return {found->value};
      if (found && !c.speed && *name == coordinate_label(c) + ".speed") return {0}; // of what slips elsewhere
    }
  } else if (const auto measure = after(key, "measure ")) {
    for (const MeasureSolution& m : point.measures)
      if (m.name == *measure && m.value) return {*m.value};
  } else if (const auto drive = after(key, "drive ")) {
    for (const DriveTorque& d : point.drive_torques)
      if (coordinate_label(d) == *drive) return {d.value};
  } else if (const auto given = after(key, "given ")) {
    for (const DriveTorque& d : point.drive_torques)
      if (d.given && coordinate_label(d) == *given) return {d.given->torque};
  } else if (const auto load = after(key, "load ")) {
    for (const DriveTorque& d : point.drive_torques)
      if (d.given && coordinate_label(d) == *load) return {d.given->load};
  } else if (const auto force = after(key, "force ")) {
    for (const Reaction& r : point.reactions)
      if (r.joint == *force) return {r.force.norm()};
  } else if (const auto torque = after(key, "torque ")) {
    for (const Reaction& r : point.reactions)
      if (r.joint == *torque) return {r.torque.norm()};
  } else if (key == "real") {
    return sorted_parts(point, [](const auto& e) { return e.real(); });
  } else if (key == "frequency") {
    return sorted_parts(point, [](const auto& e) { return std::abs(e.imag()); });
  } else if (key == "growth" && !point.eigenvalues.empty()) {
    return {sorted_parts(point, [](const auto& e) { return e.real(); }).back()};
  }
  return {};
}

std::optional<double> quantity_mark(const ResponsePoint& point, const std::string& key) {
  const std::vector<double> values = quantity_values(point, key);
  if (values.empty()) return std::nullopt;
  if (values.size() == 1) return values.front();
  // Of eigenvalues the one that decides: farthest to the right, or its frequency.
  const auto right =
      std::ranges::max_element(point.eigenvalues, {}, [](const std::complex<double>& e) { return e.real(); });
  return key == "real" ? right->real() : std::abs(right->imag());
}

} // namespace flyball
