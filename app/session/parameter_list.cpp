#include "app/session/parameter_list.hpp"

#include "app/document/explored.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/formulas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace flyball {

namespace {

// 1, 2 or 5 times a power of ten, not below the value.
double round_up(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double m : {1.0, 2.0, 5.0})
    if (value <= m * power * (1 + 1e-12)) return m * power;
  return 10 * power;
}

std::vector<std::string> split(std::string_view address) {
  std::vector<std::string> parts(1);
  for (const char c : address) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

double power_of_ten(double value) {
  return std::pow(10, std::round(std::log10(value)));
}

struct Range {
  double from = 0, to = 1;
  bool log = false;
};

// For a number that is zero: what a person may want to try, in SI units.
double usual(std::string_view unit) {
  if (unit == "rad/s") return 20;
  if (unit == "rad") return 3;
  if (unit == "m/s^2") return 10;
  if (unit == "N/m" || unit == "N m/rad") return 1000;
  return unit == "N" || unit == "N m" || unit == "N s/m" ? 100 : 1;
}

// With ends that are round in the unit that is shown.
Range range_for(double si, std::string_view unit, bool stiffness, const DisplayUnits& units) {
  const ShownUnit shown = shown_unit(unit, units);
  const double value = shown.shown(si), size = std::abs(value);
  const auto ends = [&](double from, double to, bool log) {
    return Range{shown.si(from), shown.si(to), log};
  };
  if (stiffness && value > 0) return ends(power_of_ten(value / 100), power_of_ten(value * 100), true);
  // What has no direction is not negative.
  const bool one_sided = unit == "kg" || unit == "kg m^2" || unit == "s" || unit == "N s/m" ||
                         unit == "N m s/rad" || unit == "N s^2/m^2" || stiffness;
  if (size == 0) {
    const double most = shown.text == "°" ? 180 : round_up(shown.shown(usual(unit)));
    return ends(one_sided ? 0 : -most, most, false);
  }
  return value < 0 ? ends(-round_up(2 * size), 0, false) : ends(0, round_up(2 * size), false);
}

bool is_stiffness(std::string_view address) {
  return address.ends_with(".stiffness");
}

// Of a row or column of a bearing's matrix: "x", "turn z".
std::string shift_or_turn(const std::string& index) {
  const auto i = static_cast<std::size_t>(std::atoi(index.c_str()));
  return (i < 3 ? "" : "turn ") + std::string(1, "xyz"[i % 3]);
}

// "drive.0.speed" of a joint with several coordinates becomes "speed 0", "position.1" "position y", and
// "stiffness.0.1" of a bearing "stiffness x by y".
std::string what_of(const std::vector<std::string>& parts) {
  const auto is_index = [](const std::string& part) {
    return part.find_first_not_of("0123456789") == std::string::npos;
  };
  const auto axis = [](const std::string& index) {
    return std::string(1, "xyz"[static_cast<std::size_t>(std::atoi(index.c_str())) % 3]);
  };
  if (parts.front() == "parameters") return "";
  if (parts.front() == "points") return parts.size() > 2 ? axis(parts[2]) : "";
  if (parts.front() == "gravity") return parts.size() > 1 ? axis(parts[1]) : "";
  if (parts.front() == "air" && parts.size() > 2) return parts[1] + " " + axis(parts[2]);
  if (parts.size() > 3 && parts[2] == "inertia")
    return "inertia " +
           std::array<std::string, 6>{
               "xx", "yy", "zz", "xy", "xz", "yz"}[static_cast<std::size_t>(std::atoi(parts[3].c_str()) % 6)];
  if (parts.size() > 4 && parts[2] == "shapes") {
    std::vector<std::string> of_shape{parts[0], parts[1]};
    of_shape.insert(of_shape.end(), parts.begin() + 4, parts.end());
    return what_of(of_shape) + " of shape " + parts[3];
  }
  constexpr std::array vectors{"position", "at",    "axis", "axes", "x_axis", "points", "vector",
                               "normal",   "chord", "size", "from", "to",     "turn"};
  const bool vector = parts.size() > 3 && std::ranges::find(vectors, parts[2]) != vectors.end();
  if (vector && parts[2] == "vector") return "component " + axis(parts.back()); // of a force or torque
  if (vector) return parts[2] + (parts.size() > 4 ? " " + parts[3] : "") + " " + axis(parts.back());
  const bool matrix = parts.size() == 5 && is_index(parts[3]) && is_index(parts[4]);
  if (matrix) return parts[2] + " " + shift_or_turn(parts[3]) + " by " + shift_or_turn(parts[4]);
  if (parts.size() > 3 && is_index(parts.back())) return parts[2] + " " + parts.back();
  std::string words = parts.back();
  constexpr std::array known{"speed", "torque", "load", "stiffness"}; // without a word of whose they are
  const bool plain = std::ranges::find(known, parts.back()) != known.end();
  for (std::size_t i = 2; i + 1 < parts.size(); ++i) {
    if (is_index(parts[i]))
      words += " " + parts[i];
    else if (!plain || (parts[i] != "drive" && parts[i] != "spring"))
      words = parts[i] + " " + words;
  }
  return words;
}

// What the number is of: the part or point that has the name, or "gravity", "air" and "simulation", of which
// the scene has one each.
std::string owner_of(const std::vector<std::string>& parts) {
  const bool one = parts[0] == "gravity" || parts[0] == "air" || parts[0] == "simulation";
  return one || parts.size() < 2 ? parts[0] : parts[1];
}

ParameterControl named_control(const std::string& address, ParameterGroup group, std::string unit,
                               double value, std::optional<double> file_value) {
  ParameterControl control;
  const std::vector<std::string> parts = split(address);
  control.address = address;
  control.group = group;
  control.name = owner_of(parts);
  control.what = what_of(parts);
  std::ranges::replace(control.what, '_', ' ');
  control.unit = std::move(unit);
  control.value = value;
  control.file_value = file_value.value_or(value);
  return control;
}

void set_range(ParameterControl& control, const Range& range) {
  control.from = range.from;
  control.to = range.to;
  control.log = range.log;
}

void set_step(ParameterControl& control) {
  const double span = std::abs(control.to - control.from);
  if (!control.log && span > 0) control.step = slider_step(span);
}

// Where the parts of the file are, by name.
struct FileParts {
  explicit FileParts(const Mechanism& file) {
    for (const Joint& joint : file.joints)
      joints.emplace(joint.name, &joint);
    for (const Force& force : file.forces)
      forces.emplace(force.name, &force);
  }
  const Coordinate* coordinate(const std::string& joint, std::size_t i) const {
    const auto found = joints.find(joint);
    return found != joints.end() && i < found->second->coordinates.size() ? &found->second->coordinates[i]
                                                                          : nullptr;
  }
  std::unordered_map<std::string_view, const Joint*> joints;
  std::unordered_map<std::string_view, const Force*> forces;
};

Range range_of(const Mechanism& mechanism, const std::string& address, double value, std::string_view unit,
               const DisplayUnits& units) {
  if (address.starts_with("parameters."))
    if (const int i = parameter_index(mechanism, address.substr(address.find('.') + 1)); i >= 0)
      if (const auto& range = mechanism.parameters[static_cast<std::size_t>(i)].range)
        return {(*range)[0], (*range)[1], false};
  return range_for(value, unit, is_stiffness(address), units);
}

// Addresses, among those of automatic_controls(), that expressions give.
std::unordered_set<std::string> given_addresses(const Mechanism& mechanism) {
  std::unordered_set<std::string> out;
  const auto add = [&](const char* list, const auto& parts) {
    for (const auto& part : parts)
      for (const Formula& formula : part.formulas)
        out.insert(list + part.name + "." + formula.key);
  };
  add("joints.", mechanism.joints);
  add("forces.", mechanism.forces);
  for (const NamedParameter& parameter : mechanism.parameters)
    if (!parameter.formulas.empty()) out.insert("parameters." + parameter.name);
  return out;
}

// Of every named parameter, drive and spring, in the scene's order.
std::vector<ParameterControl> automatic_controls(const Mechanism& mechanism, const Mechanism& file,
                                                 const DisplayUnits& units) {
  const FileParts saved(file);
  std::vector<ParameterControl> controls;
  for (const NamedParameter& parameter : mechanism.parameters) {
    const std::string address = "parameters." + parameter.name;
    controls.push_back(named_control(address, ParameterGroup::named, parameter.unit, parameter.value,
                                     find_number(file, address)));
  }
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      const Coordinate& coordinate = joint.coordinates[i];
      const Coordinate* before = saved.coordinate(joint.name, i);
      const bool angle = is_angle(joint.type, static_cast<int>(i));
      const std::string path = "joints." + joint.name + ".";
      const auto key = [&](std::string_view part) { return path + coordinate_key(joint, i, part); };
      std::optional<double> stiffness, speed, torque, load, damping;
      if (before && before->spring) stiffness = before->spring->stiffness;
      if (before && before->drive) {
        speed = before->drive->speed;
        torque = before->drive->torque;
        load = before->drive->load;
      }
      if (before && before->damping != 0) damping = before->damping;
      if (coordinate.spring && coordinate.spring->force && !spring_law(joint, static_cast<int>(i)))
        controls.push_back(named_control(key("spring") + ".force", ParameterGroup::springs,
                                         angle ? "N m" : "N", *coordinate.spring->force,
                                         before && before->spring ? before->spring->force : std::nullopt));
      if (coordinate.spring && !coordinate.spring->force)
        controls.push_back(named_control(key("spring") + ".stiffness", ParameterGroup::springs,
                                         angle ? "N m/rad" : "N/m", coordinate.spring->stiffness, stiffness));
      if (coordinate.drive && !coordinate.drive->torque)
        controls.push_back(named_control(key("drive") + ".speed", ParameterGroup::drives,
                                         angle ? "rad/s" : "m/s", coordinate.drive->speed, speed));
      if (coordinate.drive && coordinate.drive->torque &&
          !drive_law(mechanism, joint, static_cast<int>(i), "torque"))
        controls.push_back(named_control(key("drive") + ".torque", ParameterGroup::drives,
                                         angle ? "N m" : "N", *coordinate.drive->torque, torque));
      if (coordinate.drive && coordinate.drive->load &&
          !drive_law(mechanism, joint, static_cast<int>(i), "load"))
        controls.push_back(named_control(key("drive") + ".load", ParameterGroup::drives, angle ? "N m" : "N",
                                         *coordinate.drive->load, load));
      if (coordinate.damping != 0 || damping)
        controls.push_back(named_control(key("damping"), ParameterGroup::dampers,
                                         angle ? "N m s/rad" : "N s/m", coordinate.damping, damping));
    }
  for (const Force& force : mechanism.forces) {
    if (force.type != ForceType::spring) continue;
    const auto found = saved.forces.find(force.name);
    const bool was_spring = found != saved.forces.end() && found->second->type == ForceType::spring;
    if (const double before = was_spring ? found->second->damping : 0; force.damping != 0 || before != 0)
      controls.push_back(named_control("forces." + force.name + ".damping", ParameterGroup::dampers, "N s/m",
                                       force.damping, before != 0 ? std::optional(before) : std::nullopt));
    if (force.force && !spring_law(force))
      controls.push_back(named_control("forces." + force.name + ".force", ParameterGroup::springs, "N",
                                       *force.force, was_spring ? found->second->force : std::nullopt));
    if (force.stiffness == 0) continue; // a damper alone, or a force in its place
    controls.push_back(named_control("forces." + force.name + ".stiffness", ParameterGroup::springs, "N/m",
                                     force.stiffness,
                                     was_spring ? std::optional(found->second->stiffness) : std::nullopt));
  }
  for (ParameterControl& control : controls)
    set_range(control, range_of(mechanism, control.address, control.file_value, control.unit, units));
  const std::unordered_set<std::string> given = given_addresses(mechanism);
  std::erase_if(controls, [&](const ParameterControl& control) { return given.contains(control.address); });
  return controls;
}

