#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/size_fields.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>

namespace flyball {

namespace {

constexpr int smallest_picture = 16, largest_picture = 8192; // pixels

constexpr std::array picture_sizes{PictureSize{"720p", "1280 × 720", 1280, 720},
                                   PictureSize{"1080p", "1920 × 1080", 1920, 1080},
                                   PictureSize{"4k", "3840 × 2160", 3840, 2160}};

void save_picture(App& app) {
  DialogState& dialog = app.dialog;
  const std::filesystem::path file = typed_file(app.file_dialogs, ".png");
  if (!may_replace(app.session, app.file_dialogs, file)) return;
  app.export_request = ExportRequest{file, std::clamp(dialog.width, smallest_picture, largest_picture),
                                     std::clamp(dialog.height, smallest_picture, largest_picture),
                                     dialog.panels, dialog.loads};
  close_dialog();
}

} // namespace

void show_export_dialog(App& app) {
  app.dialog.wanted = Dialog::export_picture;
  app.dialog.loads = app.view.loads;
  show_folder(app.file_dialogs, usual_folder(app.session));
  app.file_dialogs.replacing.clear();
  const std::filesystem::path& file = app.session.document.file();
  const std::string stem = file.empty() ? file_stem(app.session.mechanism().name) : file.stem().string();
  app.file_dialogs.path = (app.file_dialogs.list.shown / ("flyball-" + stem + ".png")).string();
}

void export_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::export_picture, "Save a picture", 480)) return;
  DialogState& dialog = app.dialog;
  bool accepted = path_field(app.ui, app.file_dialogs, "export", "Name");

  size_fields(app.ui, "export", picture_sizes, 80, dialog.width, dialog.height);
  ImGui::SetCursorPosX(80 * app.ui.scale);
  ImGui::Checkbox("With the panels", &dialog.panels);
  note_widget(app.ui.widgets, "export/panels");
  ImGui::SameLine(0, 20 * app.ui.scale);
  ImGui::Checkbox("With forces", &dialog.loads);
  note_widget(app.ui.widgets, "export/loads");
  help_on_hover("Arrows of what acts, and their legend; with one body selected, its free-body diagram.");

  const bool fits = std::min(dialog.width, dialog.height) >= smallest_picture &&
                    std::max(dialog.width, dialog.height) <= largest_picture;
  if (!fits) paragraph("From 16 to 8192 pixels a side.", colors_of(app.ui).bad);
  const std::filesystem::path file = typed_file(app.file_dialogs, ".png");
  const bool replaces = asks_to_replace(app.ui, app.file_dialogs, file);
  ImGui::Dummy({0, 2 * app.ui.scale});
  ImGui::BeginDisabled(!fits || app.file_dialogs.path.empty());
  accepted = text_button(app.ui, "export/save", replaces ? "Replace" : "Save", true) || accepted;
  ImGui::EndDisabled();
  if (accepted && fits && !app.file_dialogs.path.empty()) save_picture(app);
  ImGui::SameLine();
  if (text_button(app.ui, "export/cancel", "Cancel") || escape_pressed()) close_dialog();
  end_dialog();
}

} // namespace flyball
