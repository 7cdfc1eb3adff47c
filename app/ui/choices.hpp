// What a person chooses for every document; kept from one run of the program to the next.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/settings.hpp"
#include "app/session/units.hpp"
#include "app/viewport/theme.hpp"

namespace flyball {

struct Session;
struct Ui;
struct ViewState;

// Fields, results and plots show their numbers in other units from now on; kept. Whether they are others.
bool choose_units(Session& session, const Ui& ui, const ViewState& view, const DisplayUnits& units);
// The colours of a choice, where the desktop has these.
Theme theme_of(ThemeChoice choice, Theme system);
// The window in these colours from now on; kept.
void choose_theme(const Session& session, Ui& ui, const ViewState& view, ThemeChoice choice);
// What the desktop has, in case it is followed.
void take_system_theme(Ui& ui, Theme theme);
// The interface so many sizes larger, or for 0 of its usual size; kept. Whoever draws the window scales it.
void zoom_interface(const Session& session, Ui& ui, const ViewState& view, int steps);
// Opens or folds the legend of the view; kept.
void open_legend(const Session& session, const Ui& ui, ViewState& view, bool open);
// Shows or hides the ghost, the grid or the shadow; kept.
void toggle_in_view(const Session& session, const Ui& ui, ViewState& view, bool ViewState::*what);
// How the mouse moves the camera from now on; kept.
void choose_navigation(const Session& session, const Ui& ui, ViewState& view, Navigation navigation);

} // namespace flyball
