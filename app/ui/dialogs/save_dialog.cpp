#include "app/ui/dialogs/save_dialog.hpp"

#include "app/session/session.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

namespace {

namespace fs = std::filesystem;

// A name without an ending is one of the program's own files.
fs::path file_to_save(const FileQuery& query) {
  const fs::path ending = typed_path(query).extension();
  return typed_file(query, ending == ".json" || ending == ".flyball" ? ".json" : ".flyball.json");
}

} // namespace

// Whether it is saved.
bool SaveDialog::save(Session& session) {
  const fs::path file = file_to_save(query_);
  if (!may_write_to(session, query_, file)) return false;
  query_.message = save_to(session, file);
  query_.asked.clear();
  if (!query_.message.empty()) return false;
  close_dialog();
  return true;
}

void SaveDialog::open(const Session& session, DialogState& dialog, std::string why) {
  const fs::path& file = session.document.file();
  std::error_code ignored;
  show_folder(query_, is_example(session) ? fs::current_path(ignored) : usual_folder(session));
  query_.message = std::move(why);
  query_.asked.clear();
  dialog.wanted = Dialog::save;
  query_.path =
      file.empty() ? file_stem(session.mechanism().name) + ".flyball.json" : file.filename().string();
}

SaveDialog::Answer SaveDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  if (!begin_dialog(ui, dialog, Dialog::save, "Save as", 560)) return Answer::none;
  Answer answer = Answer::none;
  const bool entered = path_field(ui, query_, "save", "Name");
  folder_line(ui, query_, "save");
  if (const auto clicked = file_list(ui, query_, "save", ".json", false, 220 * ui.scale))
    query_.path = clicked->filename().string();
  const fs::path file = file_to_save(query_);
  const char* asked = asked_before_writing(ui, query_, file);
  if (!asked && !query_.message.empty())
    paragraph(query_.message, colors_of(ui).bad);
  else if (!asked && is_example(session))
    paragraph("Examples stay as they are; this will be a file of your own.", colors_of(ui).dim);
  ImGui::Dummy({0, 2 * ui.scale});
  const bool usable = !query_.path.empty();
  ImGui::BeginDisabled(!usable);
  const bool pressed = text_button(ui, "save/save", asked ? asked : "Save", true);
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (text_button(ui, "save/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
    answer = Answer::cancelled;
  } else if (usable && (entered || pressed)) {
    std::error_code ignored;
    if (fs::is_directory(typed_path(query_), ignored))
      entered_file(query_, false); // goes there
    else if (save(session))
      answer = Answer::saved;
  }
  end_dialog();
  return answer;
}

} // namespace flyball
