// What a person chooses for every document; kept from one run of the program to the next.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/units.hpp"

namespace flyball {

struct App;

// Fields, results and plots show their numbers in other units from now on; kept.
void choose_units(App& app, const DisplayUnits& units);
// Opens or folds the legend of the view; kept.
void open_legend(App& app, bool open);

// How the mouse moves the camera from now on; kept.
void choose_navigation(App& app, Navigation navigation);

} // namespace flyball
