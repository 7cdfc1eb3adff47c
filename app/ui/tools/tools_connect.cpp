// What has two ends: rods, links, springs and dampers. Two clicks, or a drag from one end to the other.
#include "app/ui/inspector/body_preview.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/tools/typed_size.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/snapping.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flyball {

namespace {

constexpr double rod_radius = 5;                 // points of the picture
constexpr double stiffness = 1000, damping = 10; // N/m, N s/m

std::string word_of(Tool tool) {
  switch (tool) {
  case Tool::rod: return "rod";
  case Tool::distance: return "link";
  case Tool::spring: return "spring";
  case Tool::damper: return "damper";
  default: return "";
  }
}

NewBody rod_between(const ViewInput& input, const Vec3& from, const Vec3& to) {
  NewBody rod;
  rod.form = BodyForm::rod;
  rod.from = from;
  rod.to = to;
  const double thick = nearest_step(rod_radius * input.point * input.metres_per_pixel());
  rod.radius = std::min(thick, nearest_step((to - from).norm() / 8));
  return rod;
}

// From a named point it goes as that is moved, and weighs what its length makes of it.
void add_rod(Mechanism& mechanism, Selection& selection, const NewBody& rod, const Aim& from, const Aim& to) {
  const std::string name = add_body(mechanism, rod), shape = "bodies." + name + ".shapes.0.";
  if (!from.named.empty() || !to.named.empty()) mechanism.bodies.back().density = rod.density;
  stand_at(mechanism, shape + "from", from.named);
  stand_at(mechanism, shape + "to", to.named);
  selection.set({PartKind::body, name});
}

void add(Session& session, const ToolState& state, const ViewInput& input, const Aim& from, const Aim& to) {
  const std::array<std::string, 2> bodies{from.body, to.body};
  const std::array<Vec3, 2> points{from.point, to.point};
  const Tool tool = state.tool;
  edit(session, "Add " + word_of(tool), [&](Mechanism& mechanism, Selection& selection) {
    if (tool == Tool::rod)
      return add_rod(mechanism, selection, rod_between(input, points[0], points[1]), from, to);
    Part part;
    if (tool == Tool::distance)
      part = {PartKind::joint, add_distance(mechanism, bodies, points)};
    else
      part = {PartKind::force, tool == Tool::spring ? add_spring(mechanism, bodies, points, stiffness, 0)
                                                    : add_spring(mechanism, bodies, points, 0, damping)};
    stand_at(mechanism, point_address(mechanism, {part, 0}), from.named);
    stand_at(mechanism, point_address(mechanism, {part, 1}), to.named);
    selection.set(part);
  });
}

// Why the two ends cannot be joined; empty where they can.
std::string obstacle(Tool tool, const Aim& from, const Aim& to) {
  if (tool != Tool::rod && from.body == to.body)
    return from.body == ground_name ? "Both ends are on the ground: one has to be on a body."
                                    : "Both ends are on " + from.body + ": click a point of something else.";
  const bool together = (from.point - to.point).norm() == 0;
  if (together && tool != Tool::spring && tool != Tool::damper) return "The ends have to be apart.";
  return "";
}

// The direction from one end to where the cursor is, as the preview has it; on the end itself to the right,
// as it is seen.
Vec3 direction(const ViewInput& input, const Aim& from, const Aim& to) {
  const Vec3 by = to.point - from.point;
  if (by.norm() > 0) return by.normalized();
  const int n = to.plane.normal, a = (n + 1) % 3, b = (n + 2) % 3;
  int along = a;
  if (std::abs(input.camera.right()[b]) > std::abs(input.camera.right()[a])) along = b;
  return std::copysign(1.0, input.camera.right()[along]) * Vec3::Unit(along);
}

// Where the cursor is, or as far away from the first end as is typed.
Aim second_end(const Session& session, const ToolState& tool, const ViewInput& input, const Aim& from,
               const Aim& seen, std::string& mistake) {
  if (tool.typed.empty()) return seen;
  const auto length = typed_length(tool.typed, session.units, &mistake);
  if (!length) return seen;
  Aim end = seen;
  end.named.clear();
  end.point = from.point + *length * direction(input, from, seen);
  return end;
}

void draw_end(const Ui& ui, const ViewInput& input, const Vec3& at) {
  if (const auto pixel = input.on_screen(at)) draw_dot(ui, *pixel, 4);
}

void draw_between(const Ui& ui, const ToolState& tool, const ViewInput& input, const Vec3& from,
                  const Vec3& to) {
  if (tool.tool == Tool::rod) {
    draw_body_outline(ui, input, rod_between(input, from, to));
  } else {
    const auto p = input.on_screen(from), q = input.on_screen(to);
    if (p && q) draw_line(ui, *p, *q, palette(ui.theme).accent, 2);
  }
  draw_end(ui, input, from);
}

} // namespace

void use_connecting(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  const bool entered = std::exchange(tool.place_now, false);
  if (!input.hovered && !tool.first) return;
  Aim aim = aim_at(context, input);
  std::string mistake;
  if (tool.first) {
    const Aim& from = *tool.first;
    aim = second_end(context.session, context.tool, input, from, aim, mistake);
    draw_between(context.ui, context.tool, input, from.point, aim.point);
    const ShownUnit unit = shown_unit("m", context.session.units);
    std::string head =
        "length " + (tool.typed.empty()
                         ? short_text(unit.shown((aim.point - from.point).norm()), 4) + " " + unit.text
                         : typed_text(tool.typed, unit.text));
    if (!aim.what.empty())
      head += ", " + aim.what;
    else if (tool.tool != Tool::rod && aim.body != ground_name)
      head += ", on " + aim.body;
    draw_aim(context.session, context.ui, input, aim, head);
  } else {
    draw_aim(context.session, context.ui, input, aim);
  }
  if (tool.spent) return;
  if (input.pressed && !tool.first) tool.first = aim;
  if ((!input.released && !entered) || !tool.first) return;
  const Aim from = *tool.first;
  if (!entered && !tool.first_clicked && !input.moved) {
    tool.first_clicked = true;
    tool.last_point = from.point;
    return;
  }
  if (!mistake.empty()) {
    context.session.notice = "“" + tool.typed + "” is no length. " + mistake;
    return;
  }
  if (const std::string reason = obstacle(tool.tool, from, aim); !reason.empty()) {
    context.session.notice = reason;
    if (!tool.first_clicked && !entered) tool.first.reset();
    return;
  }
  add(context.session, context.tool, input, from, aim);
  tool.last_point = aim.point;
  tool.spent = input.held; // Enter, while the button is down
  end_tool(context.tool, input);
}

} // namespace flyball
