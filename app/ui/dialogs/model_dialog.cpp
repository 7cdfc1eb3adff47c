#include "app/report/linear_model_file.hpp"
#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/file.hpp"

namespace flyball {

void show_model_dialog(App& app) {
  app.dialog.wanted = Dialog::export_model;
  show_folder(app.file_dialogs, usual_folder(app.session));
  app.file_dialogs.replacing.clear();
  const std::filesystem::path& file = app.session.document.file();
  app.file_dialogs.path =
      (file.empty() ? file_stem(app.session.mechanism().name) : file.stem().string()) + "-model.m";
}

void model_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::export_model, "Export the linear model", 520)) return;
  bool accepted = path_field(app.ui, app.file_dialogs, "model", "Name");
  folder_line(app.ui, app.file_dialogs, "model");
  const auto& found = app.session.study.transfer.found.found;
  const std::string ending = typed_path(app.file_dialogs).extension().string();
  const std::filesystem::path file =
      typed_file(app.file_dialogs, linear_model_format(ending) ? ending : ".m");
  const auto format = linear_model_format(file.extension().string());
  paragraph(
      "The ending decides: .m for MATLAB and Octave, .py for Python, .npz for NumPy, .json for all of it.",
      format ? colors_of(app.ui).dim : colors_of(app.ui).bad);
  const bool replaces = asks_to_replace(app.ui, app.file_dialogs, file);
  if (!replaces && !app.file_dialogs.message.empty())
    paragraph(app.file_dialogs.message, colors_of(app.ui).bad);
  ImGui::Dummy({0, 2 * app.ui.scale});
  const bool usable = has_transfer(app.session) && format && !app.file_dialogs.path.empty();
  ImGui::BeginDisabled(!usable);
  accepted = text_button(app.ui, "model/save", replaces ? "Replace" : "Export", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  std::error_code ignored;
  if (text_button(app.ui, "model/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
  } else if (accepted && usable && std::filesystem::is_directory(typed_path(app.file_dialogs), ignored)) {
    entered_file(app.file_dialogs, false); // goes there
  } else if (accepted && usable && may_replace(app.session, app.file_dialogs, file)) {
    try {
      replace_file(file, linear_model_file(*found->of.mechanism, found->result.model, *format));
      app.session.notice = "Saved " + file.string();
      close_dialog();
    } catch (const SceneError& error) {
      app.file_dialogs.message = error.what();
      app.file_dialogs.replacing.clear();
    }
  }
  end_dialog();
}

} // namespace flyball
