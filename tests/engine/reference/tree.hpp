// A mechanism read for the reference: which joints form the tree, what its coordinates are, where they put
// the bodies, and what a joint's coordinates and constraints are as functions of those placements.
//
// Placements are displacements X_b from the drawn pose: X_b maps a point of body b, in world coordinates of
// the drawn pose, to where it is now. Ground has X = 1. A joint displaces its child against its parent by
// J(q) = X_parent^-1 X_child, whichever way the tree runs:
//   revolute     Rot(axis, q - drawn), about `at`
//   prismatic    Trans(axis (q - drawn))
//   cylindrical  Rot(axis, q0 - drawn0) Trans(axis (q1 - drawn1))
//   universal    Rot(axis, q0 - drawn0) Rot(axis2, q1 - drawn1)
//   spherical    D with exp(q) = D exp(drawn)
//   planar       Trans(x (q0 - drawn0) + y (q1 - drawn1)) Rot(axis, q2 - drawn2), y = axis x axis2
//   free         Trans(q012 - drawn012) D with exp(q345) = D exp(drawn345)
// all rotations about `at`, all axes as drawn, i.e. fixed in the parent. Rotation vectors and the free
// joint's translation have their components along the world axes of the drawn pose, carried by the parent.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "tests/engine/reference/rigid_motion.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace flyball::reference {

// Values by joint name, of all coordinates of a joint (rad, m); a joint not named is at its drawn values.
struct ReferenceState {
  std::map<std::string, std::vector<Real>> coordinates;
};

// One coordinate of a tree joint. Where `rotation`, its velocity is not the rate of the value but a component
// of the angular velocity of the child relative to the parent, D -> exp(delta) D, in the axes of D.
struct TreeCoordinate {
  int joint = 0, index = 0;
  bool rotation = false;
  bool driven = false; // by its own drive or through gears
  Real speed = 0;      // rad/s, m/s; zero where not driven
};

struct Tree {
  struct Link {
    int joint = 0;
    int from = -1, to = 0; // bodies, outward; -1 is ground
    bool reversed = false; // runs from the joint's child to its parent
  };
  std::vector<Link> links;                 // outward from ground
  std::vector<int> cut;                    // joints that close loops, in the mechanism's order
  std::vector<TreeCoordinate> coordinates; // of tree joints, in the mechanism's order
  std::vector<int> first;                  // by joint: its first coordinate in `coordinates`; -1 where cut
};

// The tree left by cutting the joints named, and every distance and gear joint. Drives spread through gears
// to other tree coordinates. Throws std::invalid_argument where what is left is not a tree that holds every
// body.
Tree span_tree(const Mechanism& mechanism, const std::vector<std::string>& cut_joints);

// A cut for each loop, met in the order of the joints (driven joints first); joints marked `cut` are in it,
// distance and gear joints always.
std::vector<std::string> default_cuts(const Mechanism& mechanism);

// The joint's coordinates in this state.
std::vector<Real> joint_values(const Joint& joint, const ReferenceState& state);

// Displacements of all bodies while the tree coordinates move at `rates` (see TreeCoordinate for what they
// are), without acceleration.
std::vector<RigidMotion> move_bodies(const Mechanism& mechanism, const Tree& tree,
                                     const ReferenceState& state, const VectorR& rates);

// The state after a displacement of the tree coordinates: added to values, exp(step) on the left of
// rotations.
ReferenceState advance(const Mechanism& mechanism, const Tree& tree, const ReferenceState& state,
                       const VectorR& step);

// Values and rates of a joint's coordinates read off the motions of its bodies; angles within pi of the drawn
// ones, rotation vectors within [0, pi]. Off the joint's constraints they are the nearest one can mean.
std::vector<MovingReal> coordinates_of_motion(const Mechanism& mechanism, const Joint& joint,
                                              std::span<const RigidMotion> motions);

// The joint's constraints along the motions of its bodies; not for gears. Zero where the joint holds.
std::vector<MovingReal> constraints_of_motion(const Mechanism& mechanism, const Joint& joint,
                                              std::span<const RigidMotion> motions);

// Values of every joint with coordinates, tree or cut, read off the displacements of the bodies. For changing
// to another tree.
ReferenceState state_of_motion(const Mechanism& mechanism, std::span<const RigidMotion> motions);

} // namespace flyball::reference
