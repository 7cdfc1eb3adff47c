// Finds the modes of the state that is shown, moves one of them. No drawing.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// Takes what was found; asks for what is missing while the study is open.
void update_modes(App& app);
void find_modes_again(App& app);
// Everything goes but how the Campbell diagram is wanted.
void close_modes(App& app);
// Whether modes or the diagram are being computed.
bool finding_modes(const App& app);
// Whether the modes are those of the state that is shown.
bool modes_are_current(const App& app);

// Moves the mode, or none, in the view.
void choose_mode(App& app, std::optional<std::size_t> mode);
// The mode that moves in the view; null: none.
const VibrationMode* moving_mode(const App& app);
// Its motion goes on by `seconds` on the screen.
void advance_mode(App& app, double seconds);
// s, of one swing on the screen; what does not swing sways.
double shown_period(const VibrationMode& mode);
// How many times slower than it is the mode is shown; below one: faster. Nothing where it does not swing.
std::optional<double> shown_slower(const VibrationMode& mode);
// Whether disturbances of its shape grow.
bool grows(const VibrationMode& mode);

} // namespace flyball
