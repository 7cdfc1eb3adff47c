// How states that rest on dry friction look among the curves of a response: what it holds as drawn, and what
// slips at constant rates.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/continuation/branches.hpp"

namespace flyball {

// Whether something slips at such a point, which rests on friction.
bool slips_on_friction(const ResponsePoint& point);

// A curve without points, for a stretch of such a branch.
PlotCurve friction_curve(bool slips, std::optional<bool> stable);

// What is said beside such a point and near it: "clutch is held by 0.36 of 0.5 N m", "free slips against 0.5
// N m".
std::string friction_note(const ResponsePoint& point);

} // namespace flyball
