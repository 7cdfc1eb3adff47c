// All that a view shows, as lists of solids: kept from picture to picture while only the camera moves or
// something is pointed at. No OpenGL.
#pragma once

#include "app/viewport/camera.hpp"
#include "app/viewport/motion_loads.hpp"
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
  std::span<const Pose> motion;                 // amber, translucent: the motion, or several times all bodies
  const Solution* loads = nullptr;              // of the solid poses, to draw what acts; null: nothing of it
  std::span<const AngularMotion> loads_turning; // of the bodies, at the drawn phase
  Quat loads_turn = Quat::Identity();           // since the drawn phase, which the solution is of
  const Run* loads_motion = nullptr;            // instead: of this motion, at
  double loads_time = 0;                        // this moment (s)
  // Its free-body diagram, in proportion, where that is known; -1: all loads.
  int loads_body = -1;
  std::optional<LoadLengths> load_lengths{}; // without: see load_scales()
  const LoadScales* load_scales = nullptr;   // those of another view; null: of its own loads
  BodyColouring colouring;                   // without: as the mechanism alone says
  ViewCamera camera;
  Theme theme = Theme::light;
  ViewOptions options;
  std::vector<PartId> selected;
  PartId hovered;
  std::vector<PartId> hidden;              // not drawn
  std::span<const std::string> cut_joints; // names
};

// Of a frame, whatever its camera, selection and lines.
struct ViewScene {
  SceneList solid;
  std::vector<Instance> ghost, motion; // of glass
  // Outlined by dashes: solids of the drawn pose, of those bodies that stand elsewhere in the other pose.
  std::vector<Instance> drawn;
  std::vector<Load> loads;
  LoadArrows arrows; // of them, drawn over everything else
  // In a free-body diagram: the solids of the body, and all others, which are drawn as glass. Empty
  // otherwise.
  std::vector<Instance> free_body, others;
  bool drawn_is_solid = false; // they are among the solids; else there is nothing of them but the outline
  bool diagram = false;        // the loads are the free-body diagram that the frame asked for
};
ViewScene view_scene(const ViewFrame& frame);
// The solid list alone, for picking.
SceneList scene_of(const ViewFrame& frame);

} // namespace flyball
