#include "app/ui/widgets/dialog.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>

namespace flyball {

namespace {

// A key that brought the dialog answers nothing in it.
bool key_pressed(ImGuiKey key) {
  return !ImGui::IsWindowAppearing() && imgui_compat::key_pressed(key, false);
}

} // namespace

bool begin_dialog(Ui& ui, DialogState& dialog, Dialog which, const char* title, float width) {
  const float s = ui.scale;
  if (dialog.wanted == which) {
    ImGui::OpenPopup(title);
    dialog.wanted = Dialog::none;
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
  dialog.showing = true;
  heading(ui, title);
  return true;
}

void end_dialog() {
  ImGui::EndPopup();
}

void close_dialog() {
  ImGui::CloseCurrentPopup();
}

bool escape_pressed() {
  return key_pressed(ImGuiKey_Escape);
}

bool enter_pressed(const Ui& ui) {
  if (enter_is_taken(ui)) return false;
  return key_pressed(ImGuiKey_Enter) || key_pressed(imgui_compat::keypad_enter);
}

int choice_buttons(Ui& ui, std::span<const Choice> choices, int& marked) {
  const int count = static_cast<int>(choices.size());
  if (ImGui::IsWindowAppearing()) {
    marked = 0;
    enter_dialog_at(ui, choices[0].name);
  }
  for (int i = 0; i < count; ++i)
    if (has_keyboard(ui, choices[static_cast<std::size_t>(i)].name)) marked = i;
  int pressed = enter_pressed(ui) ? marked : -1;
  ImGui::Dummy({0, 4 * ui.scale});
  for (int i = 0; i < count; ++i) {
    const Choice& choice = choices[static_cast<std::size_t>(i)];
    if (i > 0) ImGui::SameLine();
    if (text_button(ui, choice.name, choice.text, i == marked)) pressed = i;
  }
  return pressed;
}

} // namespace flyball
