// A steady state in words.
#pragma once

#include "app/ui/widgets/ui_style.hpp"
#include "engine/solve/solution.hpp"

#include <optional>
#include <string>
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

// Whether two lists of coordinates are one state but for rounding: whole turns, and joints in which nothing
// resists, do not count.
bool same_state(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b,
                const std::vector<std::string>& neutral = {});

} // namespace flyball
