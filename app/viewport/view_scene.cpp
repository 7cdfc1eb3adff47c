#include "app/viewport/view_scene.hpp"

#include "app/viewport/body_form.hpp"

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

} // namespace

SceneList scene_of(const ViewFrame& frame) {
  if (!frame.mechanism) return {};
  return build_scene(*frame.mechanism, frame.poses,
                     {.theme = frame.theme,
                      .joints = frame.options.joints,
                      .drives = frame.options.drives,
                      .forces = frame.options.forces,
                      .cut_joints = frame.cut_joints,
                      .colouring = frame.colouring});
}

ViewScene view_scene(const ViewFrame& frame) {
  ViewScene scene;
  scene.solid = scene_of(frame);
  if (!frame.mechanism) return scene;
  const Mechanism& mechanism = *frame.mechanism;
  const Palette& colors = palette(frame.theme);
  if (!frame.motion.empty()) scene.motion = build_ghost(mechanism, frame.motion, colors.motion);
  if (frame.ghost.empty()) return scene;
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

} // namespace flyball
