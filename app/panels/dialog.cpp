#include "app/panels/dialog.hpp"

#include "app/panels/widgets.hpp"

#include <algorithm>

namespace flyball {

bool begin_dialog(App& app, Dialog which, const char* title, float width) {
  const float s = app.scale;
  if (app.dialog.wanted == which) {
    ImGui::OpenPopup(title);
    app.dialog.wanted = Dialog::none;
  }
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(width * s, window.x - 20 * s), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {18 * s, 16 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, ImGui::GetStyle().PopupBorderSize);
  const bool begun =
      ImGui::BeginPopupModal(title, nullptr,
                             ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PopStyleVar(3);
  if (!begun) return false;
  app.dialog.showing = true;
  heading(app, title);
  return true;
}

void end_dialog() {
  ImGui::EndPopup();
}

void close_dialog() {
  ImGui::CloseCurrentPopup();
}

bool escape_pressed() {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
}

} // namespace flyball
