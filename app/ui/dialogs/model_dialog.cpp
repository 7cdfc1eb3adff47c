#include "app/ui/dialogs/model_dialog.hpp"

#include "app/report/linear_model_file.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/file.hpp"

namespace flyball {

void ModelDialog::open(const Session& session, DialogState& dialog) {
  dialog.wanted = Dialog::export_model;
  show_folder(query_, usual_folder(session));
  query_.asked.clear();
  query_.path = file_stem(session) + "-model.m";
}

void ModelDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  if (!begin_dialog(ui, dialog, Dialog::export_model, "Export the linear model", 520)) return;
  bool accepted = path_field(ui, query_, "model", "Name");
  folder_line(ui, query_, "model");
  const std::string ending = typed_path(query_).extension().string();
  const std::filesystem::path file = typed_file(query_, linear_model_format(ending) ? ending : ".m");
  const auto format = linear_model_format(file.extension().string());
  const TransferState& state = session.study.transfer;
  const auto& found = state.found.found;
  if (!state.found.problem.empty())
    paragraph(transfer_problem(session), colors_of(ui).warn);
  else if (!has_transfer(session))
    paragraph("The model is being made.", colors_of(ui).dim);
  else
    paragraph("From " + signal_phrase(session, state.choice.input) + " to " +
                  signal_phrase(session, state.choice.output) + ", as chosen in Transfer.",
              colors_of(ui).text);
  note_widget(ui.widgets, "model/of");
  paragraph(
      "The ending decides: .m for MATLAB and Octave, .py for Python, .npz for NumPy, .json for all of it.",
      format ? colors_of(ui).dim : colors_of(ui).bad);
  const char* asked = asked_before_writing(ui, query_, file);
  if (!asked && !query_.message.empty()) paragraph(query_.message, colors_of(ui).bad);
  ImGui::Dummy({0, 2 * ui.scale});
  const bool usable = has_transfer(session) && format && !query_.path.empty();
  ImGui::BeginDisabled(!usable);
  accepted = text_button(ui, "model/save", asked ? asked : "Export", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  std::error_code ignored;
  if (text_button(ui, "model/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
  } else if (accepted && usable && std::filesystem::is_directory(typed_path(query_), ignored)) {
    entered_file(query_, false); // goes there
  } else if (accepted && usable && may_write_to(session, query_, file)) {
    try {
      replace_file(file, linear_model_file(*found->of.mechanism, found->result.model, *format));
      session.notice = "Saved " + file.string();
      close_dialog();
    } catch (const SceneError& error) {
      query_.message = error.what();
      query_.asked.clear();
    }
  }
  end_dialog();
}

} // namespace flyball
