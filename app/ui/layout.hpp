// Where the panels are. Fixed places with splitters between them. While building there are the outline and
// the inspector, while exploring the sliders and the results; a wide window also has the results below the
// inspector. Below all of them there may be a study.
#pragma once

namespace flyball {

struct App;
struct PanelState;
struct Session;
struct Ui;

struct PanelRect {
  float x = 0, y = 0, width = 0, height = 0; // pixels
};

struct Layout {
  PanelRect toolbar, view, beside; // beside: a second view, of the motion
  PanelRect study;
  PanelRect outline, parameters, inspector, results; // of width 0 where not shown
  PanelRect side;                                    // the right column, of one panel or two
  bool stacked = false;
};

Layout layout_of(const App& app, float width, float height);

// Draws the lines between panels and moves them; before the panels.
void drag_splitters(Session& session, Ui& ui, PanelState& panels, const Layout& layout);
// Begins the window of a panel without frame or title; ImGui::End ends it.
void begin_panel(const char* name, const PanelRect& rect, int more_flags = 0);

} // namespace flyball
