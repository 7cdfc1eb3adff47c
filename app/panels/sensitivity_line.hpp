// How the steady state moves with a pinned number, from the implicit function theorem: a line below its
// slider.
#pragma once

#include "app/panels/app.hpp"

namespace flyball {

// One coordinate's rate with the number, as it is shown.
struct ShownRate {
  std::string name; // of the coordinate
  double value = 0; // in `unit`
  std::string unit; // "mm/(rad/s)"
  double share = 0; // of the mechanism's reach or of a radian: to tell which moves most
};

// By how much they move, the most first. Empty without a steady state, at a singular one, and for what is no
// slider.
std::vector<ShownRate> shown_rates(const App& app, const std::string& address);

// Pixels; the same whether or not there is anything to tell, so that nothing jumps.
float sensitivity_height(const App& app);
void sensitivity_line(App& app, const ParameterControl& control);

} // namespace flyball