// What stands before the word.
std::string kind_word(SpeedKind kind) {
  return kind == SpeedKind::drawn ? "drawn " : kind == SpeedKind::guessed ? "guessed " : "";
}

void tell_speed_kind(const Mechanism& mechanism, ParameterControl& control) {
  control.what = kind_word(speed_kind(mechanism, control.address)) + control.what;
}

} // namespace

std::vector<ParameterControl> parameter_controls(const Mechanism& mechanism, const Mechanism& file,
                                                 const DisplayUnits& units) {
  std::vector<ParameterControl> controls;
  std::unordered_set<std::string> pinned;
  for (const Slider& slider : mechanism.sliders) {
    // Of an unfinished mechanism, it may be of a number that is not there.
    const std::optional<double> value = find_number(mechanism, slider.parameter);
    if (!value || formula_at(mechanism, slider.parameter) || !pinned.insert(slider.parameter).second)
      continue;
    ParameterControl& control = controls.emplace_back(
        named_control(slider.parameter, ParameterGroup::pinned, parameter_unit(mechanism, slider.parameter),
                      *value, find_number(file, slider.parameter)));
    control.from = slider.from;
    control.to = slider.to;
    control.log = slider.scale == SliderScale::log;
  }
  for (ParameterControl& control : automatic_controls(mechanism, file, units))
    if (!pinned.contains(control.address)) controls.push_back(std::move(control));
  for (ParameterControl& control : controls) {
    set_step(control);
    tell_speed_kind(mechanism, control);
  }
  std::ranges::stable_sort(controls, {}, &ParameterControl::group);
  return controls;
}

