#include "app/ui/tools/aim.hpp"

#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/viewport/picking.hpp"
#include "app/viewport/snapping.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double grid_gap = 12; // points between lines, at least

int body_of(const std::optional<Hit>& hit) {
  return hit ? hit->part.index : -1;
}

std::string name_of(const Mechanism& mechanism, int body) {
  return body < 0 ? std::string(ground_name) : mechanism.bodies[static_cast<std::size_t>(body)].name;
}

// The bodies that a snap point belongs to.
std::vector<std::string> owners(const Mechanism& mechanism, const SnapPoint& snap) {
  const PartId id = find_part(mechanism, snap.part);
  const auto i = static_cast<std::size_t>(id.index);
  const auto at_point = [&](const std::array<std::string, 2>& bodies, const std::array<Vec3, 2>& points) {
    const bool second = (points[1] - snap.point).norm() < (points[0] - snap.point).norm();
    return std::vector<std::string>{bodies[second ? 1 : 0]};
  };
  switch (id.kind) {
  case PartKind::none: return {};
  case PartKind::body: return {snap.part.name};
  case PartKind::joint: {
    const Joint& joint = mechanism.joints[i];
    if (joint.type == JointType::distance) return at_point(joint.bodies, joint.points);
    return {joint.bodies[1], joint.bodies[0]};
  }
  case PartKind::force: return at_point(mechanism.forces[i].bodies, mechanism.forces[i].points);
  }
  return {};
}

// The body that is meant by a snap point: the one that is seen there if it may be it.
std::string body_at(const Mechanism& mechanism, const SnapPoint& snap, const std::optional<Hit>& hit,
                    std::span<const Instance> instances, double slack) {
  const std::vector<std::string> all = owners(mechanism, snap);
  const std::string seen = name_of(mechanism, body_of(hit));
  if (hit) {
    if (std::ranges::find(all, seen) != all.end()) return seen;
    for (const Instance& instance : instances)
      if (instance.part == hit->part && surface_distance(instance, snap.point) < slack) return seen;
  }
  for (const std::string& body : all)
    if (body != ground_name) return body;
  return std::string(ground_name);
}

bool is_rod(const Instance& instance) {
  const bool round = instance.primitive == Primitive::capsule || instance.primitive == Primitive::cylinder;
  return round && instance.extent.z() > 2 * (instance.round + instance.extent.x());
}

// The place on the rod's centre line nearest to the ray, a round distance from its end.
Vec3 on_rod(const Instance& rod, const Ray& ray, double step) {
  const Vec3 axis = rod.rotation * Vec3::UnitZ();
  const double half = rod.extent.z() + (rod.primitive == Primitive::cylinder ? rod.round : 0);
  const Vec3 end = rod.position - half * axis;
  const Vec3 away = ray.origin - end;
  const double cosine = axis.dot(ray.direction);
  double along = (away.dot(axis) - cosine * away.dot(ray.direction)) / std::max(1 - cosine * cosine, 1e-6);
  if (step > 0) along = round_to(along, step);
  Vec3 point = end + std::clamp(along, 0.0, 2 * half) * axis;
  // Sums of round numbers are round but for their last digits.
  for (double& x : point)
    if (step > 0) x = round_to(x, 1e-6 * step);
  return point;
}

// The snap point that the cursor means: one that the keyboard has gone to, or the nearest in the picture.
const SnapPoint* aimed_snap(const ViewContext& context, const ViewInput& input, double reach) {
  const std::vector<SnapPoint>& points = cached_snap_points(context.session, context.tool);
  const std::optional<Vec3>& meant = context.tool.cursor_at;
  const auto at = meant ? input.camera.project(*meant, input.size) : std::nullopt;
  if (at && (*at - input.cursor).norm() < 1)
    if (const auto found = std::ranges::find(points, *meant, &SnapPoint::point); found != points.end())
      return &*found;
  return snap_point(points, input.camera, input.size, input.cursor, reach);
}

