#include "app/ui/dialogs/unsaved_dialog.hpp"

#include "app/session/session.hpp"
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

} // namespace

std::optional<UnsavedDialog::Answer> UnsavedDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  if (!begin_dialog(ui, dialog, Dialog::unsaved, "Save the changes?", 440)) return std::nullopt;
  const UiColors& colors = colors_of(ui);
  if (ImGui::IsWindowAppearing() && session.files.watch.differs()) session.files.conflict = true;
  paragraph(question(session), colors.text);
  if (session.files.conflict)
    paragraph("The file has changed on disk meanwhile; saving replaces what is there.", colors.warn);
  const int answer = choice_buttons(ui, unsaved_answers, answer_);
  if (answer >= 0 || escape_pressed()) close_dialog();
  std::optional<Answer> given;
  if (answer == 0)
    given = Answer::save;
  else if (answer == 1)
    given = Answer::discard;
  else if (answer == 2 || escape_pressed())
    given = Answer::cancel;
  end_dialog();
  return given;
}

} // namespace flyball
