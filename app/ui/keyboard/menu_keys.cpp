#include "app/ui/keyboard/menu_keys.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"

#include <algorithm>

namespace flyball {

namespace {

constexpr const char* submenu = "menu/recent";

void open_menu(Ui& ui, int menu) {
  KeyboardState& state = ui.keyboard;
  const auto titles = menu_titles();
  // What had the keys before the first menu has them afterwards.
  if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0) {
    ImGui::ClosePopupToLevel(0, true);
    state.at.clear();
  }
  if (ImGui::GetIO().WantTextInput) ImGui::ClearActiveID();
  state.open_menu = titles[static_cast<std::size_t>(menu)];
  state.menu = menu;
  state.ring = true;
}

} // namespace

bool take_alt(Ui& ui, const DialogState& dialog, const KeyPress& key) {
  KeyboardState& state = ui.keyboard;
  if (dialog.showing) return true;
  const auto titles = menu_titles();
  if (key.key == keys::alt) {
    if (state.menu >= 0)
      ImGui::ClosePopupToLevel(0, true);
    else
      open_menu(ui, 0);
    return true;
  }
  const auto found =
      std::ranges::find_if(titles, [&](const char* title) { return title[0] == static_cast<char>(key.key); });
  if (found != titles.end()) open_menu(ui, static_cast<int>(found - titles.begin()));
  return true;
}

bool take_menu_arrow(Ui& ui, const KeyStop* stop, const KeyPress& key) {
  const KeyboardState& state = ui.keyboard;
  if (state.menu < 0 || (key.key != keys::left && key.key != keys::right)) return false;
  const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (key.key == keys::left && open > 1) {
    ImGui::ClosePopupToLevel(open - 1, true);
    return true;
  }
  if (key.key == keys::right && stop && stop->name == submenu) {
    imgui_compat::press_item(stop->id, false);
    return true;
  }
  const int count = static_cast<int>(std::ssize(menu_titles()));
  open_menu(ui, (state.menu + (key.key == keys::right ? 1 : count - 1)) % count);
  return true;
}

} // namespace flyball
