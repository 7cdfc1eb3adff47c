#include "app/viewport/scene_list.hpp"

#include "app/viewport/assembly.hpp"
#include "app/viewport/body_form.hpp"
#include "app/viewport/glyphs.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>

namespace flyball {

namespace {

// Where everything would sink to if the drives on ground turned through all their phases.
double lowest_point(const Assembly& assembly, const Bounds& drawn) {
  const Vec3& up = assembly.scale.up;
  // Along a slanted axis the box around the box is as far as one looks.
  const Vec3 half = 0.5 * (drawn.upper - drawn.lower);
  double low = up.dot(drawn.center()) - up.cwiseAbs().dot(half);
  for (std::size_t j = 0; j < assembly.mechanism.joints.size(); ++j) {
    const Joint& joint = assembly.mechanism.joints[j];
    if (joint.type != JointType::revolute && joint.type != JointType::cylindrical) continue;
    if (assembly.joint_bodies[j][0] >= 0 && assembly.joint_bodies[j][1] >= 0) continue;
    if (joint.coordinates.empty() || !joint.coordinates[0].drive) continue;
    const Vec3 axis = joint.axis.stableNormalized();
    const double tilt = axis.cross(up).norm();
    if (tilt < 1e-3) continue;
    double reach = 0;
    const auto include = [&](int body, const Vec3& at) {
      reach = std::max(reach, (assembly.point(body, at) - joint.at).cross(axis).norm());
    };
    for (std::size_t b = 0; b < assembly.mechanism.bodies.size(); ++b) {
      include(static_cast<int>(b), assembly.mechanism.bodies[b].position);
      for (const Attachment& a : assembly.attachments[b])
        include(static_cast<int>(b), a.at);
    }
    low = std::min(low, up.dot(joint.at) - tilt * (reach + 2.5 * assembly.scale.unit));
  }
  return low;
}

void add_bodies(Assembly& assembly, std::span<const Color> colors, std::vector<Instance>& list) {
  for (std::size_t i = 0; i < assembly.mechanism.bodies.size(); ++i)
    add_body(assembly, i, colors[i], list);
  assembly.balls.assign(assembly.mechanism.bodies.size(), 0);
  for (const Instance& solid : list)
    if (const auto i = static_cast<std::size_t>(solid.part.index);
        solid.primitive == Primitive::sphere && solid.position == assembly.poses[i].position)
      assembly.balls[i] = std::max(assembly.balls[i], solid.round);
}

bool finite(const Instance& instance) {
  return instance.position.allFinite() && instance.rotation.coeffs().allFinite() &&
         instance.extent.allFinite() && std::isfinite(instance.round);
}

} // namespace

SceneScale scene_scale(const Mechanism& mechanism) {
  const std::vector<Pose> drawn = drawn_poses(mechanism);
  return Assembly(mechanism, drawn).scale;
}

Bounds instance_bounds(const Instance& instance) {
  const Mat3 r = instance.rotation.toRotationMatrix();
  const Vec3& e = instance.extent;
  Vec3 low = -e, high = e;
  switch (instance.primitive) {
  case Primitive::cone:
  case Primitive::coil:
  case Primitive::open_coil: low.z() = 0; break;
  case Primitive::bowl: high.z() = 0; break;
  case Primitive::ring:
  case Primitive::arc:
  case Primitive::broken_ring:
  case Primitive::spiral: low.z() = high.z() = 0; break;
  default: break;
  }
  const Vec3 center = instance.position + r * (0.5 * (low + high));
  const Vec3 half = r.cwiseAbs() * (0.5 * (high - low)) + Vec3::Constant(instance.round);
  Bounds bounds;
  bounds.add(Vec3(center - half));
  bounds.add(Vec3(center + half));
  return bounds;
}

SceneList build_scene(const Mechanism& mechanism, std::span<const Pose> poses, const SceneOptions& options) {
  const std::vector<Pose> drawn = drawn_poses(mechanism);
  if (poses.size() != drawn.size()) poses = drawn;
  Assembly assembly(mechanism, poses);
  const Palette& colors = palette(options.theme);
  SceneList scene;
  scene.scale = assembly.scale;
  add_bodies(assembly, body_colors(hues_for(mechanism, options.colouring), options.theme), scene.instances);
  Sketch sketch(scene.instances);
  const std::unordered_set<std::string_view> cut(options.cut_joints.begin(), options.cut_joints.end());
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    if (options.joints) draw_joint(sketch, assembly, j, colors);
    if (options.joints && cut.contains(mechanism.joints[j].name)) draw_cut_mark(sketch, assembly, j, colors);
    if (options.drives) draw_drives(sketch, assembly, j, colors);
    if (options.forces) draw_joint_forces(sketch, assembly, j, colors);
  }
  if (options.forces)
    for (std::size_t f = 0; f < mechanism.forces.size(); ++f)
      draw_force(sketch, assembly, f, colors);

  std::erase_if(scene.instances, [](const Instance& instance) { return !finite(instance); });
  for (const Instance& instance : scene.instances)
    scene.bounds.add(instance_bounds(instance));
  Bounds all = scene.bounds;
  all.add(scene.scale.bounds);
  scene.floor = all.empty ? 0 : lowest_point(assembly, all) - 0.04 * scene.scale.unit;
  return scene;
}

std::vector<Instance> build_ghost(const Mechanism& mechanism, std::span<const Pose> poses, Color color) {
  return build_ghost(mechanism, poses, {std::vector<Color>(mechanism.bodies.size(), color), color}, {});
}

namespace {

// By body, whether it stands in the same place in both, as far as one can see.
std::vector<char> standing(std::span<const Pose> a, std::span<const Pose> b, double unit) {
  std::vector<char> same(a.size(), 0);
  if (a.size() != b.size()) return same;
  constexpr double little = 1e-3; // of the glyphs' size, or rad
  for (std::size_t i = 0; i < a.size(); ++i)
    same[i] = (a[i].position - b[i].position).norm() < little * unit &&
              a[i].rotation.angularDistance(b[i].rotation) < little;
  return same;
}

} // namespace

std::vector<Instance> build_ghost(const Mechanism& mechanism, std::span<const Pose> poses,
                                  const GhostColors& colors, std::span<const Pose> beside) {
  std::vector<Instance> list;
  if (poses.size() != mechanism.bodies.size()) return list;
  Assembly assembly(mechanism, poses);
  add_bodies(assembly, colors.bodies, list);
  const std::size_t links = list.size();
  Sketch sketch(list);
  const Palette& any = palette(Theme::light);
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    if (mechanism.joints[j].type == JointType::distance) draw_joint(sketch, assembly, j, any);
  for (std::size_t i = 0; i < list.size(); ++i) {
    list[i].color = i < links ? colors.bodies[static_cast<std::size_t>(list[i].part.index)] : colors.links;
    list[i].surface = Surface::plain;
  }
  const std::vector<char> same = standing(poses, beside, assembly.scale.unit);
  const auto stays = [&](int body) { return body < 0 || same[static_cast<std::size_t>(body)] != 0; };
  std::erase_if(list, [&](const Instance& i) {
    if (!finite(i) || i.role == Role::anchor) return true;
    if (i.part.kind == PartKind::body) return stays(i.part.index);
    const auto& ends = assembly.joint_bodies[static_cast<std::size_t>(i.part.index)];
    return stays(ends[0]) && stays(ends[1]) && !beside.empty();
  });
  return list;
}

} // namespace flyball
