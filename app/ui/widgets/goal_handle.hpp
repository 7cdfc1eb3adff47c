// A read-out by which the steady state is told where to go: dragged sideways, or typed over after a double
// click or Enter. The pinned sliders that are not held follow (see session/goals.hpp).
#pragma once

#include <string>

namespace flyball {

struct Session;
struct Ui;

struct GoalHandle {
  std::string name;   // of the widget
  std::string wanted; // a free coordinate, or a measure; see Goal
  double value = 0;   // in SI units
  std::string unit;   // SI
  std::string help{}; // told first
};

// Over the last item, which shows the number.
void goal_handle(Session& session, Ui& ui, const GoalHandle& handle);

} // namespace flyball
