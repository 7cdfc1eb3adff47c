// What is written over the 3-D view.
#pragma once

#include "app/ui/layout.hpp"

namespace flyball {

struct App;
struct DialogState;
struct Session;
struct Ui;
struct ViewState;

// In the view's window:
void caption(const Session& session, Ui& ui,
             const PanelRect& rect); // what the picture shows, in its upper left corner
void motion_caption(const Session& session, const Ui& ui, const PanelRect& rect); // of the view beside it
void view_lines(App& app, const PanelRect& rect); // what to do next with the tool, and what was last done
// Windows of their own:
void part_label(App& app); // "arm1", and what it is, beside the cursor
void error_line(Session& session, Ui& ui, ViewState& view,
                const PanelRect& rect); // a notice of what went wrong, until it is put away
void explored_chip(Session& session, Ui& ui, DialogState& dialog,
                   const PanelRect& rect);            // what is tried and not stored: keep it, or go back
void problem_banner(App& app, const PanelRect& rect); // a scene that cannot be read

} // namespace flyball
