#include "app/ui/widgets/typed_field.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/widgets/completion_list.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <cctype>
#include <string_view>
#include <utility>

namespace flyball {

namespace {

constexpr int idle_frames = 3; // frames in which a field may be without the keyboard before it counts as left

// "expected another name" as it is read on its own: "Expected another name."
std::string as_sentence(std::string words) {
  if (words.empty()) return words;
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  if (std::string_view(".!?").find(words.back()) == std::string_view::npos) words += '.';
  return words;
}

void check(Typing& typing, const TextField& field) {
  if (!typing.check || typing.text == typing.checked) return;
  typing.checked = typing.text;
  typing.mistake = typing.text == typing.original ? "" : as_sentence(typing.check(typing.text));
  typing.offer = {};
  if (!typing.mistake.empty() && field.offer) typing.offer = field.offer(typing.text);
}

// Takes what was typed, or says why not.
void leave(Session& session, Ui& ui, bool at_once) {
  const Typing typing = std::exchange(ui.fields.typing, {});
  ui.completion = {};
  if (typing.text == typing.original || !typing.take) return;
  if (!typing.mistake.empty()) {
    show_error(session, "“" + typing.text + "” was not taken. " + typing.mistake);
    return;
  }
  if (at_once) return typing.take(typing.text);
  later(ui, [take = typing.take, text = typing.text] { take(text); });
}

void begin(Session& session, Ui& ui, const TextField& field, std::string typed) {
  leave(session, ui, false);
  ui.fields.typing = {
      .name = field.name, .text = std::move(typed), .original = field.text, .checked = field.text};
}

// Below the field, wherever the mouse is: why the text cannot be taken, and what the word could become. A
// tooltip lets clicks through, which what is offered may not.
void show_advice(Ui& ui) {
  Typing& typing = ui.fields.typing;
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax(),
               window = ImGui::GetIO().DisplaySize;
  const bool right = from.x + to.x > window.x, lists = !ui.completion.found.list.empty();
  const float list_height = lists ? 11 * ImGui::GetTextLineHeightWithSpacing() : 0;
  const bool above = to.y + list_height > window.y;
  ImGui::SetNextWindowPos({right ? to.x : from.x, above ? from.y - 3 * ui.scale : to.y + 3 * ui.scale},
                          ImGuiCond_Always, {right ? 1.f : 0.f, above ? 1.f : 0.f});
  const bool clickable = lists || !typing.offer.words.empty(), offers = !typing.offer.words.empty();
  constexpr ImGuiWindowFlags in_front = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoFocusOnAppearing;
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, ImGui::GetStyle().PopupBorderSize);
  if (clickable)
    ImGui::Begin("mistake", nullptr, in_front);
  else
    ImGui::BeginTooltip();
  if (clickable) ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
  ImGui::PushFont(ui.fonts.text);
  if (offers || !lists) { // of half a word there is nothing to mend
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 20);
    ImGui::TextColored(colors_of(ui).bad, "%s", typing.mistake.c_str());
    ImGui::PopTextWrapPos();
  }
  if (offers) {
    ImGui::Button((typing.offer.words + " (Ctrl+Enter)").c_str());
    typing.offered_from = ImGui::GetItemRectMin();
    typing.offered_to = ImGui::GetItemRectMax();
    note_widget(ui.widgets, typing.name + "/offer", KeyUse::none);
  }
  draw_completions(ui, ui.completion, typing.name);
  ImGui::PopFont();
  if (clickable)
    ImGui::End();
  else
    ImGui::EndTooltip();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

// Whether it is this that ends typing: a click there, which takes the keyboard from the field, or the key.
bool takes_offer(const Typing& typing, bool entered) {
  if (typing.offer.words.empty()) return false;
  const ImVec2 at = ImGui::GetIO().MousePos, from = typing.offered_from, to = typing.offered_to;
  const bool clicked =
      ImGui::IsMouseClicked(0) && at.x >= from.x && at.x < to.x && at.y >= from.y && at.y < to.y;
  return clicked || (entered && ImGui::GetIO().KeyCtrl);
}

// The one that ends typing for a moment: under a click, or marked by an arrow and taken by Enter; -1: none.
int taken_completion(const CompletionState& completion, bool entered) {
  if (ImGui::IsMouseClicked(0)) return row_at(completion, ImGui::GetIO().MousePos);
  return entered && completion.by_arrow && completes(completion) ? completion.marked : -1;
}

// What a field's text input calls: keeps account of the cursor, then does what the field wants.
struct FieldCallback {
  const TextField& field;
  CompletionState& completion;
};
int call_back(ImGuiInputTextCallbackData* data) {
  const auto& own = *static_cast<const FieldCallback*>(data->UserData);
  steer_cursor(own.completion, data);
  if (!own.field.callback || (own.field.flags & data->EventFlag) == 0) return 0;
  data->UserData = own.field.callback_data;
  return own.field.callback(data);
}

bool escape_pressed_now() {
  return imgui_compat::key_pressed(ImGuiKey_Escape);
}

// Of the field that is typed in, after it was drawn.
void go_on(Session& session, Ui& ui, const TextField& field, bool entered) {
  Typing& typing = ui.fields.typing;
  if (ImGui::IsItemActive()) typing.idle = 0;
  typing.check = field.check;
  typing.take = field.take;
  check(typing, field);
  if (field.expression) find_completions(ui.completion, session.mechanism(), typing.text, typing.original);
  if (!ImGui::IsItemDeactivated()) {
    move_mark(ui.completion);
    if (!typing.mistake.empty() || !ui.completion.found.list.empty()) show_advice(ui);
  } else if (const int row = taken_completion(ui.completion, entered); row >= 0) {
    typing.text = completed(ui.completion, typing.text, row);
    typing.wants_focus = true;
  } else if (takes_offer(typing, entered)) {
    later(ui, std::exchange(typing, {}).offer.take);
    ui.completion = {};
    ui.keyboard.focus = {};
  } else if (escape_pressed_now()) {
    typing = {};
    ui.completion = {};
    ui.keyboard.focus = {};
  } else if (entered && !typing.mistake.empty()) {
    typing.wants_focus = true;
    ui.completion.cursor_wanted =
        static_cast<int>(typing.text.size()); // selected, the next key would replace it
  } else {
    leave(session, ui, field.at_once);
    if (entered) ui.keyboard.focus = {}; // done: keys are commands again
  }
}

} // namespace

