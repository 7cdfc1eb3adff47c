// The card beside the point of a joint or bearing to be made: which bodies, which type, which axis.
#include "app/render/icons.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/joint_guess.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/card.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/work_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace flyball {

namespace {

struct TypeChoice {
  JointType type;
  const char* title;
  const char* help;
};
constexpr std::array types{
    TypeChoice{JointType::revolute, "Revolute", "Turns about the axis, as a hinge."},
    TypeChoice{JointType::prismatic, "Prismatic", "Slides along the axis."},
    TypeChoice{JointType::cylindrical, "Cylindrical", "Turns about the axis and slides along it."},
    TypeChoice{JointType::universal, "Universal", "Turns about two axes, as a Cardan joint."},
    TypeChoice{JointType::spherical, "Spherical", "Turns freely about the point, as a ball in a socket."},
    TypeChoice{JointType::planar, "Planar", "Slides and turns in the plane across the axis."},
    TypeChoice{JointType::fixed, "Fixed", "Holds the two bodies together."},
    TypeChoice{JointType::free, "Free", "Holds nothing: places the child beside the parent."},
};

// The next button beside the last one, or below it where there is no room.
void wrap(float width) {
  const float room = ImGui::GetWindowContentRegionMax().x + ImGui::GetWindowPos().x;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  if (ImGui::GetItemRectMax().x + gap + width <= room) ImGui::SameLine(0, gap);
}

float button_width(const char* text) {
  return ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
}

bool same_direction(const Vec3& a, const Vec3& b) {
  return (a.normalized() - b.normalized()).norm() < 1e-9;
}

void set_axis(ToolState& tool, const Vec3& axis) {
  JointDraft& draft = *tool.joint;
  draft.axis = axis;
  draft.axis_chosen = true;
  draft.picking_axis = false;
  if (!draft.axis2_chosen || axis.cross(draft.axis2).norm() < 1e-6) {
    draft.axis2 = axis_across(axis);
    draft.axis2_chosen = false;
  }
}

// The axis that is offered for the type and the bodies, until one is chosen.
void offer_axis(const Session& session, ToolState& tool, const ViewInput& input) {
  JointDraft& draft = *tool.joint;
  if (draft.axis_chosen) return;
  set_axis(tool, guess_axis(session.mechanism(), tool.joint_type, draft.bodies, axis_in_view(input.camera)));
  draft.axis_chosen = false;
}

void set_bodies(Session& session, ToolState& tool, const ViewInput& input,
                const std::array<std::string, 2>& bodies) {
  JointDraft& draft = *tool.joint;
  draft.bodies = bodies;
  draft.bodies_chosen = true;
  if (tool.tool == Tool::joint) {
    const bool given_back = tool.type_aside && !sits_on_shaft(session.mechanism(), bodies, draft.at);
    if (given_back) tool.joint_type = *std::exchange(tool.type_aside, {}); // it was offered for the others
    // That of a hinge is across the picture, whichever the bodies are.
    if (given_back || tool.joint_type == JointType::prismatic || tool.joint_type == JointType::cylindrical)
      offer_axis(session, tool, input);
  }
  Selection selection;
  for (const std::string& body : bodies)
    if (body != ground_name) selection.add({PartKind::body, body});
  select(session, std::move(selection));
}

void body_rows(Session& session, Ui& ui, ToolState& tool, const ViewInput& input) {
  const std::vector<std::string> choices = body_choices(session.mechanism(), true);
  const std::array<std::string, 2> bodies = tool.joint->bodies;
  const auto take = [&](std::size_t end, const std::string& name) {
    std::array<std::string, 2> next = bodies;
    if (name == bodies[1 - end]) next[1 - end] = bodies[end];
    next[end] = name;
    set_bodies(session, tool, input, next);
  };
  const bool bearing = tool.tool == Tool::bearing;
  if (const auto name =
          name_choice_row(ui, "tools/parent", bearing ? "In" : "Parent", choices, bodies[0],
                          bearing ? bearing_in_help : "The body that coordinates are counted from."))
    take(0, *name);
  if (const auto name =
          name_choice_row(ui, "tools/child", bearing ? "Holds" : "Child", choices, bodies[1],
                          bearing ? bearing_holds_help : "The body that a positive coordinate moves."))
    take(1, *name);
  ImGui::SameLine(0, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, ImGui::GetStyle().FramePadding.y});
  ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).dim);
  if (ImGui::Button(icon::swap, {ImGui::GetContentRegionAvail().x, 0}))
    set_bodies(session, tool, input, {bodies[1], bodies[0]});
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  note_widget(ui.widgets, "tools/swap");
  help_on_hover("Swap the two.");
}

