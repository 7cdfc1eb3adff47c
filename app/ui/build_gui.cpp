#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/key_focus.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/palette_actions.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/widgets/typed_field.hpp"

namespace flyball {

namespace {

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

namespace {

// The panels round the view, those that there is room for.
void draw_panels(App& app, const Layout& layout) {
  Panels& panels = *app.panels;
  if (layout.outline.width > 0)
    panels.outline.draw(app.session, app.ui, app.view, app.commands, layout.outline);
  if (layout.parameters.width > 0) {
    const float height = panels.parameters.draw(app.session, app.ui, layout.parameters);
    if (height > 0) app.sizes.parameters_height = height;
  }
  if (layout.inspector.width > 0)
    panels.inspector.draw(app.session, app.ui, app.tool, app.commands, layout.inspector);
  if (layout.results.width > 0)
    panels.results.draw(app.session, app.ui, app.tool, layout.results, layout.inspector.height > 0);
  if (layout.study.width > 0) panels.studies.draw(app.session, app.ui, app.commands, layout.study);
  toolbar_panel(app.session, app.ui, app.view, app.commands, layout.toolbar);
  panels.history.draw(app.session, app.ui, layout.view);
  messages_panel(app.ui, app.notice_log, layout.view);
  panels.tutorial.draw(app.ui, layout.view);
}

// Before anything is drawn: each key goes to the first that has a use for it.
void take_keys(App& app) {
  Panels& panels = *app.panels;
  const bool palette = panels.palette.showing();
  const bool taken = palette || panels.shortcuts.open;
  take_keyboard(app.ui, app.dialog, app.commands, taken || app.tool.grab.has_value());
  app.ui.widgets.clear();
  notice_key_focus(app.ui);
  give_keys_to_popups(app.ui, app.dialog, panels.shortcuts.open, palette);
  if (!app.dialog.showing && !palette) take_tool_keys(app.session, app.ui, app.tool);
  if (!app.dialog.showing && !palette && !panels.shortcuts.open) take_view_keys(app.context());
  handle_shortcuts(app);
}

} // namespace

void build_gui(App& app) {
  Panels& panels = *app.panels;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  notice_gestures(app.session, app.ui);
  take_keys(app);
  const Layout layout = layout_of(app, size.x, size.y);
  if (app.view.alone) return panels.viewport.draw_alone(app.context(), layout.view);
  // ImGui puts windows that never come to the front behind those it has: the first is the topmost.
  drag_splitters(app.session, app.ui, app.sizes, layout);
  if (!panels.tutorial.open) // which says the same at more length
    welcome(app.session, app.ui, app.tool, app.dialog, app.commands, layout.view);
  panels.viewport.draw(app.context(), app.dialog, app.notice_age, app.notice_log, app.commands, layout.view);
  if (layout.beside.width > 0) panels.viewport.draw_beside(app.context(), layout.beside);
  file_banner(app.session, app.ui, app.dialog, app.report, app.commands, layout.view);
  draw_panels(app, layout);
  app.dialog.showing = false;
  show_dialogs(app);
  panels.shortcuts.draw(app.ui, app.view.navigation);
  if (const auto entry = panels.palette.draw(app.session, app.ui, app.commands))
    use_palette_entry(app, *entry);
  settle_fields(app.session, app.ui);
  begin_picking(app.session, app.ui, app.tool);
  settle_keyboard(app.ui);
}

} // namespace flyball
