// What is settled before any link is placed: which coordinates the drives turn, directly or through gears,
// and which joints make up the tree. The others are cut to close its loops.
#pragma once

#include "engine/mechanism/body_groups.hpp"
#include "engine/system/system.hpp"

#include <array>
#include <vector>

namespace flyball {

// How a coordinate is driven: from which motor, through which gears.
struct DriveOrigin {
  bool driven = false;
  bool finds_speed = false;
  int motor_joint = -1, motor_coordinate = 0;
  std::vector<int> gears;
};

// All by joint of the mechanism.
struct SpanningTree {
  std::vector<std::array<int, 2>> ends;          // the bodies joined, -1: the ground; of a gear below that
  std::vector<std::vector<DriveOrigin>> origins; // by coordinate
  std::vector<bool> needs_coordinate; // its coordinates are asked for: by a spring, stop, gear, law, ...
  std::vector<bool> in_tree;

  DriveOrigin& origin(CoordinateReference r) {
    return origins[static_cast<std::size_t>(r.joint)][static_cast<std::size_t>(r.coordinate)];
  }
};

// The number of a body, -1: the ground. Throws SceneError at `where` if there is none of that name.
int body_number(const BodyNumbers& numbers, const std::string& name, const std::string& where);

// The coordinate at an end of a gear. Throws SceneError if there is none.
CoordinateReference gear_end(const Mechanism& mechanism, int joint, int end);

// Throws SceneError where what is driven would have to be cut.
SpanningTree choose_tree(const Mechanism& mechanism, const CutChoice& choice, const BodyNumbers& numbers);

} // namespace flyball