std::optional<ParameterControl> number_control(const Mechanism& mechanism, const Mechanism& file,
                                               const std::string& address, const DisplayUnits& units) {
  const std::optional<double> value = find_number(mechanism, address);
  if (!value || formula_at(mechanism, address)) return std::nullopt;
  ParameterControl control = named_control(address, ParameterGroup::named, parameter_unit(mechanism, address),
                                           *value, find_number(file, address));
  set_range(control, range_of(mechanism, address, control.file_value, control.unit, units));
  set_step(control);
  tell_speed_kind(mechanism, control);
  return control;
}

bool take_value(std::vector<ParameterControl>& controls, const Mechanism& mechanism, const Mechanism& file,
                const std::string& address) {
  const auto control = std::ranges::find(controls, address, &ParameterControl::address);
  const std::optional<double> value = find_number(mechanism, address), saved = find_number(file, address);
  if (control == controls.end() || !value || saved != control->file_value) return false;
  // Springs and dampers of zero have no slider of their own.
  const bool always = control->group == ParameterGroup::pinned || control->group == ParameterGroup::named ||
                      control->group == ParameterGroup::drives;
  if (!always && (*value == 0 || *saved == 0)) return false;
  control->value = *value;
  return true;
}

double new_drive_speed(const DisplayUnits& units) {
  constexpr double rad_per_s = 10;
  const ShownUnit unit = shown_unit("rad/s", units);
  return unit.si(round_up(unit.shown(rad_per_s)));
}

