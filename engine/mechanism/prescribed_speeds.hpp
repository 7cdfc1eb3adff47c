// The speeds that drives prescribe, and the numbers that set them.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct PrescribedSpeed {
  std::string joint;
  std::string address; // of the drive's own number, as drive_speed_address() has it
  double value = 0;    // rad/s, of a slide m/s
  bool angle = false;  // rad/s rather than m/s
};

// In the scene's order; none of drives whose speed is found (finds_speed()).
std::vector<PrescribedSpeed> prescribed_speeds(const Mechanism& mechanism);

// The number by itself that a number is: its own address, or that of the named parameter that alone is its
// expression, perhaps by way of other parameters. Empty where an expression makes something else of numbers.
std::string number_alone(const Mechanism& mechanism, std::string_view address);

// Whether a number by itself sets the speed of a drive that prescribes it, alone or in an expression.
bool sets_speed(const Mechanism& mechanism, std::string_view address);

} // namespace flyball
