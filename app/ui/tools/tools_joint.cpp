// Joining two bodies, by a joint or a bearing: a click says where, the card beside the point how.
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/joint_guess.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/bodies_near.hpp"
#include "app/viewport/snapping.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace flyball {

namespace {

void show_bodies(Session& session, const ToolState& tool) {
  Selection selection;
  for (const std::string& body : tool.joint->bodies)
    if (body != ground_name) selection.add({PartKind::body, body});
  select(session, std::move(selection));
}

// Of the point from the nearer body of those that were guessed (m).
double distance_of(const ViewContext& context, const JointDraft& draft) {
  const Mechanism& mechanism = context.session.mechanism();
  for (const NearBody& near : bodies_near(mechanism, cached_scene(context).instances, draft.at))
    if (const std::string& name = mechanism.bodies[static_cast<std::size_t>(near.body)].name;
        name == draft.guessed[0] || name == draft.guessed[1])
      return near.distance;
  return 0;
}

// A disc is held on its shaft first, whatever type was chosen last: that is the next joint's again.
void offer_type(const Session& session, ToolState& tool, const JointDraft& draft) {
  if (tool.type_aside) tool.joint_type = *std::exchange(tool.type_aside, {});
  if (!sits_on_shaft(session.mechanism(), draft.bodies, draft.at)) return;
  tool.type_aside = tool.joint_type;
  tool.joint_type = JointType::fixed;
}

void begin_joint(const ViewContext& context, const ViewInput& input, const Aim& aim) {
  const JointDraft former = context.tool.joint.value_or(JointDraft()); // whose point is moved
  const bool bearing = context.tool.tool == Tool::bearing;
  JointDraft draft;
  draft.before = context.tool.joint ? former.before : context.session.selection();
  draft.card_height = former.card_height;
  const double reach = snap_reach * input.point * input.metres_per_pixel();
  draft.at = aim.point;
  draft.named = aim.named;
  draft.guessed = guess_bodies(context.session.mechanism(), cached_scene(context).instances, draft.before,
                               draft.at, reach, bearing);
  if (draft.guessed[1].empty()) {
    context.session.notice = "There is nothing to join yet: place a body first.";
    return;
  }
  draft.away = distance_of(context, draft);
  if (draft.away <= reach) draft.away = 0;
  draft.bodies_chosen = former.bodies_chosen;
  draft.bodies = former.bodies_chosen ? former.bodies : draft.guessed;
  if (!context.tool.joint && !bearing)
    offer_type(context.session, context.tool, draft);
  else if (context.tool.type_aside && !sits_on_shaft(context.session.mechanism(), draft.bodies, draft.at))
    context.tool.joint_type = *std::exchange(context.tool.type_aside, {}); // it was offered for another place
  draft.axis_chosen = former.axis_chosen;
  if (former.axis_chosen)
    draft.axis = former.axis;
  else
    draft.axis = bearing ? guess_shaft(context.session.mechanism(), draft.bodies, aim.plane.normal)
                         : guess_axis(context.session.mechanism(), context.tool.joint_type, draft.bodies,
                                      aim.plane.normal);
  draft.axis2_chosen = former.axis2_chosen && draft.axis.cross(former.axis2).norm() > 1e-6;
  draft.axis2 = draft.axis2_chosen ? former.axis2 : axis_across(draft.axis);
  context.tool.joint = std::move(draft);
  context.tool.last_point = aim.point;
  show_bodies(context.session, context.tool);
}

void pick_axis(Session& session, ToolState& tool, const Aim& aim) {
  JointDraft& draft = *tool.joint;
  if (!draft.axis_from) {
    draft.axis_from = aim.point;
    return;
  }
  const Vec3 axis = (aim.point - *draft.axis_from).stableNormalized();
  if (!(axis.norm() > 0)) {
    session.notice = "The two points of an axis have to be apart.";
    return;
  }
  draft.axis = axis;
  draft.axis_chosen = true;
  draft.axis2 = axis_across(axis);
  draft.picking_axis = false;
  draft.axis_from.reset();
}

void draw_axis(const Ui& ui, const ViewInput& input, const Vec3& at, const Vec3& axis, bool main) {
  const double length = (main ? 64 : 40) * input.point * metres_per_pixel(input.camera, at, input.size);
  const Vec3 unit = axis.normalized();
  const auto from = input.on_screen(Vec3(at - length * unit)), to = input.on_screen(Vec3(at + length * unit));
  if (!from || !to) return;
  const Color& accent = palette(ui.theme).accent;
  draw_line(ui, *from, *to, accent, main ? 2.4f : 1.4f, main ? 1.f : 0.8f);
  const float dx = to->x - from->x, dy = to->y - from->y, pixels = std::hypot(dx, dy);
  if (!main || pixels < 12 * ui.scale) return;
  // The head tells which way is positive.
  const ImVec2 along(dx / pixels, dy / pixels);
  const float head = 11 * ui.scale, half = 4.5f * ui.scale;
  ImGui::GetWindowDrawList()->AddTriangleFilled(
      {to->x - head * along.x - half * along.y, to->y - head * along.y + half * along.x},
      {to->x + 3 * along.x, to->y + 3 * along.y},
      {to->x - head * along.x + half * along.y, to->y - head * along.y - half * along.x}, packed(accent));
}

void draw_draft(const Ui& ui, const ToolState& tool, const ViewInput& input) {
  const JointDraft& draft = *tool.joint;
  const JointType type = tool.joint_type;
  const bool bearing = tool.tool == Tool::bearing;
  if (bearing || has_axis(type)) draw_axis(ui, input, draft.at, draft.axis, true);
  if (!bearing && has_axis2(type)) draw_axis(ui, input, draft.at, draft.axis2, false);
  if (const auto at = input.on_screen(draft.at)) {
    draw_dot(ui, *at, 4);
    draw_dot(ui, *at, 9, true);
  }
}

} // namespace

