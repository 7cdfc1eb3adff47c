#include "app/render/icons.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>

namespace flyball {

namespace {

constexpr const char* title = "palette";

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// How well a command answers the search: every word must be found; the lower the better; negative: not at
// all. A word's beginning counts more than its middle, the title more than the sentence about it.
int rank(const App& app, const Command& command, const std::string& search) {
  const std::string label = lower(label_of(app, command)), all = label + " " + lower(command.help);
  int rank = 0;
  std::size_t from = 0;
  while (from < search.size()) {
    const std::size_t end = std::min(search.find(' ', from), search.size());
    const std::string word = search.substr(from, end - from);
    from = end + 1;
    if (word.empty()) continue;
    const std::size_t at = all.find(word);
    if (at == std::string::npos) return -1;
    if (at > 0 && all[at - 1] != ' ') rank += 10;
    if (at >= label.size()) rank += 100;
    rank += at == 0 ? 0 : 1;
  }
  return rank;
}

std::vector<const Command*> found_commands(const App& app) {
  const std::string search = lower(app.commands.search);
  std::vector<std::pair<int, const Command*>> ranked;
  for (const Command& command : commands())
    if (const int place = rank(app, command, search); place >= 0)
      ranked.emplace_back(place + (is_enabled(app, command) ? 0 : 1000), &command);
  std::ranges::stable_sort(ranked, {}, &std::pair<int, const Command*>::first);
  std::vector<const Command*> found;
  for (const auto& entry : ranked)
    found.push_back(entry.second);
  return found;
}

// A row; returns whether it was clicked.
bool command_row(App& app, const Command& command, bool chosen) {
  const UiColors& colors = colors_of(app);
  const bool enabled = is_enabled(app, command);
  const float width = ImGui::GetContentRegionAvail().x;
  const std::string keys = key_text(command.key);
  ImGui::PushID(command.id);
  ImGui::PushStyleColor(ImGuiCol_Text, enabled ? colors.text : colors.dim);
  const bool clicked =
      ImGui::Selectable(label_of(app, command).c_str(), chosen, ImGuiSelectableFlags_DontClosePopups) &&
      enabled;
  ImGui::PopStyleColor();
  note_widget(app.widgets, std::string("palette/") + command.id);
  const float keys_width = ImGui::CalcTextSize(keys.c_str()).x;
  const float label_width = ImGui::CalcTextSize(label_of(app, command).c_str()).x;
  const float gap = 18 * app.scale;
  ImGui::SameLine(label_width + gap);
  ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
  clipped_text(enabled ? command.help : "Not now: there is nothing selected that it applies to.",
               std::max(width - label_width - keys_width - 2 * gap, 1.f));
  ImGui::SameLine(width - keys_width);
  ImGui::TextUnformatted(keys.c_str());
  ImGui::PopStyleColor();
  ImGui::PopID();
  return clicked;
}

} // namespace

void command_palette(App& app) {
  CommandState& state = app.commands;
  const float s = app.scale;
  const bool appearing = std::exchange(state.palette_wanted, false);
  if (appearing) {
    ImGui::OpenPopup(title);
    state.search.clear();
    state.chosen = 0;
  }
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, 70 * s}, ImGuiCond_Always, {0.5f, 0});
  const std::vector<const Command*> found = found_commands(app);
  const int count = static_cast<int>(found.size());
  // As tall as what is found, up to a dozen rows.
  const float row = ImGui::GetTextLineHeight() + ImGui::GetStyle().ItemSpacing.y;
  const float list = row * static_cast<float>(std::clamp(count, 1, 14)) + 4 * s;
  const float height = list + ImGui::GetFrameHeightWithSpacing() + 24 * s;
  ImGui::SetNextWindowSize({std::min(660 * s, window.x - 20 * s), std::min(height, window.y - 90 * s)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * s, 12 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  state.palette_showing =
      ImGui::BeginPopup(title, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
  if (!state.palette_showing) return;

  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputTextWithHint("##search", "Find a command", &state.search)) state.chosen = 0;
  note_widget(app.widgets, "palette/search");
  bool accepted = false, moved = false, left = escape_pressed();
  for (const KeyPress& key : std::exchange(app.keys, {})) {
    if (key.key == keys::enter) accepted = true;
    if (key.key == keys::escape) left = true;
    if (key.key == keys::down || key.key == keys::up) {
      state.chosen += key.key == keys::down ? 1 : count - 1;
      state.chosen = count > 0 ? state.chosen % count : 0;
      moved = true;
    }
  }
  const Command* wanted = nullptr;
  ImGui::BeginChild("found");
  for (int i = 0; i < count; ++i) {
    const Command& entry = *found[static_cast<std::size_t>(i)];
    if (command_row(app, entry, i == state.chosen)) wanted = &entry;
    if (i == state.chosen && moved) ImGui::SetScrollHereY();
  }
  if (count == 0) ImGui::TextDisabled("No command is called that.");
  ImGui::EndChild();
  if (accepted && state.chosen < count && is_enabled(app, *found[static_cast<std::size_t>(state.chosen)]))
    wanted = found[static_cast<std::size_t>(state.chosen)];
  if (wanted || left) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (wanted) {
    state.palette_showing = false;
    wanted->run(app);
  }
}

} // namespace flyball
