// The drives that turn, with the period that they have in common, or why they have none.
#pragma once

#include "engine/dynamics/motion_model.hpp"

#include <string>
#include <vector>

namespace flyball {

struct DrivePeriod {
  std::vector<double> speeds; // rad/s
  std::vector<std::string> names;
  double period = 0, fastest = 0; // s; rad/s
  std::string trouble;            // a sentence

  // Of these speeds.
  void find_common();
};

DrivePeriod drive_period(const MotionModel& model);

} // namespace flyball