void use_joining(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  if (tool.joint) draw_draft(context.ui, context.tool, input);
  if (!input.hovered) return;
  const Aim aim = aim_at(context, input);
  const bool picking = tool.joint && tool.joint->picking_axis;
  if (picking && tool.joint->axis_from) {
    const auto p = input.on_screen(*tool.joint->axis_from), q = input.on_screen(aim.point);
    if (p && q) draw_line(context.ui, *p, *q, palette(context.ui.theme).accent, 2);
    if (p) draw_dot(context.ui, *p, 4);
  }
  if (!tool.joint || picking || input.active) draw_aim(context.session, context.ui, input, aim);
  if (!input.clicked() || tool.spent) return;
  if (picking)
    pick_axis(context.session, context.tool, aim);
  else
    begin_joint(context, input, aim);
}

bool make_joint(Session& session, Ui& ui, ToolState& tool) {
  const std::optional<JointDraft> draft = tool.joint;
  if (!draft || draft->picking_axis || draft->bodies[0] == draft->bodies[1]) return false;
  const bool bearing = tool.tool == Tool::bearing;
  const std::string between = draft->bodies[0] + " and " + draft->bodies[1];
  edit(session, (bearing ? "Add bearing between " : "Join ") + between,
       [&](Mechanism& mechanism, Selection& selection) {
         const Part part =
             bearing ? Part{PartKind::force, add_bearing(mechanism, draft->bodies, draft->at, draft->axis)}
                     : Part{PartKind::joint, add_joint(mechanism, tool.joint_type, draft->bodies, draft->at,
                                                       draft->axis, draft->axis2)};
         stand_at(mechanism, point_address(mechanism, {part, 0}), draft->named);
         selection.set(part);
       });
  tool.joint.reset();
  if (!ImGui::GetIO().KeyShift) tool.tool = Tool::select;
  if (ui.keyboard.ring) focus_widget(ui, "inspector/name"); // for whoever works by keys alone
  return true;
}

} // namespace flyball
