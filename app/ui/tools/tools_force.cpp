// Forces, torques, drag and vanes: one click on a body.
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"

#include <cmath>

namespace flyball {

namespace {

ForceType type_of(Tool tool) {
  switch (tool) {
  case Tool::torque: return ForceType::torque;
  case Tool::drag: return ForceType::drag;
  case Tool::vane: return ForceType::vane;
  default: return ForceType::force;
  }
}

// 1 N downwards, 1 N m about the world axis that points at the viewer, a vane square to it.
Vec3 first_vector(const Session& session, const ToolState& tool, const ViewInput& input, const Aim& aim) {
  if (tool.tool == Tool::force) return -up_axis(session.mechanism()).array() + 0.0;
  const int n = aim.plane.normal;
  return std::copysign(1.0, input.camera.backward()[n]) * Vec3::Unit(n);
}

} // namespace

void use_forces(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  if (!input.hovered) return;
  const Aim aim = aim_at(context, input);
  const bool on_body = aim.body != ground_name;
  if (on_body && tool.tool == Tool::force) {
    const double length = 40 * input.point * metres_per_pixel(input.camera, aim.point, input.size);
    const auto from = input.on_screen(aim.point);
    const auto to =
        input.on_screen(Vec3(aim.point + length * first_vector(context.session, context.tool, input, aim)));
    if (from && to) draw_line(context.ui, *from, *to, palette(context.ui.theme).accent, 2.5f);
  }
  draw_aim(context.session, context.ui, input, aim,
           on_body && aim.what.empty() ? "on " + aim.body : aim.what);
  if (!input.clicked() || tool.spent) return;
  if (!on_body) {
    context.session.notice = "There is no body here: click one.";
    return;
  }
  const ForceType type = type_of(tool.tool);
  edit(context.session, "Add " + std::string(type_name(type)),
       [&](Mechanism& mechanism, Selection& selection) {
         const std::string name = add_force(mechanism, type, aim.body, aim.point,
                                            first_vector(context.session, context.tool, input, aim));
         stand_at(mechanism, "forces." + name + ".at", aim.named);
         selection.set({PartKind::force, name});
       });
  tool.last_point = aim.point;
  end_tool(context.tool, input);
}

} // namespace flyball