bool typing_in(const Ui& ui, const std::string& name) {
  return ui.fields.typing.name == name;
}

void start_typing(Session& session, Ui& ui, const std::string& name, const std::string& text) {
  leave(session, ui, false);
  ui.fields.typing = {.name = name, .text = text, .original = text, .checked = text};
  ui.fields.typing.wants_focus = true;
}

bool text_field(Session& session, Ui& ui, const TextField& field, float width) {
  const UiColors& colors = colors_of(ui);
  Typing& typing = ui.fields.typing;
  const bool was_typing = typing_in(ui, field.name);
  std::string resting = field.text;
  ImVec4 color = was_typing && !typing.mistake.empty() ? colors.bad : colors.text;
  if (!was_typing && !field.drawn_here) color.w = 0;

  ImGui::SetNextItemWidth(width);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  const int flags = field.flags | ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll |
                    ImGuiInputTextFlags_CallbackAlways;
  FieldCallback own{field, ui.completion};
  ImGui::PushID(field.name.c_str());
  // By its ID: what asks for the next item (SetKeyboardFocusHere) finds none in some releases, where a popup
  // has just closed.
  if (was_typing && std::exchange(typing.wants_focus, false))
    imgui_compat::press_item(ImGui::GetID("##typed"), true);
  std::string& text = was_typing ? typing.text : resting;
  put_stand_ins(text, ui.fields.wide);
  const bool entered = ImGui::InputTextWithHint("##typed", field.hint, &text, flags, call_back, &own);
  take_stand_ins(text, ui.fields.wide);
  ImGui::PopID();
  ImGui::PopStyleColor();
  note_widget(ui.widgets, field.name, KeyUse::type);

  if (was_typing)
    go_on(session, ui, field, entered);
  else if (ImGui::IsItemActive())
    begin(session, ui, field, std::move(resting));
  return was_typing;
}

namespace {

void do_what_waits(Ui& ui) {
  while (!ui.fields.later.empty()) // an edit may put off another
    for (const auto& edit : std::exchange(ui.fields.later, {}))
      edit();
}

} // namespace

bool finish_typing(Session& session, Ui& ui) {
  const bool taken = ui.fields.typing.mistake.empty();
  leave(session, ui, true);
  do_what_waits(ui); // as an edit of a note does
  ImGui::ClearActiveID();
  return taken;
}

void later(Ui& ui, std::function<void()> edit) {
  ui.fields.later.push_back(std::move(edit));
}

void settle_fields(Session& session, Ui& ui) {
  if (Typing& typing = ui.fields.typing; !typing.name.empty() && ++typing.idle > idle_frames)
    leave(session, ui, false);
  do_what_waits(ui);
}

} // namespace flyball
