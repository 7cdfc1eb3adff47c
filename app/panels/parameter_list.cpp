#include "app/panels/parameter_list.hpp"

#include "engine/mechanism/address.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace flyball {

namespace {

std::vector<std::string> split(const std::string& address) {
  std::vector<std::string> parts(1);
  for (const char c : address) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

ParameterGroup group_of(const std::vector<std::string>& parts) {
  if (parts.back() == "speed") return ParameterGroup::drives;
  return parts.back() == "stiffness" ? ParameterGroup::springs : ParameterGroup::others;
}

// 1, 2 or 5 times a power of ten, not below the value.
double round_up(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double m : {1.0, 2.0, 5.0})
    if (value <= m * power * (1 + 1e-12)) return m * power;
  return 10 * power;
}

double power_of_ten(double value) {
  return std::pow(10, std::round(std::log10(value)));
}

void choose_range(ParameterControl& control) {
  const double value = control.file_value, size = std::abs(value);
  if (control.group == ParameterGroup::springs && value > 0) {
    control.log = true;
    control.from = power_of_ten(value / 100);
    control.to = power_of_ten(value * 100);
  } else if (size == 0) {
    control.from = control.group == ParameterGroup::drives ? -20 : 0;
    control.to = control.group == ParameterGroup::drives ? 20 : 1000;
  } else {
    control.from = value < 0 ? -round_up(2 * size) : 0;
    control.to = value < 0 ? 0 : round_up(2 * size);
  }
}

// "drive.0.speed" of a joint with several coordinates becomes "speed 0".
std::string what_of(const std::vector<std::string>& parts) {
  if (parts.front() == "gravity")
    return parts.size() > 1 ? std::string(1, "xyz"[std::atoi(parts[1].c_str()) % 3]) : "";
  std::string words = parts.back();
  const bool plain = parts.back() == "speed" || parts.back() == "stiffness";
  for (std::size_t i = 2; i + 1 < parts.size(); ++i) {
    const bool index = parts[i].find_first_not_of("0123456789") == std::string::npos;
    if (index)
      words += " " + parts[i];
    else if (!plain || (parts[i] != "drive" && parts[i] != "spring"))
      words = parts[i] + " " + words;
  }
  std::ranges::replace(words, '_', ' ');
  return words;
}

ParameterControl control_of(const Mechanism& mechanism, const std::string& address) {
  ParameterControl control;
  const std::vector<std::string> parts = split(address);
  control.address = address;
  control.group = group_of(parts);
  control.name = parts.size() > 2 ? parts[1] : parts[0];
  control.what = what_of(parts);
  control.unit = parameter_unit(mechanism, address);
  control.file_value = get_parameter(mechanism, address);
  return control;
}

bool wanted(const std::string& address) {
  return address.ends_with(".speed") ||
         (address.ends_with(".stiffness") && address.find(".stop.") == std::string::npos);
}

} // namespace

std::vector<ParameterControl> parameter_controls(const Mechanism& mechanism) {
  std::vector<ParameterControl> controls;
  const auto listed = [&](const std::string& address) {
    return std::ranges::any_of(controls, [&](const ParameterControl& c) { return c.address == address; });
  };
  for (const Slider& slider : mechanism.sliders) {
    if (listed(slider.parameter)) continue;
    ParameterControl& control = controls.emplace_back(control_of(mechanism, slider.parameter));
    control.from = slider.from;
    control.to = slider.to;
    control.log = slider.scale == SliderScale::log;
  }
  for (const std::string& address : parameter_addresses(mechanism)) {
    if (!wanted(address) || listed(address)) continue;
    choose_range(controls.emplace_back(control_of(mechanism, address)));
  }
  for (ParameterControl& control : controls) {
    const double span = std::abs(control.to - control.from);
    if (!control.log && span > 0) control.step = std::pow(10, std::floor(std::log10(span / 200)));
  }
  std::ranges::stable_sort(controls, {}, &ParameterControl::group);
  return controls;
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
