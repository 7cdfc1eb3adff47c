#include "app/ui/tools/named_points.hpp"

#include "app/document/formula_edits.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/snapping.hpp"

#include <utility>
#include <vector>

namespace flyball {

namespace {

constexpr float dot = 3.5f, lift = 14; // points: of the mark, and how far the name is from it

bool are_shown(const Session& session, const ToolState& tool) {

  if (session.mode != Mode::build) return false;
  return places(tool.tool) || tool.grab || (tool.tool != Tool::pull && session.selection().empty());
}

struct Mark {
  ImVec2 at;
  WidgetRect name; // its plate
};

bool is_in(const WidgetRect& rect, ImVec2 at) {
  return at.x >= rect.from.x && at.y >= rect.from.y && at.x < rect.to.x && at.y < rect.to.y;
}

Mark mark_of(const Ui& ui, const NamedPoint& point, ImVec2 at) {
  const float s = ui.scale, pad = 4 * s;
  const ImVec2 size = ImGui::CalcTextSize(point.name.c_str());
  const ImVec2 from(at.x + lift * s, at.y - lift * s - size.y);
  return {at, {from, {from.x + size.x + 2 * pad, from.y + size.y + pad / 2}}};
}

void draw_mark(const Ui& ui, const NamedPoint& point, const Mark& mark, bool lit) {
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = packed(lit ? colors.accent : colors.text);
  list.AddLine(mark.at, {mark.name.from.x, mark.name.to.y}, ink, std::max(1.f, s));
  list.AddCircleFilled(mark.at, (dot + 1.5f) * s, packed(colors.panel));
  list.AddCircleFilled(mark.at, dot * s, ink);
  ImVec4 plate = colors.panel;
  plate.w = 0.9f;
  list.AddRectFilled(mark.name.from, mark.name.to, packed(plate), 3 * s);
  list.AddRect(mark.name.from, mark.name.to, ink, 3 * s, 0, std::max(1.f, s));
  list.AddText({mark.name.from.x + 4 * s, mark.name.from.y}, ink, point.name.c_str());
}

// Points that coincide are told apart by names one above the other.
std::vector<std::pair<const NamedPoint*, Mark>> marks(const Session& session, const Ui& ui,
                                                      const ViewInput& input) {
  std::vector<std::pair<const NamedPoint*, Mark>> all;
  for (const NamedPoint& point : session.mechanism().points) {
    const auto at = input.on_screen(point.at);
    if (!at) continue;
    Mark mark = mark_of(ui, point, *at);
    for (const auto& [other, before] : all)
      if (is_in(before.name, {mark.name.from.x + 1, mark.name.from.y + 1})) {
        const float up = mark.name.to.y - before.name.from.y + 2 * ui.scale;
        mark.name.from.y -= up;
        mark.name.to.y -= up;
      }
    all.emplace_back(&point, mark);
  }
  return all;
}

// The named point at the cursor, as tools snap.
const NamedPoint* point_near(const Session& session, const ViewInput& input) {
  std::vector<SnapPoint> named;
  for (const NamedPoint& point : session.mechanism().points)
    named.push_back({point.at, {}, {}, point.name});
  const SnapPoint* near = snap_point(named, input.camera, input.size, input.cursor, snap_reach * input.point);
  return near ? &session.mechanism().points[static_cast<std::size_t>(near - named.data())] : nullptr;
}

} // namespace

const NamedPoint* selected_point(const Session& session, const ToolState& tool) {
  if (tool.point.empty() || !session.selection().empty()) return nullptr;
  const int index = point_index(session.mechanism(), tool.point);
  return index < 0 ? nullptr : &session.mechanism().points[static_cast<std::size_t>(index)];
}

void select_point(Session& session, ToolState& tool, const std::string& name) {
  select(session, {});
  tool.point = name;
}

void use_points(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  tool.hovered_name.clear();
  if (!are_shown(context.session, context.tool)) return;
  const auto all = marks(context.session, context.ui, input);
  const ImVec2 cursor = input.on_screen(input.cursor);
  const bool can = input.hovered && !tool.grab && (tool.tool == Tool::point || !places(tool.tool)) &&
                   (!input.active || input.pressed || !input.moved);
  if (can) {
    for (const auto& [point, mark] : all)
      if (is_in(mark.name, cursor)) tool.hovered_name = point->name;
    const NamedPoint* near = tool.hovered_name.empty() ? point_near(context.session, input) : nullptr;
    if (near && (tool.tool == Tool::point || !part_under_cursor(context, input)))
      tool.hovered_name = near->name;
  }
  if (!tool.hovered_name.empty()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  const std::string& taken = tool.grab ? tool.grab->stands : tool.point;
  for (const auto& [point, mark] : all) {
    draw_mark(context.ui, *point, mark, point->name == tool.hovered_name || point->name == taken);
    context.ui.widgets["point/" + point->name] = mark.name;
  }
}

void begin_picking(Session& session, Ui& ui, ToolState& tool) {
  if (ui.fields.picking.empty()) return;
  set_tool(session, ui, tool, Tool::point);
  tool.standing = std::exchange(ui.fields.picking, {});
}

void pick_point(Session& session, ToolState& tool, const ViewInput& input) {
  if (!input.hovered || !input.clicked() || tool.spent) return;
  const std::string name = tool.hovered_name, vector = tool.standing;
  if (name.empty()) {
    session.notice = "There is no named point here: click a marked one.";
    return;
  }
  tool.tool = Tool::select;
  edit(session, "Stand at " + name,
       [&](Mechanism& mechanism, Selection&) { stand_at_point(mechanism, vector, name); });
}

void stand_at(Mechanism& mechanism, const std::string& vector, const std::string& name) {
  if (!name.empty() && !vector.empty()) stand_at_point(mechanism, vector, name);
}

} // namespace flyball
