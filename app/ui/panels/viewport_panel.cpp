#include "app/ui/panels/viewport_panel.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/panels/context_menu.hpp"
#include "app/ui/panels/legend.hpp"
#include "app/ui/panels/load_labels.hpp"
#include "app/ui/panels/view_overlays.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tool_cursor.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <cmath>

namespace flyball {

namespace {

void use_tool(const ViewContext& context, const ViewInput& input) {
  switch (context.tool.tool) {
  case Tool::select:
  case Tool::rotate:
  case Tool::pull:
  case Tool::box: return;
  case Tool::ball:
  case Tool::block:
  case Tool::plate:
  case Tool::disc: return use_placing(context, input);
  case Tool::rod:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper: return use_connecting(context, input);
  case Tool::joint:
  case Tool::bearing: return use_joining(context, input);
  case Tool::force:
  case Tool::torque:
  case Tool::drag:
  case Tool::vane: return use_forces(context, input);
  case Tool::point: return pick_point(context.session, context.tool, input);
  }
}

} // namespace

void ViewportPanel::draw(const ViewContext& context, const DialogState& dialog, NoticeAge& age,
                         NoticeLog& log, const CommandRunner& commands, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("view", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(imgui_compat::texture_id(context.view.texture), {rect.x, rect.y},
                {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  use_view_cube(context.ui, context.view, rect);
  ImGui::InvisibleButton("view", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  note_widget(context.ui.widgets, "view", KeyUse::none);
  ViewInput input = view_input(context.ui, context.view, rect);
  keep_tool_state(context.session, context.tool);
  use_tool_cursor(context, input);
  if (use_hand(context, input)) input.pressed = input.released = false;
  use_points(context, input);
  use_gizmo(context, input);
  use_selecting(context, input);
  const std::uint64_t revision = context.session.document.revision();
  const bool joining = context.tool.joint.has_value();
  use_tool(context, input);
  follow_tool_cursor(context.session, context.ui, context.tool, revision, joining);
  steer(context.tool, context.view, input);
  load_labels(context.ui, context.view, rect);
  draw_view_cube(context.session, context.ui, context.view, rect);
  menu_.draw(context, commands, input);
  caption(context.session, context.ui, rect);
  status_chip(context.session, context.ui, rect);
  explored_chip(context.session, context.ui, dialog, rect);
  tool_strip(context.session, context.ui, context.tool, rect);
  legend_.draw(context, rect);         // clear of both
  view_lines(context, age, log, rect); // and these of all
  ImGui::End();
  if (!load_tooltip(context, input)) part_label(context);
  error_line(context.session, context.ui, context.view, rect);
  joint_card(context, input);
  problem_banner(context.session, context.ui, commands, rect);
}

void ViewportPanel::draw_beside(const ViewContext& context, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("beside", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(imgui_compat::texture_id(context.view.texture_beside), {rect.x, rect.y},
                {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  ImGui::InvisibleButton("beside", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  note_widget(context.ui.widgets, "beside", KeyUse::none);
  steer(context.tool, context.view, view_input(context.ui, context.view, rect)); // one camera for both
  motion_caption(context.session, context.ui, rect);
  ImGui::End();
}

void ViewportPanel::draw_alone(const ViewContext& context, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("view", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImGui::GetWindowDrawList()->AddImage(imgui_compat::texture_id(context.view.texture), {rect.x, rect.y},
                                       {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  load_labels(context.ui, context.view, rect);
  ImGui::End();
  legend_.draw(context, rect, false);
}

} // namespace flyball
