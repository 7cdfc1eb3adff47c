#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

namespace {

namespace fs = std::filesystem;

// "swing_pendulum" as a person would write it.
std::string words_of(std::string stem) {
  for (char& c : stem)
    if (c == '_') c = ' ';
  if (!stem.empty() && stem[0] >= 'a' && stem[0] <= 'z') stem[0] = static_cast<char>(stem[0] - 'a' + 'A');
  return stem;
}

void save(App& app) {
  const fs::path file = typed_file(app.file_dialogs, ".json");
  if (!may_replace(app.session, app.file_dialogs, file)) return;
  // A mechanism that nobody has named is called as its file is.
  if (app.session.document.file().empty() && app.session.mechanism().name == Document::empty_mechanism().name)
    edit(app.session, "Name", [&](Mechanism& m, Selection&) { m.name = words_of(file.stem().string()); });
  app.file_dialogs.message = save_to(app.session, file);
  app.file_dialogs.replacing.clear();
  if (!app.file_dialogs.message.empty()) return;
  close_dialog();
  leave_now(app);
}

} // namespace

void ask_where_to_save(const Session& session, DialogState& dialog, FileDialogState& file_dialogs,
                       std::string why) {
  const fs::path& file = session.document.file();
  std::error_code ignored;
  show_folder(file_dialogs, is_example(session) ? fs::current_path(ignored) : usual_folder(session));
  file_dialogs.message = std::move(why);
  file_dialogs.replacing.clear();
  dialog.wanted = Dialog::save;
  file_dialogs.path = file.empty() ? file_stem(session.mechanism().name) + ".json" : file.filename().string();
}

void save_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::save, "Save as", 560)) return;
  const bool entered = path_field(app.ui, app.file_dialogs, "save", "Name");
  folder_line(app.ui, app.file_dialogs, "save");
  if (const auto clicked = file_list(app.ui, app.file_dialogs, "save", ".json", false, 220 * app.ui.scale))
    app.file_dialogs.path = clicked->filename().string();
  const fs::path file = typed_file(app.file_dialogs, ".json");
  const bool replaces = asks_to_replace(app.ui, app.file_dialogs, file);
  if (!replaces && !app.file_dialogs.message.empty())
    paragraph(app.file_dialogs.message, colors_of(app.ui).bad);
  else if (!replaces && is_example(app.session))
    paragraph("Examples stay as they are; this will be a file of your own.", colors_of(app.ui).dim);
  ImGui::Dummy({0, 2 * app.ui.scale});
  const bool usable = !app.file_dialogs.path.empty();
  ImGui::BeginDisabled(!usable);
  const bool pressed = text_button(app.ui, "save/save", replaces ? "Replace" : "Save", true);
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (text_button(app.ui, "save/cancel", "Cancel") || escape_pressed()) {
    close_dialog();
    app.file_dialogs.then = {};
  } else if (usable && (entered || pressed)) {
    std::error_code ignored;
    if (fs::is_directory(typed_path(app.file_dialogs), ignored))
      entered_file(app.file_dialogs, false); // goes there
    else
      save(app);
  }
  end_dialog();
}

} // namespace flyball
