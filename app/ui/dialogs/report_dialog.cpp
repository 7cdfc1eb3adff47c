#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

void show_report_dialog(App& app) {
  app.dialog.wanted = Dialog::export_report;
  show_folder(app, usual_folder(app));
  app.file_dialogs.replacing.clear();
  const std::filesystem::path& file = app.document.file();
  app.file_dialogs.path =
      (file.empty() ? file_stem(app.mechanism().name) : file.stem().string()) + "-report.html";
}

void report_dialog(App& app) {
  if (!begin_dialog(app, Dialog::export_report, "Export a report", 520)) return;
  bool accepted = path_field(app, "report", "Name");
  folder_line(app, "report");
  paragraph("One page for a browser or printer: picture, steady state, stability and modes, loads, response "
            "curves, "
            "parameters and assumptions.",
            colors_of(app).dim);
  const std::filesystem::path file = typed_file(app, ".html");
  const bool replaces = asks_to_replace(app, file);
  ImGui::Dummy({0, 2 * app.scale});
  const bool usable = !app.file_dialogs.path.empty() && !writing_report(app);
  ImGui::BeginDisabled(!usable);
  accepted = text_button(app, "report/save", replaces ? "Replace" : "Export", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  std::error_code ignored;
  if (text_button(app, "report/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
  } else if (accepted && usable && std::filesystem::is_directory(typed_path(app), ignored)) {
    entered_file(app, false); // goes there
  } else if (accepted && usable && may_replace(app, file)) {
    app.export_request = ExportRequest{.file = file, .width = 1440, .height = 900, .report = true};
    close_dialog();
  }
  end_dialog();
}

} // namespace flyball
