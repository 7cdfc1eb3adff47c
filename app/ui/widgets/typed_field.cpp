#include "app/ui/widgets/typed_field.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_stdlib.h>

#include <utility>

namespace flyball {

namespace {

constexpr int idle_frames = 3; // frames in which a field may be without the keyboard before it counts as left

void check(Typing& typing) {
  if (!typing.check || typing.text == typing.checked) return;
  typing.checked = typing.text;
  typing.mistake = typing.text == typing.original ? "" : typing.check(typing.text);
}

// Takes what was typed, or says why not.
void leave(App& app, bool at_once) {
  const Typing typing = std::exchange(app.fields.typing, {});
  if (typing.text == typing.original || !typing.take) return;
  if (!typing.mistake.empty()) {
    show_error(app, "“" + typing.text + "” was not taken. " + typing.mistake);
    return;
  }
  if (at_once) return typing.take(typing.text);
  later(app, [take = typing.take, text = typing.text] { take(text); });
}

void begin(App& app, const TextField& field, std::string typed) {
  leave(app, false);
  app.fields.typing = {
      .name = field.name, .text = std::move(typed), .original = field.text, .checked = field.text};
}

// Below the field, wherever the mouse is.
void show_mistake(Ui& ui, const std::string& mistake) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const bool right = from.x + to.x > ImGui::GetIO().DisplaySize.x;
  ImGui::SetNextWindowPos({right ? to.x : from.x, to.y + 3 * ui.scale}, ImGuiCond_Always,
                          {right ? 1.f : 0.f, 0});
  ImGui::BeginTooltip();
  ImGui::PushFont(ui.fonts.text);
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 20);
  ImGui::TextColored(colors_of(ui).bad, "%s", mistake.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::EndTooltip();
}

bool escape_pressed_now() {
  return imgui_compat::key_pressed(ImGuiKey_Escape);
}

// Of the field that is typed in, after it was drawn.
void go_on(App& app, const TextField& field, bool entered) {
  Typing& typing = app.fields.typing;
  if (ImGui::IsItemActive()) typing.idle = 0;
  typing.check = field.check;
  typing.take = field.take;
  check(typing);
  if (!ImGui::IsItemDeactivated()) {
    if (!typing.mistake.empty()) show_mistake(app, typing.mistake);
  } else if (escape_pressed_now()) {
    typing = {};
    app.keyboard.focus = {};
  } else if (entered && !typing.mistake.empty()) {
    typing.wants_focus = true;
  } else {
    leave(app, field.at_once);
  }
}

} // namespace

bool typing_in(const App& app, const std::string& name) {
  return app.fields.typing.name == name;
}

void start_typing(App& app, const std::string& name, const std::string& text) {
  leave(app, false);
  app.fields.typing = {.name = name, .text = text, .original = text, .checked = text};
  app.fields.typing.wants_focus = true;
}

bool text_field(App& app, const TextField& field, float width) {
  const UiColors& colors = colors_of(app);
  Typing& typing = app.fields.typing;
  const bool was_typing = typing_in(app, field.name);
  std::string resting = field.text;
  ImVec4 color = was_typing && !typing.mistake.empty() ? colors.bad : colors.text;
  if (!was_typing && !field.drawn_here) color.w = 0;
  if (was_typing && std::exchange(typing.wants_focus, false)) ImGui::SetKeyboardFocusHere();

  ImGui::SetNextItemWidth(width);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  const int flags = field.flags | ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll;
  ImGui::PushID(field.name.c_str());
  const bool entered = ImGui::InputTextWithHint("##typed", field.hint, was_typing ? &typing.text : &resting,
                                                flags, field.callback, field.callback_data);
  ImGui::PopID();
  ImGui::PopStyleColor();
  note_widget(app.widgets, field.name, KeyUse::type);

  if (was_typing)
    go_on(app, field, entered);
  else if (ImGui::IsItemActive())
    begin(app, field, std::move(resting));
  return was_typing;
}

void later(Ui& ui, std::function<void()> edit) {
  ui.fields.later.push_back(std::move(edit));
}

void settle_fields(App& app) {
  if (Typing& typing = app.fields.typing; !typing.name.empty() && ++typing.idle > idle_frames)
    leave(app, false);
  while (!app.fields.later.empty()) // an edit may put off another
    for (const auto& edit : std::exchange(app.fields.later, {}))
      edit();
}

} // namespace flyball
