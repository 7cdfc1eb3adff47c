#include "app/panels/keys.hpp"
#include "app/panels/panels.hpp"

#include <numbers>

namespace flyball {

void handle_shortcuts(App& app) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || app.dialog.showing) return;
  if (io.KeyCtrl) {
    if (letter_pressed('O')) show_open_dialog(app);
    if (letter_pressed('R')) reload_scene(app);
    if (letter_pressed('E')) show_export_dialog(app);
    if (letter_pressed('Q')) app.quit = true;
    return;
  }
  constexpr double right_angle = std::numbers::pi / 2;
  if (letter_pressed(' ')) play(app, !app.playback.playing);
  if (letter_pressed('F')) app.view.fit = app.view.keep_direction = true;
  if (letter_pressed('G')) app.view.ghost = !app.view.ghost;
  if (letter_pressed('1')) look_from(app, 0, 0);
  if (letter_pressed('2')) look_from(app, right_angle, 0);
  if (letter_pressed('3')) look_from(app, 0, right_angle);
  if (letter_pressed('4')) look_from(app, right_angle / 2, 0.6154797086703873);
}

} // namespace flyball
