#include "app/ui/panels/command_palette.hpp"

#include "app/render/icons.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_stdlib.h>

#include <algorithm>

namespace flyball {

namespace {

constexpr const char* palette_title = "palette";
constexpr std::size_t most_recent = 20;

// The title with what was typed of it marked; returns its width.
float draw_title(const Ui& ui, const PaletteEntry& entry, ImVec2 at) {
  const UiColors& colors = colors_of(ui);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string& text = entry.title;
  const float start = at.x;
  auto mark = entry.marks.begin();
  for (std::size_t from = 0; from < text.size();) {
    const bool marked = mark != entry.marks.end() && *mark == from;
    std::size_t to = from;
    while (to < text.size() && (mark != entry.marks.end() && *mark == to) == marked) {
      if (marked) ++mark;
      ++to;
    }
    ImFont* font = marked ? ui.fonts.strong : ui.fonts.text;
    const ImVec4& color = !entry.enabled ? colors.dim : marked ? colors.accent : colors.text;
    const float size = ui.fonts.text->FontSize;
    const char *first = text.c_str() + from, *last = text.c_str() + to;
    list.AddText(font, size, at, packed(color), first, last);
    at.x += font->CalcTextSizeA(size, 1e9f, 0, first, last).x;
    from = to;
  }
  return at.x - start;
}

// A row; returns whether it was clicked.
bool entry_row(Ui& ui, const PaletteEntry& entry, bool chosen) {
  const UiColors& colors = colors_of(ui);
  const float width = ImGui::GetContentRegionAvail().x, gap = 18 * ui.scale;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::PushID(entry.name.c_str());
  const bool clicked =
      ImGui::Selectable("##entry", chosen, ImGuiSelectableFlags_DontClosePopups) && entry.enabled;
  note_widget(ui.widgets, "palette/" + entry.name, KeyUse::none); // arrows and Enter are the palette's
  const float title_width = draw_title(ui, entry, from);
  const float right_width = ImGui::CalcTextSize(entry.right.c_str()).x;
  ImGui::SameLine(title_width + gap);
  ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
  clipped_text(entry.about, std::max(width - title_width - right_width - 2 * gap, 1.f));
  ImGui::PopStyleColor();
  ImGui::SameLine(width - right_width);
  ImGui::TextColored(entry.value ? colors.accent : colors.dim, "%s", entry.right.c_str());
  ImGui::PopID();
  return clicked;
}

} // namespace

std::optional<PaletteEntry> CommandPalette::draw(const Session& session, Ui& ui,
                                                 const CommandRunner& commands) {
  const float s = ui.scale;
  const bool appearing = std::exchange(wanted_, false);
  if (appearing) {
    ImGui::OpenPopup(palette_title);
    search_.clear();
    chosen_ = -1;
  }
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, 70 * s}, ImGuiCond_Always, {0.5f, 0});
  if (appearing) index_.fresh = false; // what can be done now may be something else
  const std::vector<PaletteEntry>& found = palette_entries(session, commands, index_, search_, recent_);
  int count = static_cast<int>(found.size());
  // As tall as what is found, up to a dozen rows.
  const float row = ImGui::GetTextLineHeight() + ImGui::GetStyle().ItemSpacing.y;
  const float list = row * static_cast<float>(std::clamp(count, 1, 14)) + 4 * s;
  const float height = list + ImGui::GetFrameHeightWithSpacing() + 24 * s;
  ImGui::SetNextWindowSize({std::min(660 * s, window.x - 20 * s), std::min(height, window.y - 90 * s)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * s, 12 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  showing_ = ImGui::BeginPopup(palette_title, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
  if (!showing_) return std::nullopt;

  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputTextWithHint(
          "##search", "Find a command, a part or a number; a number behind its name sets it", &search_))
    chosen_ = is_blank(search_) ? -1 : 0;
  note_widget(ui.widgets, "palette/search", KeyUse::none);
  // What is taken below is of what was typed, also where both come in one frame: `found` is the index's.
  palette_entries(session, commands, index_, search_, recent_);
  count = static_cast<int>(found.size());
  bool accepted = false, moved = false, left = escape_pressed();
  for (const KeyPress& key : std::exchange(ui.keys, {})) {
    if (key.key == keys::enter) accepted = true;
    if (key.key == keys::escape) left = true;
    if (key.key == keys::down || key.key == keys::up) {
      if (key.key == keys::down)
        chosen_ = chosen_ + 1 < count ? chosen_ + 1 : 0;
      else
        chosen_ = (chosen_ <= 0 ? count : chosen_) - 1;
      moved = true;
    }
  }
  const PaletteEntry* wanted = nullptr;
  ImGui::BeginChild("found");
  for (int i = 0; i < count; ++i) {
    const PaletteEntry& entry = found[static_cast<std::size_t>(i)];
    if (entry_row(ui, entry, i == chosen_)) wanted = &entry;
    if (i == chosen_ && moved) ImGui::SetScrollHereY();
  }
  if (count == 0) ImGui::TextDisabled("No command, part or number is called that.");
  ImGui::EndChild();
  if (accepted && chosen_ >= 0 && chosen_ < count && found[static_cast<std::size_t>(chosen_)].enabled)
    wanted = &found[static_cast<std::size_t>(chosen_)];
  if (wanted || left) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (!wanted) return std::nullopt;
  showing_ = false;
  std::erase(recent_, wanted->name);
  recent_.insert(recent_.begin(), wanted->name);
  if (recent_.size() > most_recent) recent_.resize(most_recent);
  return *wanted;
}

} // namespace flyball