// A point beside both bodies is rarely what was meant.
void away_note(const Session& session, Ui& ui, const JointDraft& draft) {
  if (draft.away <= 0 || draft.bodies != draft.guessed) return;
  const ShownUnit unit = shown_unit("m", session.units);
  const std::string& body = draft.guessed[1];
  paragraph("The point is on no body: " + body + " is " + short_text(unit.shown(draft.away), 3) + " " +
                unit.text + " away.",
            colors_of(ui).warn);
  note_widget(ui.widgets, "tools/away");
}

void type_rows(const Session& session, Ui& ui, ToolState& tool, const ViewInput& input) {
  const float gap = 4 * ui.scale, width = (ImGui::GetContentRegionAvail().x - gap) / 2;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (i % 2) ImGui::SameLine(0, gap);
    const TypeChoice& type = types[i];
    const std::string name = "tools/type/" + std::string(type_name(type.type));
    if (!option_button(ui, name, type.title, tool.joint_type == type.type, type.help, width)) continue;
    tool.joint_type = type.type;
    tool.type_aside.reset();
    offer_axis(session, tool, input);
  }
  ImGui::PopStyleVar();
}

void axis_rows(Session& session, Ui& ui, ToolState& tool, const ViewInput& input) {
  JointDraft& draft = *tool.joint;
  const auto offer = [&](const std::string& id, const std::string& label, const Vec3& axis,
                         const char* help) {
    const bool on = !draft.picking_axis && same_direction(axis, draft.axis);
    if (option_button(ui, "tools/axis/" + id, label.c_str(), on, help)) set_axis(tool, axis);
  };
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * ui.scale, 4 * ui.scale});
  ImGui::AlignTextToFramePadding();
  const bool normal = tool.tool == Tool::joint && tool.joint_type == JointType::planar;
  ImGui::TextDisabled("%s", normal ? "Normal" : "Axis");
  const std::array<const char*, 3> letters{"X", "Y", "Z"}, ids{"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    ImGui::SameLine();
    offer(ids[k], letters[k], Vec3::Unit(i), "Along a world axis.");
  }
  const Vec3 sight = input.camera.backward();
  if (sight.cwiseAbs().maxCoeff() < 1 - 1e-9) {
    ImGui::SameLine();
    offer("view", "View", sight, "Along the line of sight, towards the eye.");
  }
  constexpr const char* two_points = "Two points…";
  wrap(button_width(two_points));
  if (option_button(ui, "tools/axis/points", two_points, draft.picking_axis,
                    "Click two points that it goes through.")) {
    draft.picking_axis = !draft.picking_axis;
    draft.axis_from.reset();
  }
  for (const BodyAxis& axis : body_axes(session.mechanism(), draft.bodies)) {
    wrap(button_width(axis.label.c_str()));
    offer(axis.label, axis.label, axis.axis, "An axis of the body.");
  }
  ImGui::PopStyleVar();
}

