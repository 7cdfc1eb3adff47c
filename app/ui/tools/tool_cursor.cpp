#include "app/ui/tools/tool_cursor.hpp"

#include "app/document/drawn_size.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/viewport/picking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace flyball {

namespace {

constexpr double aside = 70; // points from one place to the next that may be free

// How far the point is from the second nearest of the bodies: where two meet it is none. `bodies` in order.
double distance_to_second(const ViewContext& context, const std::vector<int>& bodies, const Vec3& point) {
  std::array<double, 2> nearest{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  int of_nearest = -1;
  for (const Instance& solid : cached_scene(context).instances) {
    if (solid.part.kind != PartKind::body) break; // bodies come first
    if (!std::ranges::binary_search(bodies, solid.part.index)) continue;
    const double away = std::max(surface_distance(solid, point), 0.0);
    if (away < nearest[0]) {
      if (solid.part.index != of_nearest) nearest[1] = nearest[0];
      nearest[0] = away;
      of_nearest = solid.part.index;
    } else if (solid.part.index != of_nearest) {
      nearest[1] = std::min(nearest[1], away);
    }
  }
  return nearest[bodies.size() < 2 ? 0 : 1];
}

// Whether at a point of the drawn pose a joint stands already that joins two of the bodies, or one of them
// and `ground`.
bool has_joint(const Mechanism& mechanism, const std::vector<int>& bodies, bool ground, const Vec3& point,
               double reach) {
  const auto is_of = [&](const std::string& name) {
    return name == ground_name ? ground : std::ranges::binary_search(bodies, body_index(mechanism, name));
  };
  return std::ranges::any_of(mechanism.joints, [&](const Joint& joint) {
    if (joint.type == JointType::gear || !std::ranges::all_of(joint.bodies, is_of)) return false;
    if (joint.type != JointType::distance) return (joint.at - point).norm() < reach;
    return std::ranges::any_of(joint.points, [&](const Vec3& end) { return (end - point).norm() < reach; });
  });
}

// Where a joint, link or force is most likely wanted: the point where the selected bodies meet, or any two; a
// joint rather where there is none.
std::optional<Vec3> likely_point(const ViewContext& context) {
  const Mechanism& mechanism = context.session.mechanism();
  std::vector<int> bodies;
  for (const std::string& name : context.session.selection().names(PartKind::body))
    bodies.push_back(body_index(mechanism, name));
  if (context.tool.tool != Tool::joint && context.tool.tool != Tool::bearing && !bodies.empty())
    return mechanism.bodies[static_cast<std::size_t>(bodies.front())].position;
  const std::size_t selected = bodies.size();
  if (bodies.empty())
    for (int i = 0; i < static_cast<int>(mechanism.bodies.size()); ++i)
      bodies.push_back(i);
  std::ranges::sort(bodies);
  const bool ground = selected < 2; // may be meant
  std::optional<Vec3> best;
  const double reach = 1e-6 * drawn_size(mechanism);
  std::tuple<bool, double, bool> least{true, std::numeric_limits<double>::max(), true};
  for (const SnapPoint& snap : cached_snap_points(context.session, context.tool)) {
    if (snap.part.kind == PartKind::none) continue;
    // Rather a body's own point than that of a joint that is there already.
    const std::tuple<bool, double, bool> worth{
        context.tool.tool == Tool::joint && has_joint(mechanism, bodies, ground, snap.point, reach),
        distance_to_second(context, bodies, snap.point), snap.part.kind != PartKind::body};
    if (worth >= least) continue;
    least = worth;
    best = snap.point;
  }
  return best;
}

bool is_free(const ViewContext& context, Vec2 pixel, ViewSize view) {
  const auto& all = cached_scene(context).instances;
  const auto last =
      std::ranges::find_if_not(all, [](const Instance& i) { return i.part.kind == PartKind::body; });
  return !pick(std::span<const Instance>(all.begin(), last), context.view.camera.ray(pixel, view),
               20 * static_cast<double>(context.ui.scale));
}

Vec2 first_place(const ViewContext& context, ViewSize view) {
  const Vec2 middle(view.width / 2, view.height / 2);
  switch (context.tool.tool) {
  case Tool::ball:
  case Tool::block:
  case Tool::plate:
  case Tool::disc:
  case Tool::rod: {
    const double step = aside * static_cast<double>(context.ui.scale);
    for (Vec2 place = middle; place.x() < view.width - step; place.x() += step)
      if (is_free(context, place, view)) return place;
    return middle;
  }
  default: break;
  }
  const auto point = likely_point(context);
  return point ? context.view.camera.project(*point, view).value_or(middle) : middle;
}

// A point of the mechanism as it is seen, in the order in which keys go from one to the next.
struct SeenPoint {
  double x, y;  // pixels, whole ones
  double depth; // m, away from the eye
  Vec3 point;

  std::tuple<double, double, double> order() const { return {x, y, depth}; }
};

std::vector<SeenPoint> seen_points(const ViewContext& context, ViewSize view) {
  const ViewCamera& camera = context.view.camera;
  std::vector<SeenPoint> seen;
  for (const SnapPoint& snap : cached_snap_points(context.session, context.tool)) {
    if (context.tool.tool == Tool::point && snap.named.empty()) continue;
    if (const auto at = camera.project(snap.point, view))
      if (at->x() >= 0 && at->y() >= 0 && at->x() < view.width && at->y() < view.height)
        seen.push_back({std::round(at->x()), std::round(at->y()),
                        -camera.backward().dot(snap.point - camera.target), snap.point});
  }
  std::ranges::sort(seen, {}, &SeenPoint::order);
  return seen;
}

// Left to right, top to bottom, and from front to back where one lies behind another. The cursor goes there.
void go_to_next_point(const ViewContext& context, const Vec2& from, ViewSize view, bool back) {
  ToolState& tool = context.tool;
  const std::vector<SeenPoint> seen = seen_points(context, view);
  if (seen.empty()) return;
  // Where the cursor is, it is on the point that was gone to, or else on what is in front there.
  const auto at_cursor = [&](const SeenPoint& p) {
    return p.x == std::round(from.x()) && p.y == std::round(from.y());
  };
  auto now = std::ranges::find_if(
      seen, [&](const SeenPoint& p) { return at_cursor(p) && tool.cursor_at == p.point; });
  if (now == seen.end()) now = std::ranges::find_if(seen, at_cursor);
  const auto count = static_cast<std::ptrdiff_t>(seen.size());
  const bool on_point = now != seen.end();
  if (!on_point) {
    const SeenPoint cursor{std::round(from.x()), std::round(from.y()), 0, Vec3::Zero()};
    now = std::ranges::upper_bound(seen, cursor.order(), {}, &SeenPoint::order);
  }
  const std::ptrdiff_t next = now - seen.begin() + (back ? -1 : on_point ? 1 : 0);
  const SeenPoint& to = seen[static_cast<std::size_t>((next + count) % count)];
  tool.cursor = Vec2(to.x, to.y);
  tool.cursor_at = to.point;
}

// A step of the grid on the screen, a pixel with Shift.
double arrow_step(const Ui& ui, const ToolState& tool, const ViewState& state, const KeyPress& key,
                  ViewSize view) {
  if (key.shift) return 1;
  ViewInput input;
  input.size = view;
  input.camera = state.camera;
  input.point = static_cast<double>(ui.scale);
  const double step = tool.snap ? grid_step(input) / input.metres_per_pixel() : 10 * input.point;
  return key.ctrl ? 5 * step : step;
}

} // namespace

bool take_cursor_key(const ViewContext& context, const KeyPress& key, ViewSize view) {
  ToolState& tool = context.tool;
  const Vec2 now = tool.cursor.value_or(context.ui.keyboard.in_view.value_or(first_place(context, view)));
  const double step = arrow_step(context.ui, context.tool, context.view, key, view);
  Vec2 by = Vec2::Zero();
  switch (key.key) {
  case keys::right: by.x() = step; break;
  case keys::left: by.x() = -step; break;
  case keys::down: by.y() = step; break;
  case keys::up: by.y() = -step; break;
  case keys::page_down:
  case keys::page_up: go_to_next_point(context, now, view, key.key == keys::page_up); return true;
  case keys::enter:
    if (key.ctrl || key.shift) return false;
    tool.cursor = now;
    tool.cursor_click = true;
    return true;
  default: return false;
  }
  tool.cursor_at.reset();
  tool.cursor = (now + by).cwiseMax(Vec2::Zero()).cwiseMin(Vec2(view.width - 1, view.height - 1));
  return true;
}

void use_tool_cursor(const ViewContext& context, ViewInput& input) {
  ToolState& tool = context.tool;
  context.ui.keyboard.in_view = input.hovered ? std::optional(input.cursor) : std::nullopt;
  const bool click = std::exchange(tool.cursor_click, false);
  if (!context.ui.keyboard.by_key || context.session.mode != Mode::build || !places(tool.tool)) {
    tool.cursor.reset();
    tool.cursor_at.reset();
    return;
  }
  // A tool that was chosen by a key shows at once where Enter would put it.
  if (!tool.cursor && !input.hovered && !tool.first && !tool.joint)
    tool.cursor = first_place(context, input.size);
  if (!tool.cursor) return;
  input.cursor = *tool.cursor;
  input.hovered = true;
  input.pressed = input.released = click;
  input.active = input.held = input.moved = false;
}

void follow_tool_cursor(const Session& session, Ui& ui, ToolState& tool, std::uint64_t revision_before,
                        bool joining_before) {
  if (!ui.keyboard.by_key) return;
  if (tool.joint && !joining_before) focus_widget(ui, "tools/join");
  if (session.document.revision() != revision_before && tool.tool == Tool::select && tool.cursor)
    focus_widget(ui, "inspector/name");
}

} // namespace flyball
