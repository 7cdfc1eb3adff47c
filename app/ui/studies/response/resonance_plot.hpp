// The response where drives make the balance turn: mean and band of periodic motions over the number.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/study_views.hpp"

namespace flyball {

// The plot of what was found so far, made anew where it has grown; the marker is the motion that is shown.
void draw_resonance(const Session& session, ResponseView& drawn);
// The number under a hit on the plot's curves becomes the present one, with the digits that a pixel tells.
void go_to_resonance(Session& session, const ResponseView& drawn, const PlotHit& hit);

} // namespace flyball
