// The Campbell diagram as a plot.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/study_views.hpp"

namespace flyball {

// Makes the plot where something of it has changed.
void draw_campbell(const Session& session, CampbellView& drawn);

} // namespace flyball
