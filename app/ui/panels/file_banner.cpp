#include "app/render/icons.hpp"
#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/report_export.hpp"
#include "app/ui/widgets/card.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <cmath>

namespace flyball {

namespace {

// What is on disk is known now and not wanted.
void keep_mine(Session& session, const CommandRunner& commands) {
  const std::filesystem::path file = session.document.file();
  try {
    session.files.watch = FileWatch(file, read_bytes(file, 0.));
  } catch (const SceneError&) { // gone: there is nothing to be kept from
  }
  const bool save_wanted = session.files.save_wanted;
  session.files.conflict = session.files.save_wanted = false;
  if (save_wanted) commands.run("file.save");
}

void conflict(Session& session, Ui& ui, const CommandRunner& commands) {
  const UiColors& colors = colors_of(ui);
  const bool saving = session.files.save_wanted;
  ImGui::AlignTextToFramePadding();
  paragraph(std::string(icon::warning) + "  " + (saving ? "Not saved yet: " : "") + document_name(session) +
                " has changed on disk, and there are unsaved changes here.",
            colors.text);
  if (text_button(ui, "banner/reload", "Take the file's")) reload_document(session);
  help_on_hover("Read the file again. Undo brings the unsaved changes back.");
  ImGui::SameLine();
  if (text_button(ui, "banner/keep", saving ? "Overwrite the file" : "Keep mine", true))
    keep_mine(session, commands);
}

void discarded(Session& session, Ui& ui, DialogState& dialog) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("The unsaved work was discarded.");
  ImGui::SameLine();
  if (text_button(ui, "banner/bring_back", "Bring it back")) {
    bring_back_discarded(session);
    offer_leftovers(session, dialog);
  }
  ImGui::SameLine();
  if (text_button(ui, "banner/close", icon::close)) session.files.aside.clear();
}

void being_written(Ui& ui, ReportExport& report) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Writing the report");
  ImGui::SameLine();
  task_bar(ui, "banner/report", report.task->progress(), report.task->seconds(), 220 * ui.scale);
  ImGui::SameLine();
  if (text_button(ui, "banner/report/cancel", "Cancel")) report.task->cancel();
}

} // namespace

void file_banner(Session& session, Ui& ui, DialogState& dialog, ReportExport& report,
                 const CommandRunner& commands, const PanelRect& view) {
  constexpr double patience = 0.5; // s: a shorter wait is not worth a banner
  const bool both_changed = session.files.conflict && !session.document.file().empty();
  const bool writing = writing_report(report) && report.task->seconds() > patience;
  if (dialog.showing || (!both_changed && !writing && session.files.aside.empty())) return;
  const float s = ui.scale;
  // Beside the legend and the tools where they leave room enough: words take lines, a bar and its button do
  // not.
  const float room = (both_changed ? 240 : 470) * s;
  float left = view.x, right = view.x + view.width;
  if (const auto legend = ui.widgets.find("legend frame");
      legend != ui.widgets.end() && legend->second.from.x > left + room)
    right = legend->second.from.x + 4 * s;
  if (const auto tools = ui.widgets.find("tool strip");
      tools != ui.widgets.end() && tools->second.to.x + room < right)
    left = tools->second.to.x - 4 * s;
  ImGui::SetNextWindowPos({std::round((left + right) / 2), view.y + 12 * s}, ImGuiCond_Always, {0.5f, 0});
  if (both_changed) ImGui::SetNextWindowSize({std::min(460 * s, right - left - 24 * s), 0});
  begin_card("file banner", s, ImGui::GetStyle().WindowPadding, ImGuiWindowFlags_NoFocusOnAppearing);
  if (both_changed)
    conflict(session, ui, commands);
  else if (writing)
    being_written(ui, report);
  else
    discarded(session, ui, dialog);
  ImGui::End();
}

} // namespace flyball
