#include "app/viewport/view_scene.hpp"

namespace flyball {

SceneList scene_of(const ViewFrame& frame) {
  if (!frame.mechanism) return {};
  return build_scene(*frame.mechanism, frame.poses,
                     {.theme = frame.theme,
                      .joints = frame.options.joints,
                      .drives = frame.options.drives,
                      .forces = frame.options.forces,
                      .cut_joints = frame.cut_joints});
}

ViewScene view_scene(const ViewFrame& frame) {
  ViewScene scene{scene_of(frame), {}, {}};
  if (!frame.mechanism) return scene;
  const Palette& colors = palette(frame.theme);
  if (!frame.ghost.empty()) scene.ghost = build_ghost(*frame.mechanism, frame.ghost, colors.ghost);
  if (!frame.motion.empty()) scene.motion = build_ghost(*frame.mechanism, frame.motion, colors.motion);
  return scene;
}

} // namespace flyball
