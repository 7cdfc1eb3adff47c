// What is known of the selected part, to be read and edited.
#include "app/document/gear_kinds.hpp"
#include "app/render/icons.hpp"
#include "app/ui/app.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <cctype>

namespace flyball {

namespace {

std::string title_of(const Session& session) {
  const Selection& selection = session.selection();
  if (selection.empty()) return "Scene";
  if (selection.parts.size() > 1) return std::to_string(selection.parts.size()) + " parts";
  const PartId id = find_part(session.mechanism(), selection.parts.front());
  const auto i = static_cast<std::size_t>(id.index);
  std::string word = "body";
  if (id.kind == PartKind::joint) word = joint_noun(session.mechanism().joints[i]);
  if (id.kind == PartKind::force) word = type_name(session.mechanism().forces[i].type);
  word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

// The title, and at the right a way to be rid of what it names.
void panel_title(App& app) {
  const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
  ImGui::AlignTextToFramePadding();
  ImGui::PushFont(app.ui.fonts.strong);
  ImGui::TextUnformatted(title_of(app.session).c_str());
  ImGui::PopFont();
  note_widget(app.ui.widgets, "inspector/title");
  if (app.session.selection().parts.size() != 1) return;
  const float side = ImGui::GetFrameHeight() + 2 * app.ui.scale;
  ImGui::SameLine();
  ImGui::SetCursorPosX(start + width - side);
  if (icon_button(app.ui, "inspector/delete", icon::trash, "Delete it, with what hangs on it."))
    later(app.ui, [&app] { run_command(app, "edit.delete"); });
}

void contents(App& app) {
  const Selection& selection = app.session.selection();
  if (selection.empty()) return scene_inspector(app.session, app.ui, app.tool);
  if (selection.parts.size() > 1) return several_inspector(app);
  const PartId id = find_part(app.session.mechanism(), selection.parts.front());
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::body)
    body_inspector(app.session, app.ui, app.inspector, app.session.mechanism().bodies[i]);
  if (id.kind == PartKind::joint) joint_inspector(app.session, app.ui, app.session.mechanism().joints[i]);
  if (id.kind == PartKind::force) force_inspector(app.session, app.ui, app.session.mechanism().forces[i]);
}

} // namespace

void inspector_panel(App& app, const PanelRect& rect) {
  begin_panel("inspector", rect);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * app.ui.scale, 3 * app.ui.scale});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6 * app.ui.scale, ImGui::GetStyle().FramePadding.y});
  panel_title(app);
  contents(app);
  ImGui::PopStyleVar(2);
  ImGui::End();
}

} // namespace flyball
