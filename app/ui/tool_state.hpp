// What the hand on the view is about to do, and how far it has come with it.
#pragma once

#include "app/document/snap_points.hpp"
#include "app/document/transform.hpp"
#include "app/ui/tools/hand_state.hpp"
#include "app/viewport/camera.hpp"
#include "app/viewport/gizmo.hpp"
#include "app/viewport/scene_list.hpp"
#include "app/viewport/work_plane.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace flyball {

struct ViewScene;

enum class Tool {
  select, // and move with the gizmo
  rotate, // select, and turn with the gizmo
  pull,   // bodies, along their joints or by a spring
  box,    // select what a dragged frame holds
  ball,
  block,
  rod,
  plate,
  disc,
  joint,    // of any type but distance and gear
  distance, // between two points, as springs and dampers
  spring,
  damper,
  bearing, // placed as joints are
  force,
  torque,
  drag,
  vane,
  point, // a named one, where a vector shall stand
};

// A place that a click would mean.
struct Aim {
  Vec3 point = Vec3::Zero(); // m, drawn pose
  std::string body{ground_name};
  std::string what;  // that it snapped to: "arm1", "centre of ball1"; empty: to nothing
  std::string named; // the named point there
  WorkPlane plane;   // that the cursor moves on
  double step = 0;   // m, of the plane's grid; 0: none
};

// A handle of the gizmo, or a point of the selected part, held by the hand.
struct Grab {
  Handle handle = Handle::plane;
  std::optional<PointId> point; // where it is a point
  std::string named;            // or a named point
  int normal = 2;               // as in Gizmo
  std::shared_ptr<const Mechanism> before;
  Selection selection;
  Vec3 centre = Vec3::Zero(); // m, of what is moved, as it was
  Ray from;
  std::vector<SnapPoint> targets; // that do not move along
  std::uint64_t gesture = 0;
  std::string name;            // of the step
  Vec3 by = Vec3::Zero();      // m, so far
  double angle = 0, swept = 0; // rad, so far; swept: without snapping
  std::string what;            // that it snapped to
  std::string stands;          // the named point there, at which it stays
  std::string typed;           // a number instead of the hand's
  bool shift = false;          // held when it was moved last
};

// A joint or bearing before it is made.
struct JointDraft {
  Vec3 at = Vec3::Zero();             // m
  std::string named{};                // the named point there
  std::array<std::string, 2> bodies;  // parent, child
  std::array<std::string, 2> guessed; // the same, before the person chose: the card keeps clear of these
  double away = 0;                    // m, of the point from what was guessed; 0 where it is on it
  Vec3 axis = Vec3::UnitZ(), axis2 = Vec3::UnitX();
  bool bodies_chosen = false, axis_chosen = false, axis2_chosen = false; // by the person
  bool picking_axis = false;                                             // by two points
  std::optional<Vec3> axis_from;                                         // the first of them
  Selection before;                                                      // selected when it was begun
  float card_height = 0; // pixels, the most that its card has taken
};

// Kept so that nothing is looked for twice while neither hand nor mechanism moves.
struct ToolCaches {
  std::uint64_t snap_revision = 0; // 0: never
  std::vector<SnapPoint> snap_points;
  std::uint64_t scene_revision = 0, scene_ticket = 0;
  SceneList scene; // of the drawn pose
  std::uint64_t selected_revision = 0;
  Selection selected;
  std::optional<Vec3> centre; // of the selection
  std::vector<Vec3> ends;     // of the selected part, where it alone is selected
  std::uint64_t aim_revision = 0;
  Vec2 aim_cursor = Vec2::Zero();
  std::optional<Vec3> aim_meant{};
  ViewCamera aim_camera;
  ViewSize aim_size;
  bool aim_snaps = false;
  Aim aim;
  std::shared_ptr<const ViewScene> hover_scene; // for which ViewState::hovered was found
  ViewCamera hover_camera;                      // likewise
  ViewSize hover_size;                          // likewise
};

struct ToolState {
  Tool tool = Tool::select;
  bool snap = true;                           // to points, the grid and round angles
  JointType joint_type = JointType::revolute; // of the next joint
  std::optional<JointType> type_aside{}; // the same once a disc sits on its shaft, which is offered first
  bool leave_joints = false;             // a body that is moved leaves its joints where they are
  std::optional<Vec3> last_point{};      // m, that was used: the next one is on a plane through it
  std::string point{};                   // a named one that is selected, while no part is
  std::string standing{};                // the vector that shall stand at one, "joints.arm.at"

  // Of one movement of the hand, or of the few clicks that a tool takes.
  Tool begun = Tool::select; // the tool that these belong to
  Handle hovered = Handle::none;
  std::optional<PointId> hovered_point{};
  std::string hovered_name{}; // of a named point
  std::optional<Grab> grab{};
  std::optional<AssemblyGrab> assembly{};
  std::optional<PullGrab> pull{};
  std::optional<ReachGrab> reach{};
  std::optional<Vec2> frame{}; // pixel of the view where a selecting frame began
  std::optional<Aim> first{};  // where the button went down, or the first of two clicks
  bool first_clicked = false;  // the latter
  std::optional<JointDraft> joint{};
  float card_height = 0;           // pixels, the most that the joint's card has taken
  bool spent = false;              // the button that is down has done its work
  std::string typed{};             // the length or size of what is being placed, instead of the hand's
  bool place_now = false;          // Enter was pressed: as if clicked here
  std::optional<Vec2> cursor{};    // pixel of the view where the keyboard has put it; see tool_cursor.hpp
  std::optional<Vec3> cursor_at{}; // the point there that is meant: others may lie before it in the picture
  bool cursor_click = false;       // Enter was pressed there

  ToolCaches caches{};
};

} // namespace flyball
