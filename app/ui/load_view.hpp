// When and of what the view shows loads as arrows.
#pragma once

#include "app/viewport/view_scene.hpp"

#include <string>

namespace flyball {

struct App;

// Asks for the arrows in a frame of the steady state, where they are wanted and known: of the one body that
// is selected its free-body diagram, else those of the whole mechanism.
void show_loads(const App& app, ViewFrame& frame);
// Why there are none though they are wanted, in words; empty where there are.
std::string loads_missing(const App& app);

} // namespace flyball
