// A question in the middle of the window; what lies behind waits.
#pragma once

#include "app/panels/app.hpp"

namespace flyball {

// Opens the dialog if it was asked for and begins it; where it returns true, end_dialog ends it.
bool begin_dialog(App& app, Dialog which, const char* title, float width);
void end_dialog();
void close_dialog();
// Escape, where no field swallows it.
bool escape_pressed();

} // namespace flyball
