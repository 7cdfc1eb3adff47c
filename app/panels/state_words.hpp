// A steady state in words, and its coordinates by name, in the units of the screen.
#pragma once

#include "app/panels/ui_style.hpp"
#include "engine/equilibrium/solution.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct StabilityWords {
  const char* icon;
  const char* word;     // "stable"
  const char* sentence; // why; empty where nothing is known
  ImVec4 color;
};
StabilityWords stability_words(std::optional<bool> stable, std::optional<StabilityReason> reason,
                               const UiColors& colors);
// "A minimum of the amended potential."
const char* reason_text(StabilityReason reason);

// "theta", or "ball.2" of a joint that has several.
std::string coordinate_label(const CoordinateSolution& c);
// On the screen: ° or mm, and what SI values are multiplied by.
const char* screen_unit(bool angle);
double screen_factor(bool angle);

// The free coordinates by label, to start solving from: rad, m.
std::vector<std::pair<std::string, double>> start_values(const std::vector<CoordinateSolution>& coordinates);
// Whether two lists of coordinates are one state but for rounding: whole turns, and joints in which nothing
// resists, do not count.
bool same_state(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b,
                const std::vector<std::string>& neutral = {});

} // namespace flyball
