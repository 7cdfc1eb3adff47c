#include "app/ui/dialogs/report_dialog.hpp"

#include "app/session/session.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

void ReportDialog::open(const Session& session, DialogState& dialog) {
  dialog.wanted = Dialog::export_report;
  show_folder(query_, usual_folder(session));
  query_.asked.clear();
  query_.path = file_stem(session) + "-report.html";
}

std::optional<ExportRequest> ReportDialog::draw(Session& session, Ui& ui, DialogState& dialog, bool writing) {
  std::optional<ExportRequest> report;
  if (!begin_dialog(ui, dialog, Dialog::export_report, "Export a report", 520)) return report;
  bool accepted = path_field(ui, query_, "report", "Name");
  folder_line(ui, query_, "report");
  paragraph("One page for a browser or printer: picture, steady state, stability and modes, loads, response "
            "curves, "
            "parameters and assumptions.",
            colors_of(ui).dim);
  const std::filesystem::path file = typed_file(query_, ".html");
  const char* asked = asked_before_writing(ui, query_, file);
  if (!asked && !query_.message.empty()) paragraph(query_.message, colors_of(ui).bad);
  ImGui::Dummy({0, 2 * ui.scale});
  const bool usable = !query_.path.empty() && !writing;
  ImGui::BeginDisabled(!usable);
  accepted = text_button(ui, "report/save", asked ? asked : "Export", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  std::error_code ignored;
  if (text_button(ui, "report/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
  } else if (accepted && usable && std::filesystem::is_directory(typed_path(query_), ignored)) {
    entered_file(query_, false); // goes there
  } else if (accepted && usable && may_write_to(session, query_, file)) {
    report = ExportRequest{.file = file, .width = 1440, .height = 900, .report = true};
    close_dialog();
  }
  end_dialog();
  return report;
}

} // namespace flyball
