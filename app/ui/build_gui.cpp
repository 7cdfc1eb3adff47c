#include "app/ui/app.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/key_focus.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/plots/plot_save.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/widgets/typed_field.hpp"

namespace flyball {

namespace {

using Panel = void (*)(App&, const PanelRect&);

void show(App& app, Panel panel, const PanelRect& rect) {
  if (rect.width > 0) panel(app, rect);
}

// A new movement of the hand begins: what it changes is one step.
void notice_gestures(Session& session, Ui& ui) {
  bool pressed = !ui.keys.empty() && !goes_on_nudging(ui);
  for (int button = 0; button < 3; ++button)
    pressed = pressed || ImGui::IsMouseClicked(button);
  if (pressed) ++session.gesture;
  // A slider that is not drawn any more waits for no second click.
  if (SliderPress& press = ui.slider_press; press.place && ImGui::GetTime() - *press.since > 1) press = {};
}

} // namespace

void build_gui(App& app) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  notice_gestures(app.session, app.ui);
  take_keyboard(app);
  app.ui.widgets.clear();
  notice_key_focus(app.ui);
  give_keys_to_popups(app.ui, app.commands, app.dialog);
  take_tool_keys(app);
  take_view_keys(app);
  handle_shortcuts(app);
  const Layout layout = layout_of(app, size.x, size.y);
  if (app.view.alone) return view_alone(app, layout.view);
  // ImGui puts windows that never come to the front behind those it has: the first is the topmost.
  drag_splitters(app.session, app.ui, app.panels, layout);
  welcome(app, layout.view);
  viewport_panel(app, layout.view);
  show(app, beside_panel, layout.beside);
  file_banner(app, layout.view);
  show(app, outline_panel, layout.outline);
  show(app, parameters_panel, layout.parameters);
  show(app, inspector_panel, layout.inspector);
  show(app, results_panel, layout.results);
  show(app, study_panel, layout.study);
  toolbar_panel(app, layout.toolbar);
  if (app.inspector.history) history_panel(app);
  if (app.notice_log.showing) messages_panel(app);
  app.dialog.showing = false;
  open_dialog(app);
  save_dialog(app);
  gallery_dialog(app);
  export_dialog(app);
  report_dialog(app);
  model_dialog(app);
  movie_dialog(app);
  plot_dialog(app);
  mirror_dialog(app);
  circular_dialog(app);
  recovery_dialog(app);
  unsaved_dialog(app);
  shortcut_sheet(app);
  command_palette(app);
  settle_fields(app.session, app.ui);
  begin_picking(app);
  settle_keyboard(app.ui);
}

} // namespace flyball
