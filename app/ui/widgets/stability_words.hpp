// A verdict on stability as it is shown: an icon, a word, a sentence and a colour.
#pragma once

#include "app/ui/widgets/ui_style.hpp"
#include "engine/solve/solution.hpp"

#include <optional>

namespace flyball {

struct StabilityWords {
  const char* icon;
  const char* word;     // "stable"
  const char* sentence; // why; empty where nothing is known
  ImVec4 color;
};
StabilityWords stability_words(std::optional<bool> stable, std::optional<StabilityReason> reason,
                               const UiColors& colors);

// What everything linear about a state of joints with dry friction leaves out.
inline constexpr const char* friction_left_out =
    "Of the motion once it slips. Dry friction's hold is left out: within its band a disturbance stays.";

} // namespace flyball
