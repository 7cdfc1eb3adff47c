#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

void show_report_dialog(App& app) {
  app.dialog.wanted = Dialog::export_report;
  show_folder(app.file_dialogs, usual_folder(app.session));
  app.file_dialogs.replacing.clear();
  const std::filesystem::path& file = app.session.document.file();
  app.file_dialogs.path =
      (file.empty() ? file_stem(app.session.mechanism().name) : file.stem().string()) + "-report.html";
}

void report_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::export_report, "Export a report", 520)) return;
  bool accepted = path_field(app.ui, app.file_dialogs, "report", "Name");
  folder_line(app.ui, app.file_dialogs, "report");
  paragraph("One page for a browser or printer: picture, steady state, stability and modes, loads, response "
            "curves, "
            "parameters and assumptions.",
            colors_of(app.ui).dim);
  const std::filesystem::path file = typed_file(app.file_dialogs, ".html");
  const bool replaces = asks_to_replace(app.ui, app.file_dialogs, file);
  ImGui::Dummy({0, 2 * app.ui.scale});
  const bool usable = !app.file_dialogs.path.empty() && !writing_report(app.report);
  ImGui::BeginDisabled(!usable);
  accepted = text_button(app.ui, "report/save", replaces ? "Replace" : "Export", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  std::error_code ignored;
  if (text_button(app.ui, "report/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
  } else if (accepted && usable && std::filesystem::is_directory(typed_path(app.file_dialogs), ignored)) {
    entered_file(app.file_dialogs, false); // goes there
  } else if (accepted && usable && may_replace(app.session, app.file_dialogs, file)) {
    app.export_request = ExportRequest{.file = file, .width = 1440, .height = 900, .report = true};
    close_dialog();
  }
  end_dialog();
}

} // namespace flyball