Aim find_aim(const ViewContext& context, const ViewInput& input) {
  const Mechanism& mechanism = context.session.mechanism();
  const SceneList& scene = cached_scene(context);
  // Bodies come first in the list. A joint's sign in front of one does not hide it.
  const auto last = std::ranges::find_if_not(scene.instances,
                                             [](const Instance& i) { return i.part.kind == PartKind::body; });
  const std::span<const Instance> bodies(scene.instances.begin(), last);
  const Ray ray = input.ray();
  const auto hit = pick(bodies, ray, 2 * input.point);
  const bool snap = snaps(context.tool, input);
  const double reach = snap_reach * input.point;

  Aim aim;
  aim.step = snap ? grid_step(input) : 0;
  aim.plane = work_plane(input.camera, context.tool.last_point.value_or(Vec3::Zero()));
  if (const SnapPoint* point = snap ? aimed_snap(context, input, reach) : nullptr) {
    aim.plane.through = aim.point = point->point;
    aim.what = point->what;
    aim.named = point->named;
    aim.body = body_at(mechanism, *point, hit, bodies, reach * input.metres_per_pixel());
    return aim;
  }
  if (hit) {
    const Instance& met = bodies[hit->instance];
    aim.body = name_of(mechanism, hit->part.index);
    aim.plane.through = met.position;
    if (is_rod(met)) {
      aim.plane.through = aim.point = on_rod(met, ray, aim.step);
      return aim;
    }
  }
  auto point = meet(aim.plane, ray);
  if (!point) {
    aim.plane.through = input.camera.target;
    point = meet(aim.plane, ray);
  }
  aim.point = point.value_or(input.camera.target);
  if (aim.step > 0)
    aim.point = on_grid(aim.point, free_coordinates(Handle::plane, aim.plane.normal), aim.step);
  return aim;
}

// Lines of the grid near the place, fading with the distance.
void draw_grid(const Ui& ui, const ViewInput& input, const Aim& aim) {
  if (aim.step <= 0) return;
  constexpr int reach = 7;
  const Color ink = palette(ui.theme).grid;
  const Vec3 a = Vec3::Unit((aim.plane.normal + 1) % 3), b = Vec3::Unit((aim.plane.normal + 2) % 3);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float thick = std::max(1.f, std::round(ui.scale));
  for (const auto& [along, across] : {std::pair(a, b), std::pair(b, a)})
    for (int i = -reach; i <= reach; ++i)
      for (int k = -reach; k < reach; ++k) {
        const double away = std::hypot(i, k + 0.5) / (reach + 0.5);
        if (away >= 1) continue;
        const Vec3 from = aim.point + aim.step * (i * across + k * along);
        const auto p = input.on_screen(from), q = input.on_screen(Vec3(from + aim.step * along));
        if (p && q) list.AddLine(*p, *q, packed(ink, static_cast<float>(1.2 * (1 - away))), thick);
      }
}

} // namespace

bool snaps(const ToolState& tool, const ViewInput& input) {
  return tool.snap != input.ctrl;
}

double grid_step(const ViewInput& input) {
  return step_above(grid_gap * input.point * input.metres_per_pixel());
}

const Aim& aim_at(const ViewContext& context, const ViewInput& input) {
  ToolCaches& cache = context.tool.caches;
  const std::uint64_t revision = context.session.document.revision();
  if (cache.aim_revision != revision || cache.aim_cursor != input.cursor ||
      cache.aim_camera != input.camera || cache.aim_size != input.size ||
      cache.aim_meant != context.tool.cursor_at || cache.aim_snaps != snaps(context.tool, input)) {
    cache.aim = find_aim(context, input);
    cache.aim_revision = revision;
    cache.aim_cursor = input.cursor;
    cache.aim_meant = context.tool.cursor_at;
    cache.aim_camera = input.camera;
    cache.aim_size = input.size;
    cache.aim_snaps = snaps(context.tool, input);
  }
  return cache.aim;
}

void draw_aim(const Session& session, const Ui& ui, const ViewInput& input, const Aim& aim,
              const std::string& head) {
  const auto center = input.on_screen(aim.point);
  if (!center) return;
  draw_grid(ui, input, aim);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = ui.scale;
  const double arm = 16 * input.point * metres_per_pixel(input.camera, aim.point, input.size);
  for (int i = 0; i < 3; ++i) {
    if (i == aim.plane.normal) continue;
    const auto p = input.on_screen(Vec3(aim.point - arm * Vec3::Unit(i)));
    const auto q = input.on_screen(Vec3(aim.point + arm * Vec3::Unit(i)));
    if (p && q) list.AddLine(*p, *q, packed(axis_color(ui.theme, i)), 1.5f * s);
  }
  if (!aim.what.empty()) draw_dot(ui, *center, 6, true);
  std::string title = head;
  if (title.empty() && !aim.what.empty()) title = aim.what;
  if (title.empty() && aim.body != ground_name) title = "on " + aim.body;
  draw_tag(ui, input, input.cursor, title, place_text(aim.point, aim.step, session.units));
}

} // namespace flyball