void second_axis_row(Ui& ui, ToolState& tool) {
  JointDraft& draft = *tool.joint;
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", tool.joint_type == JointType::planar ? "First slide" : "Second axis");
  const std::array<const char*, 3> letters{"X", "Y", "Z"}, ids{"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const Vec3 unit = Vec3::Unit(i);
    if (draft.axis.cross(unit).norm() < 1e-6) continue;
    // At right angles to the first: what slides and crosses are made of.
    const Vec3 across = (unit - draft.axis * draft.axis.dot(unit) / draft.axis.squaredNorm()).normalized();
    const auto k = static_cast<std::size_t>(i);
    ImGui::SameLine(0, 4 * ui.scale);
    if (!option_button(ui, std::string("tools/axis2/") + ids[k], letters[k],
                       same_direction(across, draft.axis2),
                       "As near to the world axis as it can be, across the first."))
      continue;
    draft.axis2 = across;
    draft.axis2_chosen = true;
  }
}

// What the solids of the two bodies first offered cover of the window, a rectangle each: others that are
// chosen do not move the card.
std::vector<PanelRect> covered_by_bodies(const ViewContext& context, const ViewInput& input) {
  std::vector<PanelRect> covered;
  const std::array<std::string, 2>& names = context.tool.joint->guessed;
  for (const Instance& solid : cached_scene(context).instances) {
    if (solid.part.kind != PartKind::body) continue;
    const std::string& name =
        context.session.mechanism().bodies[static_cast<std::size_t>(solid.part.index)].name;
    if (name != names[0] && name != names[1]) continue;
    const Bounds box = instance_bounds(solid);
    ImVec2 low(1e9f, 1e9f), high(-1e9f, -1e9f);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 at(corner & 1 ? box.upper.x() : box.lower.x(), corner & 2 ? box.upper.y() : box.lower.y(),
                    corner & 4 ? box.upper.z() : box.lower.z());
      const auto pixel = input.on_screen(at);
      if (!pixel) continue;
      low = {std::min(low.x, pixel->x), std::min(low.y, pixel->y)};
      high = {std::max(high.x, pixel->x), std::max(high.y, pixel->y)};
    }
    if (low.x < high.x) covered.push_back({low.x, low.y, high.x - low.x, high.y - low.y});
  }
  return covered;
}

float common_area(const PanelRect& a, ImVec2 from, ImVec2 size) {
  const float width = std::min(a.x + a.width, from.x + size.x) - std::max(a.x, from.x);
  const float height = std::min(a.y + a.height, from.y + size.y) - std::max(a.y, from.y);
  return std::max(width, 0.f) * std::max(height, 0.f);
}

