// What the hand does at a slider.
#pragma once

#include <optional>
#include <string>

namespace flyball {

// The button on a slider: a click moves the knob only once it is known not to be the first of two, which
// type.
struct SliderPress {
  std::string name;                       // of the slider
  float from = 0;                         // pixel of the window where the button went down
  float grip = 0;                         // pixels from the knob's middle, where it was taken by the knob
  bool on_knob = false, dragging = false; // dragging: the hand has moved, and the knob follows
  bool typing = false;                    // it asked for typing; nothing moves any more
  std::optional<double> place{}, since{}; // of a click beside the knob: share of the track; s of ImGui's
};

} // namespace flyball
