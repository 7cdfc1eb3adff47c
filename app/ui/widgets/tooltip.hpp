// When help over a widget appears: after the pointer has rested on it for a moment.
#pragma once

#include <imgui.h>

#include <limits>

namespace flyball {

// Of one Dear ImGui context, whose io.UserData points to it: help is asked for in places that know no app.
struct TooltipState {
  static constexpr double patience = 0.6; // s

  double clock = 0;  // s of real time, counted by whoever runs the loop
  ImVec2 item{};     // the upper left corner of what is pointed at, in pixels
  double since = 0;  // by the clock
  int frame = -2;    // of ImGui, in which it was last pointed at
  bool done = false; // it has been pressed since: help would lie over what comes of that
  ImGuiID keyed = 0; // the item that the keyboard is at, where that is shown: it counts as pointed at
  // s until help is due; infinite where none is, or it shows already.
  double due = std::numeric_limits<double>::infinity();
};

// Whether the last item, which is pointed at, has been so for long enough, and not pressed. Without a state:
// at once.
bool pointed_long();
// Whether the keyboard is at the last item, and the mouse at none.
bool keyed_item();
// The next window (a tooltip) stands beside the present one, so that what follows in it stays in sight; where
// that is too wide, beside the pointer as usual.
void place_beside_window();

} // namespace flyball
