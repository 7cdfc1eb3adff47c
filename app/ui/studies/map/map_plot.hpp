// The map as a plot: colours, hatching where it is unstable, the curves in it and the present place.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/study_views.hpp"

namespace flyball {

// Makes the plot where something of it has changed.
void draw_map(const Session& session, MapView& drawn);

} // namespace flyball
