#include "app/render/icons.hpp"
#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr float list_height = 250, recent_width = 210; // points

void choose(App& app, const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    app.file_dialogs.message = "There is no " + file.string() + ".";
    return;
  }
  close_dialog();
  // Where it cannot be read the view says why.
  open_file(app, file);
}

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

void show_open_dialog(App& app) {
  const fs::path& file = app.session.document.file();
  show_folder(app.file_dialogs, !file.empty() ? file.parent_path() : usual_folder(app.session));
  app.dialog.wanted = Dialog::open;
  app.file_dialogs.path.clear();
}

void open_dialog(App& app) {
  const bool with_recent = !app.session.files.recent.empty();
  if (!begin_dialog(app.ui, app.dialog, Dialog::open, "Open a scene", with_recent ? 720 : 560)) return;
  const bool entered = path_field(app.ui, app.file_dialogs, "open", "Name, or part of it, or a path");
  std::optional<fs::path> file;
  if (with_recent) {
    if (const fs::path recent = recent_list(app.session, app.ui); !recent.empty()) file = recent;
    ImGui::SameLine(0, 16 * app.ui.scale);
    ImGui::BeginGroup();
  }
  folder_line(app.ui, app.file_dialogs, "open");
  const float line = ImGui::GetFrameHeightWithSpacing() + 2 * app.ui.scale;
  if (auto clicked =
          file_list(app.ui, app.file_dialogs, "open", ".json", true, list_height * app.ui.scale - line))
    file = clicked;
  if (with_recent) ImGui::EndGroup();
  if (!app.file_dialogs.message.empty()) paragraph(app.file_dialogs.message, colors_of(app.ui).bad);
  ImGui::Dummy({0, 2 * app.ui.scale});
  const bool pressed = text_button(app.ui, "open/open", "Open", true);
  if (entered || pressed)
    if (auto typed = entered_file(app.file_dialogs, true)) file = typed;
  ImGui::SameLine();
  if (text_button(app.ui, "open/cancel", "Cancel") || escape_pressed()) close_dialog();
  if (!app.session.options.scenes.empty()) {
    ImGui::SameLine();
    if (text_button(app.ui, "open/examples", "Examples…")) {
      close_dialog();
      show_gallery(app);
    }
  }
  if (file) choose(app, *file);
  end_dialog();
}

} // namespace flyball
