// Follows, draws and uses the response curve. No widgets.
#pragma once

#include "app/session/response_quantity.hpp"
#include "app/ui/app.hpp"

namespace flyball {

// Takes what was computed and asks for what is wanted now; nothing unless the panel is open.
void update_response(App& app);
// Everything of it goes but what was chosen.
void close_response(App& app);
bool computing_response(const App& app);

// The parameter that is varied, with the range of its slider.
void choose_response(App& app, const std::string& address);
// The control of the varied parameter; null: there is none.
const ParameterControl* response_control(const App& app);
// Why there is no curve, a sentence; empty where there is one.
std::string response_refusal(const App& app);

// What is drawn over the parameter.
void choose_quantity(App& app, const ResponseQuantity& quantity);
// What there is to choose from: of the present answer, or else of the curve.
std::vector<ResponseQuantity> offered_quantities(const App& app);

// The plot of result, quantity and design, made anew where one of them has changed; the marker is the
// present answer.
void draw_response(App& app);

// The state at a hit on the plot's curves becomes the present one, along with the parameter. `dragged`: every
// frame anew, while the hand holds the marker.
void go_to_response(App& app, const PlotHit& hit, bool dragged);

// Looks for the parameter at which the design's coordinate has its value; the solution then becomes present.
void find_design(App& app);
void go_to_design(App& app, const DesignSolution& solution);

// A diagram's branches with their special points in their places. Takes them out of it.
std::vector<ResponseLine> response_lines(ResponseDiagram& diagram);

// Curves of one quantity over the parameter: stable solid, unstable dashed, undecided dotted.
// In SI units; `units` are for labels.
Plot response_plot(const ResponseResult& result, const ResponseQuantity& quantity, const DisplayUnits& units,
                   std::vector<ResponsePiece>& pieces);

} // namespace flyball
