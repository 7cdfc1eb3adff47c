#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <array>

namespace flyball {

namespace {

constexpr std::array unsaved_answers{Choice{"unsaved/save", "Save"}, Choice{"unsaved/discard", "Don't save"},
                                     Choice{"unsaved/cancel", "Cancel"}};

std::string question(const Session& session) {
  const std::string name = document_name(session);
  if (session.files.watch.vanished()) return name + " is no longer on disk. What is open here is in no file.";
  return name + " has changes that are not saved.";
}

void save_first(App& app) {
  if (app.session.document.file().empty() || is_example(app.session))
    return ask_where_to_save(app.session, app.dialog, app.file_dialogs, {});
  if (std::string why = save_to(app.session, app.session.document.file()); !why.empty())
    return ask_where_to_save(app.session, app.dialog, app.file_dialogs, std::move(why));
  leave_now(app);
}

} // namespace

void unsaved_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::unsaved, "Save the changes?", 440)) return;
  const UiColors& colors = colors_of(app.ui);
  if (ImGui::IsWindowAppearing() && app.session.files.watch.differs()) app.session.files.conflict = true;
  paragraph(question(app.session), colors.text);
  if (app.session.files.conflict)
    paragraph("The file has changed on disk meanwhile; saving replaces what is there.", colors.warn);
  const int answer = choice_buttons(app.ui, unsaved_answers, app.file_dialogs.choice);
  if (answer >= 0 || escape_pressed()) close_dialog();
  if (answer == 0)
    save_first(app);
  else if (answer == 1)
    leave_now(app);
  else if (answer == 2 || escape_pressed())
    app.file_dialogs.then = {};
  end_dialog();
}

} // namespace flyball
