// Pointing at parts, picking them, and framing them.
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/view_frame.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/box_select.hpp"
#include "app/viewport/picking.hpp"

#include <algorithm>
#include <array>

namespace flyball {

std::optional<Hit> part_under_cursor(const ViewContext& context, const ViewInput& input) {
  const double slack = 4 * input.point;
  return pick(shown_scene(context)->solid.instances, input.ray(), slack);
}

namespace {

// Looking along a ray takes longest in a mechanism of thousands of bodies: only where the hand moves, or the
// picture under it, which is another in a view of another size.
void point_at_parts(const ViewContext& context, const ViewInput& input) {
  const bool steering = input.active && (input.moved || !input.held);
  const bool handle = context.tool.hovered != Handle::none || context.tool.hovered_point ||
                      context.tool.grab || !context.tool.hovered_name.empty();
  if ((!input.hovered && !input.released) || steering || handle) {
    context.view.hovered = {};
    context.view.pointed_at = Vec2::Constant(-1);
    return;
  }
  ToolCaches& cache = context.tool.caches;
  const std::shared_ptr<const ViewScene>& scene = context.view.scene.scene;
  if (input.cursor == context.view.pointed_at && cache.hover_scene == scene &&
      cache.hover_camera == input.camera && cache.hover_size == input.size)
    return;
  context.view.pointed_at = input.cursor;
  cache.hover_scene = scene;
  cache.hover_camera = input.camera;
  cache.hover_size = input.size;
  const auto hit = part_under_cursor(context, input);
  context.view.hovered = hit ? hit->part : PartId{};
}

// A tool that attaches something shows to which body it would.
void point_at_body(const ViewContext& context, const ViewInput& input) {
  const Tool tool = context.tool.tool;
  const bool attaches = tool != Tool::ball && tool != Tool::block && tool != Tool::rod &&
                        tool != Tool::plate && tool != Tool::disc && tool != Tool::point;
  context.view.hovered = {};
  context.view.pointed_at = Vec2::Constant(-1);
  if (attaches && input.hovered)
    context.view.hovered =
        find_part(context.session.mechanism(), {PartKind::body, aim_at(context, input).body});
}

void click_part(Session& session, ToolState& tool, const ViewState& view, const ViewInput& input) {
  if (!tool.hovered_name.empty()) return select_point(session, tool, tool.hovered_name);
  tool.point.clear();
  const Part part = part_of(*shown_mechanism(session, tool), view.hovered);
  Selection selection = session.selection();
  if (!input.ctrl && !input.shift)
    selection.set(part);
  else
    selection.toggle(part);
  select(session, std::move(selection));
}

void select_framed(const ViewContext& context, const ViewInput& input) {
  const Mechanism& mechanism = *shown_mechanism(context.session, context.tool);
  Selection selection;
  if (input.shift) selection = context.session.selection();
  std::vector<Part> parts = selection.parts;
  for (const PartId id : parts_in_frame(
           part_anchors(mechanism, view_frame(context.session, context.ui, context.tool, context.view).poses),
           input.camera, input.size, {*context.tool.frame, input.cursor})) {
    Part part = part_of(mechanism, id);
    if (!input.shift || !selection.has(part)) parts.push_back(std::move(part));
  }
  selection.parts = std::move(parts);
  select(context.session, std::move(selection));
}

void draw_frame(const Ui& ui, const ToolState& tool, const ViewInput& input) {
  const ImVec2 a = input.on_screen(*tool.frame), b = input.on_screen(input.cursor);
  const ImVec2 from(std::min(a.x, b.x), std::min(a.y, b.y)), to(std::max(a.x, b.x), std::max(a.y, b.y));
  const Color& accent = palette(ui.theme).accent;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, to, packed(accent, 0.12f));
  list.AddRect(from, to, packed(accent), 0, 0, std::max(1.f, std::round(ui.scale)));
}

} // namespace

void use_selecting(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  if (places(tool.tool)) {
    point_at_body(context, input);
    return;
  }
  if (tool.frame && input.moved) draw_frame(context.ui, context.tool, input);
  point_at_parts(context, input);
  if (tool.grab || tool.spent) return;
  const bool handle = tool.hovered != Handle::none || tool.hovered_point;
  if (input.pressed && !handle &&
      (tool.tool == Tool::box || input.ctrl || (frames_with_left(context.view.navigation) && !input.alt)))
    tool.frame = input.cursor;
  if (!input.released) return;
  if (tool.frame && input.moved) {
    select_framed(context, input);
    tool.frame.reset();
    if (tool.tool == Tool::box && !input.shift) tool.tool = Tool::select;
  } else if (input.clicked() && !handle) {
    tool.frame.reset();
    click_part(context.session, context.tool, context.view, input);
  }
}

} // namespace flyball
