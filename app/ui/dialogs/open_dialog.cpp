#include "app/ui/dialogs/open_dialog.hpp"

#include "app/render/icons.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr float list_height = 250, recent_width = 210; // points

// Returns the one that was clicked.
fs::path recent_list(const Session& session, Ui& ui) {
  fs::path clicked;
  ImGui::BeginChild("recent", {recent_width * ui.scale, list_height * ui.scale});
  ImGui::TextDisabled("Recent");
  for (std::size_t i = 0; i < session.files.recent.size(); ++i) {
    const fs::path& file = session.files.recent[i];
    ImGui::PushID(file.c_str());
    const std::string text = std::string(icon::file) + "  " + file.filename().string();
    if (ImGui::Selectable(text.c_str(), false, ImGuiSelectableFlags_DontClosePopups)) clicked = file;
    ImGui::PopID();
    note_widget(ui.widgets, "open/recent/" + std::to_string(i), KeyUse::row);
    help_on_hover(file.c_str());
  }
  ImGui::EndChild();
  return clicked;
}

} // namespace

bool OpenDialog::may_open(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file, ignored)) return true;
  query_.message = "There is no " + file.string() + ".";
  return false;
}

void OpenDialog::open(const Session& session, DialogState& dialog) {
  const fs::path& file = session.document.file();
  show_folder(query_, !file.empty() ? file.parent_path() : usual_folder(session));
  dialog.wanted = Dialog::open;
  query_.path.clear();
}

OpenDialog::Answer OpenDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  Answer answer;
  const bool with_recent = !session.files.recent.empty();
  if (!begin_dialog(ui, dialog, Dialog::open, "Open a scene", with_recent ? 720 : 560)) return answer;
  const bool entered = path_field(ui, query_, "open", "Name, or part of it, or a path");
  std::optional<fs::path> file;
  if (with_recent) {
    if (const fs::path recent = recent_list(session, ui); !recent.empty()) file = recent;
    ImGui::SameLine(0, 16 * ui.scale);
    ImGui::BeginGroup();
  }
  folder_line(ui, query_, "open");
  const float line = ImGui::GetFrameHeightWithSpacing() + 2 * ui.scale;
  if (auto clicked = file_list(ui, query_, "open", ".json", true, list_height * ui.scale - line))
    file = clicked;
  if (with_recent) ImGui::EndGroup();
  if (!query_.message.empty()) paragraph(query_.message, colors_of(ui).bad);
  ImGui::Dummy({0, 2 * ui.scale});
  const bool pressed = text_button(ui, "open/open", "Open", true);
  if (entered || pressed)
    if (auto typed = entered_file(query_, true)) file = typed;
  ImGui::SameLine();
  if (text_button(ui, "open/cancel", "Cancel") || escape_pressed()) close_dialog();
  if (!session.options.scenes.empty()) {
    ImGui::SameLine();
    if (text_button(ui, "open/examples", "Examples…")) {
      close_dialog();
      answer.examples = true;
    }
  }
  if (file && may_open(*file)) {
    close_dialog();
    answer.file = *file; // where it cannot be read the view says why
  }
  end_dialog();
  return answer;
}

} // namespace flyball
