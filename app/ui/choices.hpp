// What a person chooses for every document; kept from one run of the program to the next.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/settings.hpp"
#include "app/session/units.hpp"
#include "app/viewport/theme.hpp"

namespace flyball {

struct App;

// Fields, results and plots show their numbers in other units from now on; kept.
void choose_units(App& app, const DisplayUnits& units);
// The colours of a choice, where the desktop has these.
Theme theme_of(ThemeChoice choice, Theme system);
// The window in these colours from now on; kept.
void choose_theme(App& app, ThemeChoice choice);
// What the desktop has, in case it is followed.
void take_system_theme(App& app, Theme theme);
// Opens or folds the legend of the view; kept.
void open_legend(App& app, bool open);

// How the mouse moves the camera from now on; kept.
void choose_navigation(App& app, Navigation navigation);

} // namespace flyball
