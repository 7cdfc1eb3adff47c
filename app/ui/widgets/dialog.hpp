// A question in the middle of the window; what lies behind waits.
#pragma once

#include "app/ui/dialog_state.hpp"

#include <span>

namespace flyball {

struct Ui;

// Opens the dialog if it was asked for and begins it; where it returns true, end_dialog ends it.
bool begin_dialog(Ui& ui, DialogState& dialog, Dialog which, const char* title, float width);
void end_dialog();
void close_dialog();
// Escape, where no field swallows it.
bool escape_pressed();
// Enter, where no field swallows it and no widget that has the keys is pressed by it; not the one that
// brought the dialog.
bool enter_pressed(const Ui& ui);

struct Choice {
  const char* name; // for the widget map
  const char* text;
};
// A row of buttons of which `marked` is the one that Enter means, at first the first; the arrow keys and Tab
// go to another. Returns the one pressed, or -1.
int choice_buttons(Ui& ui, std::span<const Choice> choices, int& marked);

} // namespace flyball
