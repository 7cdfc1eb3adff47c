// Placing balls, discs, blocks and plates: a click takes a size that suits the view, a drag draws it out.
#include "app/document/formula_edits.hpp"
#include "app/ui/inspector/body_preview.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/joint_guess.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/tools/typed_size.hpp"
#include "app/ui/view_context.hpp"
#include "app/viewport/snapping.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace flyball {

namespace {

// Points of the picture that a size given by a click is near to.
constexpr double ball_size = 22, block_size = 56, plate_size = 110, disc_size = 55;

bool is_round(BodyForm form) {
  return form == BodyForm::ball || form == BodyForm::disc;
}

// What a disc that is begun there turns about: the rod that it sits on, or what is across the plane that it
// is placed in.
Vec3 disc_axis(const ViewContext& context, const Aim& from) {
  const std::optional<Vec3> shaft =
      from.what.empty() ? std::nullopt : shaft_axis(context.session.document.stored(), from.point);
  return shaft.value_or(Vec3::Unit(from.plane.normal));
}

// A quarter of its radius thick.
void lay_disc(NewBody& body, const Vec3& axis) {
  const Vec3 half = body.radius / 8 * axis;
  body.from = body.at - half;
  body.to = body.at + half;
}

// At a named point both ends of its centre line go as that is moved, and its mass centre with them.
void stand_disc_at(Mechanism& mechanism, const std::string& name, const NewBody& disc,
                   const std::string& point) {
  if (point.empty()) return;
  mechanism.bodies.back().density = disc.density;
  const Vec3 half = (disc.to - disc.from) / 2;
  for (const auto& [end, sign] : {std::pair(".from.", -1.), std::pair(".to.", 1.)})
    for (int i = 0; i < 3; ++i) {
      const double by = sign * half[i];
      const std::string beside = by == 0 ? "" : (by > 0 ? " + " : " - ") + number_text(std::abs(by)) + " m";
      set_expression(mechanism, "bodies." + name + ".shapes.0" + end + std::to_string(i),
                     point + "." + "xyz"[i] + beside);
    }
}

NewBody of_round_size(const ViewInput& input, BodyForm form, const Aim& at) {
  const double point = input.point * input.metres_per_pixel();
  NewBody body;
  body.form = form;
  body.at = at.point;
  body.radius = nearest_step((form == BodyForm::disc ? disc_size : ball_size) * point);
  body.size = Vec3::Constant(nearest_step((form == BodyForm::plate ? plate_size : block_size) * point));
  if (form == BodyForm::plate) body.size[at.plane.normal] = round_to(body.size.x() / 10, body.size.x() / 100);
  return body;
}

// From its centre to where the cursor is, in the plane across the view; of a disc what is off its axis.
NewBody drawn_out(const ViewInput& input, BodyForm form, const Aim& from, const Aim& to, const Vec3& axis) {
  NewBody body = of_round_size(input, form, from);
  const double least = from.step > 0 ? from.step : 4 * input.point * input.metres_per_pixel();
  const int normal = from.plane.normal;
  Vec3 corner = to.point;
  if (to.what.empty()) {
    // Whatever the cursor passes over, the hand stays in its plane.
    corner = meet({from.point, normal}, input.ray()).value_or(to.point);
  }
  Vec3 reach = corner - from.point;
  if (form == BodyForm::disc)
    reach -= reach.dot(axis) * axis;
  else
    reach[normal] = 0;
  const auto rounded = [&](double x) { return from.step > 0 ? round_to(x, from.step) : x; };
  if (is_round(form)) {
    body.radius = std::max(to.what.empty() ? rounded(reach.norm()) : reach.norm(), least);
    return body;
  }
  double smaller = 0;
  for (int i = 0; i < 3; ++i) {
    if (i == normal) continue;
    body.size[i] = std::max(2 * rounded(std::abs(reach[i])), least);
    smaller = smaller > 0 ? std::min(smaller, body.size[i]) : body.size[i];
  }
  body.size[normal] = form == BodyForm::block ? smaller : nearest_step(smaller / 10);
  return body;
}

// The radius, or the edges of a block; plates and discs are as thin as ever.
void take_typed_size(NewBody& body, double size, int normal) {
  body.radius = size;
  body.size = Vec3::Constant(size);
  if (body.form == BodyForm::plate) body.size[normal] = round_to(size / 10, size / 100);
}

std::string size_text(const NewBody& body, double step, const DisplayUnits& units) {
  const ShownUnit unit = shown_unit("m", units);
  if (is_round(body.form)) return "radius " + length_text(body.radius, step, units) + " " + unit.text;
  const auto edge = [&](double length) { return short_text(unit.shown(length), 4); };
  return edge(body.size.x()) + " × " + edge(body.size.y()) + " × " + edge(body.size.z()) + " " + unit.text;
}

} // namespace

void use_placing(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  const BodyForm form = tool.tool == Tool::ball    ? BodyForm::ball
                        : tool.tool == Tool::disc  ? BodyForm::disc
                        : tool.tool == Tool::block ? BodyForm::block
                                                   : BodyForm::plate;
  const bool entered = std::exchange(tool.place_now, false);
  if (!input.hovered && !tool.first) return;
  const Aim& aim = aim_at(context, input);
  const Aim from = tool.first.value_or(aim);
  const bool drawing = tool.first && input.moved;
  const Vec3 axis = form == BodyForm::disc ? disc_axis(context, from) : Vec3::Unit(from.plane.normal);
  NewBody body = drawing ? drawn_out(input, form, from, aim, axis) : of_round_size(input, form, from);
  std::string mistake;
  const bool typing = !tool.typed.empty();
  if (const auto size = typing ? typed_length(tool.typed, context.session.units, &mistake) : std::nullopt)
    take_typed_size(body, *size, from.plane.normal);
  if (form == BodyForm::disc) lay_disc(body, axis);
  draw_body_outline(context.ui, input, body);
  if (typing)
    draw_tag(context.ui, input, input.cursor, from.what,
             (is_round(form) ? "radius " : "edge ") +
                 typed_text(tool.typed, shown_unit("m", context.session.units).text));
  else if (drawing)
    draw_tag(context.ui, input, input.cursor, aim.what, size_text(body, from.step, context.session.units));
  else
    draw_aim(context.session, context.ui, input, from);
  if (tool.spent) return;
  if (input.pressed) tool.first = aim;
  if (!entered && (!input.released || !tool.first)) return;
  if (typing && !mistake.empty()) {
    context.session.notice = "“" + tool.typed + "” is no size. " + mistake;
    tool.first.reset();
    return;
  }
  edit(context.session, "Add " + form_name(form), [&](Mechanism& mechanism, Selection& selection) {
    const Part part{PartKind::body, add_body(mechanism, body)};
    if (form == BodyForm::disc)
      stand_disc_at(mechanism, part.name, body, from.named);
    else
      stand_at(mechanism, point_address(mechanism, {part, 0}), from.named);
    selection.set(part);
  });
  tool.last_point = from.point;
  tool.spent = input.held; // Enter, while the button is down
  end_tool(context.tool, input);
}

} // namespace flyball
