#include "app/viewport/view_scene.hpp"

#include "app/viewport/body_form.hpp"

#include <algorithm>

namespace flyball {

namespace {

constexpr float glass = 0.5f; // alpha of the steady state beside the drawn pose

GhostColors steady_colors(const ViewFrame& frame) {
  GhostColors colors{body_colors(hues_for(*frame.mechanism, frame.colouring), frame.theme),
                     palette(frame.theme).slack};
  for (Color& color : colors.bodies)
    color.a = glass;
  colors.links.a = glass;
  return colors;
}

GhostColors one_color(const Mechanism& mechanism, Color color) {
  return {std::vector<Color>(mechanism.bodies.size(), color), color};
}

void add_loads(const ViewFrame& frame, const Palette& colors, ViewScene& scene) {
  constexpr float faded = 0.16f; // alpha
  const Assembly assembly(*frame.mechanism, frame.poses);
  scene.diagram = frame.loads_body >= 0;
  LoadScales scales;
  if (const Run* motion = frame.loads_motion) {
    std::optional<std::vector<Load>> diagram;
    if (scene.diagram) diagram = diagram_at(assembly, *motion, frame.loads_time, frame.loads_body);
    scene.diagram = diagram.has_value();
    scene.loads = diagram ? std::move(*diagram) : loads_at(assembly, *motion, frame.loads_time);
    scales = scene.diagram ? diagram_scales(assembly, *motion, frame.loads_body, scene.loads)
                           : motion_load_scales(assembly, *motion, frame.load_lengths);
  } else {
    scene.loads = loads_of(assembly, *frame.loads, frame.loads_turning, frame.loads_body, frame.loads_turn);
    scales = load_scales(assembly, scene.loads,
                         scene.diagram ? std::optional(LoadLengths::in_proportion) : frame.load_lengths);
  }
  if (frame.load_scales) scales = *frame.load_scales;
  scene.arrows = load_arrows(assembly, scene.loads, scales, colors, scene.diagram);
  for (const Instance& instance : scene.arrows.solids)
    scene.solid.bounds.add(instance_bounds(instance));
  if (!scene.diagram) return;
  for (Instance instance : scene.solid.instances) {
    const bool chosen = instance.part == PartId{PartKind::body, frame.loads_body};
    if (!chosen) instance.color.a = faded;
    (chosen ? scene.free_body : scene.others).push_back(instance);
  }
}

void hide(const std::vector<PartId>& parts, std::vector<Instance>& list) {
  if (parts.empty()) return;
  std::erase_if(
      list, [&](const Instance& instance) { return std::ranges::find(parts, instance.part) != parts.end(); });
}

} // namespace

SceneList scene_of(const ViewFrame& frame) {
  if (!frame.mechanism) return {};
  SceneList scene = build_scene(*frame.mechanism, frame.poses,
                                {.theme = frame.theme,
                                 .joints = frame.options.joints,
                                 .drives = frame.options.drives,
                                 .forces = frame.options.forces,
                                 .cut_joints = frame.cut_joints,
                                 .colouring = frame.colouring});
  hide(frame.hidden, scene.instances);
  return scene;
}

namespace {

ViewScene whole_scene(const ViewFrame& frame) {
  ViewScene scene;
  scene.solid = scene_of(frame);
  if (!frame.mechanism) return scene;
  const Mechanism& mechanism = *frame.mechanism;
  const Palette& colors = palette(frame.theme);
  if ((frame.loads || frame.loads_motion) && frame.poses.size() == mechanism.bodies.size())
    add_loads(frame, colors, scene);
  const std::size_t bodies = mechanism.bodies.size();
  for (std::size_t b = 0; bodies > 0 && b + bodies <= frame.motion.size(); b += bodies)
    for (Instance& instance : build_ghost(mechanism, frame.motion.subspan(b, bodies), colors.motion))
      scene.motion.push_back(std::move(instance));
  if (frame.ghost.empty() || !scene.others.empty()) return scene; // a diagram has no second pose
  const std::vector<Pose> as_drawn = drawn_poses(mechanism);
  const std::span<const Pose> solid = frame.poses.size() == as_drawn.size() ? frame.poses : as_drawn;
  if (frame.ghost_pose == GhostPose::steady)
    scene.ghost = build_ghost(mechanism, frame.ghost, steady_colors(frame), solid);
  scene.drawn_is_solid = frame.ghost_pose == GhostPose::steady;
  scene.drawn = scene.drawn_is_solid
                    ? build_ghost(mechanism, solid, one_color(mechanism, colors.drawn), frame.ghost)
                    : build_ghost(mechanism, frame.ghost, one_color(mechanism, colors.drawn), solid);
  return scene;
}

} // namespace

ViewScene view_scene(const ViewFrame& frame) {
  ViewScene scene = whole_scene(frame);
  for (std::vector<Instance>* list : {&scene.ghost, &scene.motion, &scene.drawn})
    hide(frame.hidden, *list);
  return scene;
}

} // namespace flyball
