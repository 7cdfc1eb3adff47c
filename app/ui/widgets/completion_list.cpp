#include "app/ui/widgets/completion_list.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <utility>

namespace flyball {

namespace {

constexpr int rows_shown = 8;

std::string_view word_of(const CompletionState& state) {
  return std::string_view(state.text).substr(state.found.from, state.found.to - state.found.from);
}

} // namespace

void find_completions(CompletionState& state, const Mechanism& mechanism, const std::string& text,
                      const std::string& original) {
  const std::size_t cursor = std::min(state.cursor, text.size());
  if (state.text == text && state.found.to == cursor) return;
  state.text = text;
  state.found = {};
  state.marked = -1;
  state.by_arrow = false;
  state.first = 0;
  if (!text.starts_with('=') || text == original || cursor == 0) {
    state.found.from = state.found.to = cursor;
    return;
  }
  state.found = completions_at(mechanism, text, cursor);
  const std::string_view word = word_of(state);
  if (state.found.list.size() == 1 && state.found.list[0].text == word) state.found.list.clear();
  if (!word.empty() && !state.found.list.empty()) state.marked = 0;
}

bool completes(const CompletionState& state) {
  return state.marked >= 0 && state.found.list[static_cast<std::size_t>(state.marked)].text != word_of(state);
}

void move_mark(CompletionState& state) {
  const int count = static_cast<int>(state.found.list.size());
  if (count == 0) return;
  const int step = (imgui_compat::key_pressed(ImGuiKey_DownArrow) ? 1 : 0) -
                   (imgui_compat::key_pressed(ImGuiKey_UpArrow) ? 1 : 0);
  if (step == 0) return;
  state.marked = std::clamp(state.marked + step, 0, count - 1);
  state.by_arrow = true;
  state.first = std::clamp(state.first, state.marked - rows_shown + 1, state.marked);
}

void draw_completions(Ui& ui, CompletionState& state, const std::string& name) {
  const auto count = static_cast<int>(state.found.list.size());
  state.from = state.to = {};
  if (count == 0) return;
  const UiColors& colors = colors_of(ui);
  const int last = std::min(state.first + rows_shown, count);
  float names = 0, words = 0; // pixels
  for (int i = state.first; i < last; ++i) {
    const Completion& each = state.found.list[static_cast<std::size_t>(i)];
    names = std::max(names, ImGui::CalcTextSize(each.text.c_str()).x);
    words = std::max(words, ImGui::CalcTextSize(each.words.c_str()).x);
  }
  const float gap = 16 * ui.scale, line = ImGui::GetTextLineHeightWithSpacing();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  state.from = ImGui::GetCursorScreenPos();
  state.to = {state.from.x + names + gap + words,
              state.from.y + line * static_cast<float>(last - state.first)};
  for (int i = state.first; i < last; ++i) {
    const Completion& each = state.found.list[static_cast<std::size_t>(i)];
    const ImVec2 at(state.from.x, state.from.y + line * static_cast<float>(i - state.first));
    const ImVec2 end(state.to.x, at.y + line);
    if (i == state.marked)
      list.AddRectFilled({at.x - 3 * ui.scale, at.y - ui.scale}, {end.x + 3 * ui.scale, end.y - ui.scale},
                         packed(colors.raised), 2 * ui.scale);
    list.AddText(at, packed(i == state.marked ? colors.accent : colors.text), each.text.c_str());
    list.AddText({at.x + names + gap, at.y}, packed(colors.dim), each.words.c_str());
    ui.widgets[name + "/completion/" + each.text] = {at, end};
  }
  ImGui::Dummy({state.to.x - state.from.x, state.to.y - state.from.y});
  if (count > last - state.first) ImGui::TextDisabled("%d more", count - (last - state.first));
}

int row_at(const CompletionState& state, ImVec2 at) {
  if (at.x < state.from.x || at.x >= state.to.x || at.y < state.from.y || at.y >= state.to.y) return -1;
  const int rows = std::min(rows_shown, static_cast<int>(state.found.list.size()) - state.first);
  const float share = (at.y - state.from.y) / (state.to.y - state.from.y);
  return state.first + std::min(static_cast<int>(share * static_cast<float>(rows)), rows - 1);
}

std::string completed(CompletionState& state, const std::string& text, int row) {
  const std::string& name = state.found.list[static_cast<std::size_t>(row)].text;
  const std::size_t from = std::min(state.found.from, text.size()),
                    to = std::min(state.found.to, text.size());
  state.cursor_wanted = static_cast<int>(from + name.size());
  return text.substr(0, from) + name + text.substr(to);
}

void steer_cursor(CompletionState& state, ImGuiInputTextCallbackData* data) {
  if (data->EventFlag != ImGuiInputTextFlags_CallbackAlways) return;
  if (const int row = std::exchange(state.taken, -1);
      row >= 0 && row < static_cast<int>(state.found.list.size())) {
    const auto from = static_cast<int>(state.found.from), to = static_cast<int>(state.found.to);
    if (to <= data->BufTextLen) {
      data->DeleteChars(from, to - from);
      data->InsertChars(from, state.found.list[static_cast<std::size_t>(row)].text.c_str());
    }
  }
  if (const int wanted = std::exchange(state.cursor_wanted, -1); wanted >= 0)
    data->CursorPos = data->SelectionStart = data->SelectionEnd = std::min(wanted, data->BufTextLen);
  state.cursor = static_cast<std::size_t>(data->CursorPos);
}

} // namespace flyball
