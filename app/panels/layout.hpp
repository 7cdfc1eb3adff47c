// Where the panels are. Fixed places with splitters between them; in a narrow window the two side panels
// stand one above the other.
#pragma once

#include "app/panels/app.hpp"

namespace flyball {

struct PanelRect {
  float x = 0, y = 0, width = 0, height = 0; // pixels
};

struct Layout {
  PanelRect toolbar, parameters, results, view;
  bool stacked = false;
};

Layout layout_of(const App& app, float width, float height);

// Draws the lines between panels and moves them; before the panels. `height` is that of the window.
void drag_splitters(App& app, const Layout& layout, float height);
// Begins the window of a panel without frame or title; ImGui::End ends it.
void begin_panel(const char* name, const PanelRect& rect, int more_flags = 0);

} // namespace flyball
