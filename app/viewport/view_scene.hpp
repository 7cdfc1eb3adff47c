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

// All that one picture shows. Spans must live until it is drawn.
struct ViewFrame {
  const Mechanism* mechanism = nullptr; // null: an empty view
  std::span<const Pose> poses;          // solid: the equilibrium; empty: the drawn pose
  std::span<const Pose> ghost;          // grey, translucent: the drawn pose; may be empty
  std::span<const Pose> motion;         // amber, translucent: the damped motion; may be empty
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
  std::vector<Instance> ghost, motion;
};
ViewScene view_scene(const ViewFrame& frame);
// The solid list alone, for picking.
SceneList scene_of(const ViewFrame& frame);

} // namespace flyball
