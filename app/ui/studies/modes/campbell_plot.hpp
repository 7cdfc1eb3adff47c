// The Campbell diagram as a plot.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/study_views.hpp"

#include <string>

namespace flyball {

// Makes the plot where something of it has changed.
void draw_campbell(const Session& session, CampbellView& drawn);
// Why there is no diagram, with the number and its value as they are shown; empty where there is one.
std::string campbell_problem(const Session& session);

} // namespace flyball
