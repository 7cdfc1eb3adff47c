#include "app/ui/inspector/inspector_panel.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/render/icons.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <cctype>

namespace flyball {

namespace {

std::string word_for(const Mechanism& mechanism, PartId id) {
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::joint) return joint_noun(mechanism.joints[i]);
  if (id.kind == PartKind::force) return force_noun(mechanism.forces[i]);
  return "body";
}

std::string title_of(const Session& session) {
  const Selection& selection = session.selection();
  if (selection.empty()) return "Scene";
  if (selection.parts.size() > 1) return std::to_string(selection.parts.size()) + " parts";
  std::string word = word_for(session.mechanism(), find_part(session.mechanism(), selection.parts.front()));
  word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

// The title, and at the right a way to be rid of what it names.
void panel_title(const Session& session, Ui& ui, const CommandRunner& commands) {
  const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
  ImGui::AlignTextToFramePadding();
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextUnformatted(title_of(session).c_str());
  ImGui::PopFont();
  note_widget(ui.widgets, "inspector/title");
  if (session.selection().parts.size() != 1) return;
  const float side = ImGui::GetFrameHeight() + 2 * ui.scale;
  ImGui::SameLine();
  ImGui::SetCursorPosX(start + width - side);
  if (icon_button(ui, "inspector/delete", icon::trash, "Delete it, with what hangs on it."))
    later(ui, [commands] { commands.run("edit.delete"); });
}

void inspector_contents(Session& session, Ui& ui, InspectorState& state, ToolState& tool,
                        const CommandRunner& commands) {
  const Selection& selection = session.selection();
  if (selection.empty()) return scene_inspector(session, ui, tool);
  if (selection.parts.size() > 1) return several_inspector(session, ui, state, tool, commands);
  const Mechanism& mechanism = session.mechanism();
  const PartId id = find_part(mechanism, selection.parts.front());
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::body) body_inspector(session, ui, state, tool, mechanism.bodies[i]);
  if (id.kind == PartKind::joint) joint_inspector(session, ui, mechanism.joints[i]);
  if (id.kind == PartKind::force) force_inspector(session, ui, mechanism.forces[i]);
}

} // namespace

std::string several_words(const Mechanism& mechanism, PartId part, std::size_t count) {
  const std::string word = word_for(mechanism, part);
  return std::to_string(count) + " " + (part.kind == PartKind::body ? "bodies" : word + "s");
}

void InspectorPanel::draw(Session& session, Ui& ui, ToolState& tool, const CommandRunner& commands,
                          const PanelRect& rect) {
  begin_panel("inspector", rect);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * ui.scale, 3 * ui.scale});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6 * ui.scale, ImGui::GetStyle().FramePadding.y});
  ui.fields.together.clear();
  panel_title(session, ui, commands);
  inspector_contents(session, ui, state_, tool, commands);
  ImGui::PopStyleVar(2);
  ImGui::End();
}

} // namespace flyball
