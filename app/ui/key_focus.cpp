#include "app/ui/key_focus.hpp"

#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/keyboard/focus_order.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <string_view>

namespace flyball {

namespace {

// The window under the pointer, that of which it is a part; empty where there is none.
std::string_view window_under_pointer() {
  const ImGuiWindow* window = ImGui::GetCurrentContext()->HoveredWindow;
  return window ? window->RootWindow->Name : std::string_view();
}

bool is_popup_under_pointer() {
  const ImGuiWindow* window = ImGui::GetCurrentContext()->HoveredWindow;
  return window && (window->RootWindow->Flags & ImGuiWindowFlags_Popup) != 0;
}

bool pointer_in_view() {
  const std::string_view name = window_under_pointer();
  return name == "view" || name == "beside";
}

// Fields of numbers and words, as opposed to lists of parts, where Delete and the clipboard mean the parts.
bool holds_fields(std::string_view window) {
  return window == "inspector" || window == "parameters";
}
// Tables and plots with a field here and there: a letter begins nothing that could be typed there, a digit
// does.
bool holds_plots(std::string_view window) {
  return window == "results" || window == "study";
}

bool is_printable(int key) {
  return key >= ' ' && key < 127;
}
bool is_letter(int key) {
  return key >= 'A' && key <= 'Z';
}

// What edits the text of a field: it must not edit the mechanism instead.
bool edits_text(const KeyPress& key) {
  if (key.ctrl) return key.key == 'A' || key.key == 'X' || key.key == 'V';
  return key.key == keys::del || key.key == keys::backspace;
}

bool was_clicked(const KeyboardState& keyboard, KeyUse use) {
  const KeyStop* stop = stop_named(keyboard.stops, keyboard.at);
  return stop && stop->use == use;
}

// A button is done with by the click, too; `keyboard.at` says nothing of it.
bool button_clicked(const KeyboardState& keyboard) {
  const ImGuiWindow* window = ImGui::GetCurrentContext()->HoveredWindow;
  const ImVec2 at = ImGui::GetIO().MousePos;
  return std::ranges::any_of(keyboard.stops, [&](const KeyStop& stop) {
    return is_pressed(stop.use) && stop.window == window && at.x >= stop.from.x && at.x < stop.to.x &&
           at.y >= stop.from.y && at.y < stop.to.y;
  });
}

} // namespace

void notice_key_focus(Ui& ui) {
  KeyFocus& focus = ui.keyboard.focus;
  if (!ui.fields.typing.name.empty()) focus = {.in_panel = true, .among_fields = true};
  bool clicked = false;
  for (int button = 0; button < 3; ++button)
    clicked = clicked || ImGui::IsMouseClicked(button);
  // A list or menu belongs to whatever opened it.
  if (!clicked || is_popup_under_pointer()) return;
  const std::string_view window = window_under_pointer();
  if (button_clicked(ui.keyboard))
    focus = {};
  else if (holds_plots(window) || was_clicked(ui.keyboard, KeyUse::slide)) // a number begins with a digit
    focus = {.in_panel = true, .among_fields = true, .letters = true};
  else if (holds_fields(window))
    focus = {.in_panel = true, .among_fields = true};
  else // nothing is typed in a row: what it stands for is chosen, and keys are commands for that
    focus = {.in_panel =
                 (window == "outline" || window == "History") && !was_clicked(ui.keyboard, KeyUse::row)};
}

bool may_command(Session& session, Ui& ui, const KeyPress& key) {
  KeyFocus& focus = ui.keyboard.focus;
  // With the keyboard at a widget its number begins with a digit, and letters stay commands.
  if (!focus.in_panel || ui.keyboard.ring) return true;
  bool typed = false;
  if (key.ctrl) {
    typed = focus.among_fields && edits_text(key);
  } else if (is_letter(key.key) || key.key == ' ') {
    // "150 rpm" is no word of commands wherever the pointer is.
    typed = focus.number_begun || !(focus.letters || pointer_in_view());
    focus.letters = focus.letters || !typed; // the command may bring a panel under the pointer
  } else if (is_printable(key.key)) {
    typed = key.key != '?';
    focus.number_begun = focus.number_begun || typed;
  } else {
    typed = focus.among_fields && edits_text(key);
  }
  if (typed)
    session.notice = key_text(key) +
                     " did nothing: the panel has the keys, and no field of it is open. A click into the "
                     "view or Esc gives them to commands.";
  return !typed;
}

void give_keys_to_popups(Ui& ui, const DialogState& dialog, bool& shortcuts, bool palette) {
  const auto pressed = [&](int code) {
    return std::ranges::any_of(ui.keys, [&](const KeyPress& key) { return !key.ctrl && key.key == code; });
  };
  if (shortcuts) {
    if (pressed(keys::escape) || pressed(keys::enter) || pressed('?') || pressed(keys::f1)) shortcuts = false;
    ui.keys.clear();
    return;
  }
  // Dialogs and the palette see to their keys themselves.
  if (dialog.showing || palette) return;
  const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (open == 0) return;
  // In a field Escape gives back what stood there before.
  if (ui.fields.typing.name.empty() && pressed(keys::escape)) ImGui::ClosePopupToLevel(0, true);
  ui.keys.clear();
}

} // namespace flyball
