#include "app/panels/panels.hpp"

#include <numbers>
#include <utility>

namespace flyball {

namespace {

void handle(App& app, const KeyPress& key) {
  constexpr double right_angle = std::numbers::pi / 2;
  if (key.ctrl) {
    switch (key.letter) {
    case 'O': return show_open_dialog(app);
    case 'R': return reload_scene(app);
    case 'E': return show_export_dialog(app);
    case 'Q': app.quit = true; return;
    default: return;
    }
  }
  switch (key.letter) {
  case ' ': return play(app, !app.playback.playing);
  case 'F': app.view.fit = app.view.keep_direction = true; return;
  case 'G': app.view.ghost = !app.view.ghost; return;
  case '1': return look_from(app, 0, 0);
  case '2': return look_from(app, right_angle, 0);
  case '3': return look_from(app, 0, right_angle);
  case '4': return look_from(app, right_angle / 2, isometric_elevation);
  default: return;
  }
}

} // namespace

void handle_shortcuts(App& app) {
  const std::vector<KeyPress> keys = std::exchange(app.keys, {});
  if (ImGui::GetIO().WantTextInput || app.dialog.showing) return;
  for (const KeyPress& key : keys)
    handle(app, key);
}

} // namespace flyball
