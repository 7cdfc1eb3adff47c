#include "app/ui/panels/shortcut_sheet.hpp"

#include "app/ui/commands.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>

namespace flyball {

namespace {

constexpr std::array mouse_lines{
    NavigationLine{"Click", "Select; Ctrl adds"},
    NavigationLine{"Alt+drag", "Pull a body"},
    NavigationLine{"Right click", "Context menu"},
    NavigationLine{"Double-click", "All in view"},
    NavigationLine{"Double-click a slider", "Type its value"},
    NavigationLine{"Shift+drag a slider", "Finer"},
    NavigationLine{"Digits while placing", "Length or size, with unit"},
};

constexpr std::array by_keys{
    NavigationLine{"Alt, Alt+letter", "Menus"},
    NavigationLine{"F6, Ctrl+Tab", "Next panel"},
    NavigationLine{"Tab", "Next field of it"},
    NavigationLine{"Arrows", "Nearest widget; a step"},
    NavigationLine{"Shift, Ctrl+arrows", "Finer, coarser steps"},
    NavigationLine{"Digits", "Type a slider's number"},
    NavigationLine{"Enter, Space", "Press"},
    NavigationLine{"Shift+F10, Menu", "More of the widget"},
    NavigationLine{"Shift+arrows", "In the view: pan, else orbit"},
    NavigationLine{"+ and -", "Zoom, in plots, too"},
    NavigationLine{"Page Down, Enter", "Tools: next point, place"},
};

void line(Ui& ui, const std::string& keys, const std::string& does) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool shared = (ImGui::TableGetColumnFlags(0) & ImGuiTableColumnFlags_WidthStretch) != 0;
  ImGui::PushTextWrapPos(shared ? 0 : -1);
  ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).accent);
  ImGui::TextUnformatted(keys.c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  ImGui::TableNextColumn();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(does.c_str());
  ImGui::PopTextWrapPos();
  note_widget(ui.widgets, "shortcuts/" + keys);
}

// Keys as wide as they are, and the rest for the words; where that would break words both share the width.
bool begin_lines(const Ui& ui, const char* name) {
  constexpr float roomy = 240; // points
  const bool shared = ImGui::GetContentRegionAvail().x < roomy * ui.scale;
  if (!ImGui::BeginTable(name, 2)) return false;
  ImGui::TableSetupColumn("keys",
                          shared ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

void lines(Ui& ui, const char* title, std::string_view prefix) {
  heading(ui, title);
  if (!begin_lines(ui, title)) return;
  for (const Command& command : commands()) {
    if (!std::string_view(command.id).starts_with(prefix) || command.key.key == 0) continue;
    const std::string also = key_text(command.also);
    line(ui, key_text(command.key) + (also.empty() ? "" : ", " + also), command.title);
  }
  ImGui::EndTable();
}

void fixed_lines(Ui& ui, const char* title, std::span<const NavigationLine> entries) {
  heading(ui, title);
  if (!begin_lines(ui, title)) return;
  for (const NavigationLine& entry : entries)
    line(ui, entry.keys, entry.does);
  ImGui::EndTable();
}

} // namespace

void ShortcutSheet::draw(Ui& ui, Navigation navigation) {
  constexpr const char* name = "shortcuts";
  if (!open) {
    if (ImGui::IsPopupOpen(name)) ImGui::ClosePopupToLevel(0, true);
    return;
  }
  if (!ImGui::IsPopupOpen(name)) ImGui::OpenPopup(name);
  const float s = ui.scale;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(1180 * s, window.x - 20 * s), std::min(670 * s, window.y - 20 * s)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {20 * s, 16 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, ImGui::GetStyle().PopupBorderSize);
  const bool begun = ImGui::BeginPopupModal(name, nullptr,
                                            ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                                ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                                ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(3);
  if (!begun) return;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {8 * s, 2 * s});
  // What does not fit is scrolled to; the button stays.
  const float foot = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y;
  ImGui::BeginChild("all", {0, -foot});
  // As many columns as there is room for; the others go below.
  const int columns = std::clamp(static_cast<int>(ImGui::GetContentRegionAvail().x / (200 * s)), 1, 4);
  if (ImGui::BeginTable("columns", columns, ImGuiTableFlags_SizingStretchSame)) {
    ImGui::TableNextColumn();
    lines(ui, "File", "file.");
    lines(ui, "Insert", "insert.");
    ImGui::TableNextColumn();
    lines(ui, "Edit", "edit.");
    lines(ui, "Study", "study.");
    lines(ui, "Help", "help.");
    ImGui::TableNextColumn();
    lines(ui, "View", "view.");
    ImGui::TableNextColumn();
    heading(ui, "Mouse in the view");
    if (begin_lines(ui, "mouse")) {
      for (const NavigationLine& entry : navigation_lines(navigation))
        line(ui, entry.keys, entry.does);
      for (const NavigationLine& entry : mouse_lines)
        line(ui, entry.keys, entry.does);
      ImGui::EndTable();
    }
    fixed_lines(ui, "Without a mouse", by_keys);
    ImGui::EndTable();
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  const bool beside =
      ImGui::IsMouseClicked(0) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_RootAndChildWindows);
  if (text_button(ui, "shortcuts/close", "Close", true) || beside) open = false;
  if (!open) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

} // namespace flyball
