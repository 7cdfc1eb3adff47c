// Where the panels are. Fixed places with splitters between them. While building there are the outline and
// the inspector, while exploring the sliders and the results; a wide window also has the results below the
// inspector. Below all of them there may be a study.
#pragma once

namespace flyball {

struct Session;
struct Ui;

struct PanelRect {
  float x = 0, y = 0, width = 0, height = 0; // pixels
  bool operator==(const PanelRect&) const = default;
};

struct Layout {
  PanelRect toolbar, view, beside; // beside: a second view, of the motion
  PanelRect study;
  PanelRect outline, parameters, inspector, results; // of width 0 where not shown
  PanelRect side;                                    // the right column, of one panel or two
  bool stacked = false;
};

// How the panels stand, in points, so that it means the same on every display.
struct PanelSizes {
  float parameters_width = 290, results_width = 345, stacked_width = 330;
  // Of the height, for the parameters above the results; 0 until the person chooses: as much as they need.
  float stacked_share = 0;
  float parameters_height = 0; // what they needed in the last frame
  float inspector_share =
      0.55f;                 // of the height, for the inspector above the results, or the outline above it
  float study_share = 0.42f; // of the height, for the studies below the view
  bool study_chosen = false; // by the person; until then a study in a low window takes more
};

Layout layout_of(const Session& session, const Ui& ui, const PanelSizes& sizes, float width, float height);
// The view without anything round it.
Layout view_alone_layout(float width, float height);

// Draws the lines between panels and moves them; before the panels.
void drag_splitters(Session& session, Ui& ui, PanelSizes& sizes, const Layout& layout);
// Pixels of the title of results below an inspector, which is a grip of the line between them.
float results_title_height(const Ui& ui);
// Begins the window of a panel without frame or title; ImGui::End ends it.
void begin_panel(const char* name, const PanelRect& rect, int more_flags = 0);

} // namespace flyball
