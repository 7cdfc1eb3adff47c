// An assembled mechanism moved along its joints: a point of a body comes as near as it can to where it is
// pulled, or a joint's coordinate to a value, and everything else moves as little as it must. Geometry alone:
// masses, forces and drives play no part, driven coordinates move like any other.
//
// Damped least squares (Levenberg, 1944; Nakamura and Hanafusa, Inverse kinematic solutions with singularity
// robustness for robot manipulator control, 1986). With x a scaled step, A the Jacobian of what is pulled, r
// what it is short of, J the rows of the loops and G those of the stops that are reached:
//   minimise  mu x^T W x + |A x - r|^2   where  J x = 0,  G x = what is left to the stop,
// stops by active sets, as bounds that no coordinate passes. W counts the motion of every body alike,
// whatever it weighs, so that what the hand does not need stays where it is: a chain follows its end. mu
// rises until a step brings the point nearer, so that nothing is thrown far where the Jacobian is singular or
// the target out of reach. After each step the loops are closed to rounding.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/mechanism/mechanism_pose.hpp"

#include <memory>
#include <optional>
#include <string_view>

namespace flyball {

struct PullTarget {
  Vec3 at = Vec3::Zero(); // m, world
  // Unit vector along which a distance counts little, such as that of sight: the point then comes to lie
  // under the cursor first of all. Zero: all directions count alike.
  Vec3 sight = Vec3::Zero();
};

struct DragOutcome {
  bool settled = false; // nothing is to be gained by going on
  double away = 0;      // m, rad for an angle: from the target
  bool at_stop = false; // a stop keeps it from there
};

class AssemblyDrag {
 public:
  // Compiles the mechanism and closes its loops from the drawn pose. Throws SceneError.
  explicit AssemblyDrag(const Mechanism& mechanism);
  ~AssemblyDrag();
  AssemblyDrag(AssemblyDrag&&) noexcept;
  AssemblyDrag& operator=(AssemblyDrag&&) noexcept;

  // Whether the loops could be closed; else nothing moves.
  bool assembled() const;

  // From where the last call left the mechanism. A number of steps bounded by the mechanism's size: where
  // they do not do, the outcome is not settled, and calling again goes on. Throws SceneError for a body there
  // is not.
  DragOutcome pull(const BodyPoint& grabbed, const PullTarget& target);
  // The coordinate `index` of a joint towards a value, as its label has it (rad or m). Throws SceneError for
  // a joint without one.
  DragOutcome move(std::string_view joint, int index, double value);

  // Where it is.
  MechanismPose pose() const;
  Vec3 position(const BodyPoint& point) const; // m, world
  // Unit normal of the plane in which the joints between the ground and the body keep its points, loops left
  // aside; nothing where they do not.
  std::optional<Vec3> plane_of(const BodyPoint& point) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
