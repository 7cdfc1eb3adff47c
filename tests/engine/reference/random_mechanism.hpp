// Seeded random mechanisms for property tests: the same seed and options give the same mechanism everywhere.
// Loops close at the drawn pose because everything is given there; assemble() finds other closed poses.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <cstdint>
#include <vector>

namespace flyball::reference {

enum class RandomDrives {
  none,
  root,    // the only joint to ground turns
  several, // any tree coordinate but those of rotation vectors may be driven, some through gears
};

struct RandomOptions {
  int bodies = 0; // 0: one to eight
  int loops = 0;  // joints that close loops, as far as there are bodies to join
  RandomDrives drives = RandomDrives::root;
  // The balance is the same at every phase of a root drive: gravity and world loads along its axis, and
  // nothing but springs to points of the axis holds on to ground. Otherwise anything goes anywhere.
  bool steady = true;
  bool conservative = false; // only forces with a potential, and no dampers
  double spring_share = 0.6; // of the free coordinates, how many have a spring; 1 keeps all of them in place
  bool stops = true;
  bool forces = true; // beside the joints
  bool air = false;   // vanes, some by polars, in a wind or in air that turns with a body
  bool massless = true;
  bool rotated_bodies = true;
  bool skew_universals = false; // axes not at right angles
  bool parallel_axes = false;   // plane motion in parallel planes: loops are redundant, and can move
  bool mark_cuts = false;       // loop joints say `cut: true`
  std::vector<JointType> tree_types{JointType::revolute,  JointType::prismatic, JointType::cylindrical,
                                    JointType::universal, JointType::spherical, JointType::planar,
                                    JointType::free,      JointType::fixed};
  std::vector<JointType> loop_types{JointType::distance,    JointType::revolute,  JointType::prismatic,
                                    JointType::cylindrical, JointType::universal, JointType::spherical,
                                    JointType::planar,      JointType::fixed,     JointType::gear};
};

Mechanism random_mechanism(std::uint32_t seed, const RandomOptions& options = {});

// With mass and springs everywhere and up to two loops: nothing that a change of the drive's kind leaves
// open.
Mechanism random_sprung_mechanism(std::uint32_t seed);

// With its joints' dampers by laws, as stiff at rest as they were and stiffer beyond.
Mechanism with_damper_laws(Mechanism mechanism);

} // namespace flyball::reference