// Beside the point, rather on the side where less of the mechanism is, and within the view, beside the tools
// and above what is written at its foot; below the legend, on the other side or in a corner where the card
// would lie on that or on the bodies that are joined.
void place_card(const ViewContext& context, const ViewInput& input, ImVec2 size) {
  const float s = context.ui.scale, gap = 28 * s, least_gap = 14 * s, edge = 8 * s;
  const PanelRect& rect = input.rect;
  const WidgetMap& widgets = context.ui.widgets;
  const ImVec2 corner(rect.x, rect.y);
  const ImVec2 at = input.on_screen(context.tool.joint->at).value_or(corner);
  const ImVec2 middle = input.on_screen(cached_scene(context).bounds.center()).value_or(corner);
  const auto tools = widgets.find("tool strip");
  const float most = rect.x + rect.width - size.x - edge,
              least = (tools == widgets.end() ? rect.x : tools->second.to.x) + edge;
  const float right = at.x + gap, left = std::max(at.x - gap - size.x, least);
  const bool to_left = left + size.x + least_gap <= at.x && (at.x < middle.x || right > most);
  ImVec2 from(to_left || (right > most && at.x > rect.x + rect.width / 2) ? left : right, at.y - 100 * s);
  const float top = rect.y + edge, foot = std::max(top, context.view.lines_top - size.y - edge);
  from.x = std::clamp(from.x, least, std::max(least, most));
  from.y = std::clamp(from.y, top, foot);
  const std::vector<PanelRect> covered = covered_by_bodies(context, input);
  PanelRect shown{};   // the legend
  ImVec2 below = from; // that
  if (const auto legend = widgets.find("legend frame"); legend != widgets.end()) {
    const auto& [upper, lower] = legend->second;
    shown = {upper.x, upper.y, lower.x - upper.x, lower.y - upper.y};
    below.y = std::clamp(std::max(from.y, lower.y + edge), top, foot);
  }
  const float rim = 3 * s; // of the card, which may touch a body
  const PanelRect point{at.x - least_gap, at.y - least_gap, 2 * least_gap, 2 * least_gap};
  const auto hidden = [&](ImVec2 place) {
    // The point is what the card is about: hiding it is worse than hiding bodies.
    if (common_area(point, place, size) > 0) return 1e9f;
    float area = common_area(shown, place, size);
    for (const PanelRect& each : covered)
      area += common_area(each, {place.x + rim, place.y + rim}, {size.x - 2 * rim, size.y - 2 * rim});
    return area;
  };
  const float other = std::clamp(to_left ? right : left, least, std::max(least, most));
  for (const ImVec2 place : {below, ImVec2(other, from.y), ImVec2(std::max(least, most), foot),
                             ImVec2(std::max(least, most), top), ImVec2(least, foot), ImVec2(least, top)})
    if (hidden(place) < 0.8f * hidden(from)) from = place;
  // Where a small view leaves the point no place: rather over the panel beside it.
  const float ring = 8 * s, farthest = ImGui::GetIO().DisplaySize.x - size.x - edge;
  const PanelRect drawn{at.x - ring, at.y - ring, 2 * ring, 2 * ring};
  if (common_area(drawn, from, size) > 0 && right <= farthest) from = {right, from.y};
  ImGui::SetNextWindowPos({std::round(from.x), std::round(from.y)});
}

} // namespace

void joint_card(const ViewContext& context, const ViewInput& input) {
  if (!context.tool.joint) return;
  const float s = context.ui.scale;
  const bool bearing = context.tool.tool == Tool::bearing;
  // It has a place for all the rows that a type and two bodies bring: more of them do not move it.
  const float most_rows = bearing ? 0 : 12.5f * (ImGui::GetFrameHeight() + 4 * s);
  const ImVec2 size(264 * s, std::max(context.tool.card_height, most_rows));
  place_card(context, input, size);
  ImGui::SetNextWindowSize({size.x, 0});
  // Each has a window of its own, which begins as tall as it was last.
  begin_card(bearing ? "bearing" : "joint", s, ImGui::GetStyle().WindowPadding, ImGuiWindowFlags_NoScrollbar);
  heading(context.ui, bearing ? "Bearing" : "Join");
  body_rows(context.session, context.ui, context.tool, input);
  away_note(context.session, context.ui, *context.tool.joint);
  ImGui::Dummy({0, s});
  if (!bearing) type_rows(context.session, context.ui, context.tool, input);
  if (bearing || has_axis(context.tool.joint_type))
    axis_rows(context.session, context.ui, context.tool, input);
  if (!bearing && has_axis2(context.tool.joint_type)) second_axis_row(context.ui, context.tool);
  ImGui::Dummy({0, 2 * s});
  // The card stays as tall as it was: fewer rows do not move what is clicked next.
  const float foot =
      context.tool.joint->card_height - ImGui::GetStyle().WindowPadding.y - ImGui::GetFrameHeight();
  ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY(), foot));
  if (text_button(context.ui, "tools/join", bearing ? "Insert" : "Join", true)) {
    make_joint(context.session, context.ui, context.tool);
  } else {
    ImGui::SameLine();
    if (text_button(context.ui, "tools/cancel", "Cancel")) {
      select(context.session, context.tool.joint->before);
      context.tool.joint.reset();
    }
  }
  context.tool.card_height = std::max(context.tool.card_height, ImGui::GetWindowHeight());
  if (context.tool.joint)
    context.tool.joint->card_height = std::max(context.tool.joint->card_height, ImGui::GetWindowHeight());
  ImGui::End();
}

} // namespace flyball
