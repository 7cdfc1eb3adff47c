// From branches to curves: what is stable, what is not, and where that changes.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/study_views.hpp"

namespace flyball {

// Curves of one quantity over the parameter: stable solid, unstable dashed, undecided dotted.
// In SI units; `units` are for labels.
Plot response_plot(const ResponseCurve::Found& found, const ResponseQuantity& quantity,
                   const DisplayUnits& units, std::vector<ResponsePiece>& pieces);
// The plot of result, quantity and design, made anew where one of them has changed; the marker is the
// present answer.
void draw_response(const Session& session, ResponseView& drawn);
// The state at a hit on the plot's curves becomes the present one: see go_to_response().
void go_to_hit(Session& session, const ResponseView& drawn, const PlotHit& hit, bool dragged);

} // namespace flyball
