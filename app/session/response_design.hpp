// "Find the number so that the coordinate is this": what can be wanted, asking for it, and what came of it.
#pragma once

#include "app/session/response.hpp"

#include <string>

namespace flyball {

// What can be wanted, of the steady state or of the drawn pose where there is none: coordinates, speeds that
// are found and measures, then what drives give and joints bear. Made once for each answer and mechanism.
const DesignGoals& design_goals(Session& session);

// Looks for the parameter at which the design's goal has its value.
void find_design(Session& session);
// Takes what was found.
void take_design(Session& session);
// What became of it, in the units that are shown; empty where nothing was asked.
std::string design_words(const Session& session);
// The solution becomes present.
void go_to_design(Session& session, const DesignSolution& solution);

} // namespace flyball
