// All that a view shows, as lists of solids: kept from picture to picture while only the camera moves or
// something is pointed at. No OpenGL.
#pragma once

#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball {

struct ViewOptions {
  bool grid = true;
  bool shadow = true;
  bool triad = true; // axes (and gravity) in the lower left corner
  bool joints = true, drives = true, forces = true;
  bool draft = false; // shadows less soft, coils flat: sooner drawn
  float scale = 1;    // pixels a point has: widths of lines that do not scale with the mechanism
};

// Which pose is shown beside the solid one. The drawn pose is always told by a dashed outline, the steady
// state by the bodies' colours: beside a steady state only the drawn pose's outline is drawn, beside the
// drawn pose, outlined like that, the steady state is of coloured glass.
enum class GhostPose { drawn, steady };

// All that one picture shows. Spans must live until it is drawn.
struct ViewFrame {
  const Mechanism* mechanism = nullptr; // null: an empty view
  std::span<const Pose> poses;          // solid; empty: the drawn pose
  std::span<const Pose> ghost;          // beside it; may be empty
  GhostPose ghost_pose = GhostPose::drawn;
  std::span<const Pose> motion; // amber, translucent: the motion; may be empty
  BodyColouring colouring;      // without: as the mechanism alone says
  ViewCamera camera;
  Theme theme = Theme::light;
  ViewOptions options;
  std::vector<PartId> selected;
  PartId hovered;
  std::span<const std::string> cut_joints; // names
};

// Of a frame, whatever its camera, selection and lines.
struct ViewScene {
  SceneList solid;
  std::vector<Instance> ghost, motion; // of glass
  // Outlined by dashes: solids of the drawn pose, of those bodies that stand elsewhere in the other pose.
  std::vector<Instance> drawn;
  bool drawn_is_solid = false; // they are among the solids; else there is nothing of them but the outline
};
ViewScene view_scene(const ViewFrame& frame);
// The solid list alone, for picking.
SceneList scene_of(const ViewFrame& frame);

} // namespace flyball
