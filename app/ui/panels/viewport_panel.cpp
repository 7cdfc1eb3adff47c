#include "app/render/imgui_compat.hpp"
#include "app/ui/app.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/panels/context_menu.hpp"
#include "app/ui/panels/legend.hpp"
#include "app/ui/panels/load_labels.hpp"
#include "app/ui/panels/view_overlays.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tool_cursor.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <cmath>

namespace flyball {

namespace {

void use_tool(App& app, const ViewInput& input) {
  switch (app.tool.tool) {
  case Tool::select:
  case Tool::rotate:
  case Tool::pull:
  case Tool::box: return;
  case Tool::ball:
  case Tool::block:
  case Tool::plate: return use_placing(app, input);
  case Tool::rod:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper: return use_connecting(app, input);
  case Tool::joint:
  case Tool::bearing: return use_joining(app, input);
  case Tool::force:
  case Tool::torque:
  case Tool::drag:
  case Tool::vane: return use_forces(app, input);
  case Tool::point: return pick_point(app.session, app.tool, input);
  }
}

} // namespace

void viewport_panel(App& app, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("view", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(imgui_compat::texture_id(app.view.texture), {rect.x, rect.y},
                {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  use_view_cube(app.ui, app.view, rect);
  ImGui::InvisibleButton("view", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  note_widget(app.ui.widgets, "view", KeyUse::none);
  ViewInput input = view_input(app.ui, app.view, rect);
  keep_tool_state(app.session, app.tool);
  use_tool_cursor(app, input);
  if (use_hand(app, input)) input.pressed = input.released = false;
  use_points(app, input);
  use_gizmo(app, input);
  use_selecting(app, input);
  const std::uint64_t revision = app.session.document.revision();
  const bool joining = app.tool.joint.has_value();
  use_tool(app, input);
  follow_tool_cursor(app.session, app.ui, app.tool, revision, joining);
  steer(app, input);
  load_labels(app.ui, app.view, rect);
  draw_view_cube(app, rect);
  context_menu(app, input);
  caption(app.session, app.ui, rect);
  status_chip(app.session, app.ui, rect);
  explored_chip(app.session, app.ui, app.dialog, rect);
  view_lines(app, rect); // clear of both
  ImGui::End();
  if (!load_tooltip(app, input)) part_label(app);
  tool_strip(app, rect);
  legend(app, rect);
  error_line(app.session, app.ui, app.view, rect);
  joint_card(app, input);
  problem_banner(app, rect);
}

void beside_panel(App& app, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("beside", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(imgui_compat::texture_id(app.view.texture_beside), {rect.x, rect.y},
                {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  ImGui::InvisibleButton("beside", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  note_widget(app.ui.widgets, "beside", KeyUse::none);
  steer(app, view_input(app.ui, app.view, rect)); // one camera for both
  motion_caption(app.session, app.ui, rect);
  ImGui::End();
}

} // namespace flyball