Slider slider_for(const Mechanism& mechanism, const std::string& address, const DisplayUnits& units) {
  const Range range = range_of(mechanism, address, get_parameter(mechanism, address),
                               parameter_unit(mechanism, address), units);
  Slider slider;
  slider.parameter = address;
  slider.from = range.from;
  slider.to = range.to;
  slider.scale = range.log ? SliderScale::log : SliderScale::linear;
  return slider;
}

std::string parameter_phrase(std::string_view address) {
  const std::vector<std::string> parts = split(address);
  std::string what = what_of(parts);
  std::ranges::replace(what, '_', ' ');
  const std::string owner = owner_of(parts);
  if (what.empty()) return owner;
  const bool drive = address.find(".drive") != std::string_view::npos;
  if (drive && what.starts_with("load")) return what + " on " + owner; // as plots call them
  return (drive && what.starts_with("torque") ? "drive " : "") + what + " of " + owner;
}

SpeedKind speed_kind(const Mechanism& mechanism, const std::string& address) {
  if (!address.starts_with("joints.") || !address.ends_with(".speed")) return SpeedKind::prescribed;
  const int index = joint_index(mechanism, split(address)[1]);
  if (index < 0) return SpeedKind::prescribed;
  const Joint& joint = mechanism.joints[static_cast<std::size_t>(index)];
  for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
    if (drive_speed_address(joint, i) == address) {
      const std::optional<Drive>& drive = joint.coordinates[i].drive;
      if (!drive) break;
      return drive->torque                          ? SpeedKind::guessed
             : drive->keeps == DriveKeeps::momentum ? SpeedKind::drawn
                                                    : SpeedKind::prescribed;
    }
  return SpeedKind::prescribed;
}

std::string number_phrase(const Mechanism& mechanism, const std::string& address) {
  return kind_word(speed_kind(mechanism, address)) + parameter_phrase(address);
}

std::string with_phrase(std::string sentence, const std::string& address) {
  const std::string phrase = parameter_phrase(address);
  const auto goes_on = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = 0; !address.empty() && (at = sentence.find(address, at)) != std::string::npos;) {
    const std::size_t end = at + address.size();
    if (end < sentence.size() && goes_on(sentence[end])) { // of another number
      at = end;
      continue;
    }
    sentence.replace(at, address.size(), phrase);
    at += phrase.size();
  }
  return sentence;
}

double slider_step(double span) {
  return std::pow(10, std::floor(std::log10(span / 200)));
}

double slider_place(const ParameterControl& control, double value) {
  double place = 0;
  if (control.log)
    place = value > 0 ? std::log(value / control.from) / std::log(control.to / control.from) : 0;
  else if (control.to != control.from)
    place = (value - control.from) / (control.to - control.from);
  return std::clamp(place, 0.0, 1.0);
}

double slider_value(const ParameterControl& control, double place, bool fine) {
  place = std::clamp(place, 0.0, 1.0);
  if (place == 0) return control.from;
  if (place == 1) return control.to;
  if (control.log) {
    // Three digits, four for a fine hand.
    const double value = control.from * std::pow(control.to / control.from, place);
    return std::strtod(fmt::format("{:.{}e}", value, fine ? 3 : 2).c_str(), nullptr);
  }
  const double value = control.from + place * (control.to - control.from);
  if (control.step <= 0) return value;
  // Through decimal text, so that 0.3 is 0.3 and not 3 * 0.1.
  const int places = static_cast<int>(std::round(-std::log10(control.step))) + (fine ? 1 : 0);
  if (places <= 0) return std::round(value * std::pow(10, places)) / std::pow(10, places);
  return std::strtod(fmt::format("{:.{}f}", value, places).c_str(), nullptr);
}

} // namespace flyball
