// Which numbers of a mechanism get a slider: those the scene asks for, every drive's speed and every
// spring's stiffness.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <vector>

namespace flyball {

enum class ParameterGroup { drives, springs, others };

struct ParameterControl {
  std::string address;
  ParameterGroup group = ParameterGroup::others;
  std::string name; // of the joint, body or force
  std::string what; // "speed", "stiffness", ...: what of it
  std::string unit; // "rad/s", "N/m", ...
  double from = 0, to = 1;
  bool log = false;
  double file_value = 0; // as read from the file
  double step = 0;       // values a slider stops at: multiples of it; 0 for log
};

// In groups; within a group the scene's own sliders first.
std::vector<ParameterControl> parameter_controls(const Mechanism& mechanism);

// The control's place on a slider from 0 to 1, and back to a value rounded to what a hand can set.
double slider_place(const ParameterControl& control, double value);
double slider_value(const ParameterControl& control, double place, bool fine);

} // namespace flyball
