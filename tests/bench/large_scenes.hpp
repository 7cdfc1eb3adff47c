// Chains, trees and nets of any size for measuring.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball::bench {

// Thin uniform rods, `length` m and `mass` kg in all, on a driven hub that turns about the vertical at
// `speed` (rad/s); hinges parallel to z, hanging straight but for a small tilt (rad).
Mechanism chain(int links, double speed, double tilt = 1e-3, double length = 1, double mass = 1);

// The same with a spring of `stiffness` (N m per rad) and a damper of `damping` (N m s per rad) in every
// hinge.
Mechanism springy_chain(int links, double speed, double stiffness, double damping);

// A tree of rods from the same hub, each carrying two more, hinges in the plane by turns about z and x,
// springs in the hinges so that it keeps its shape.
Mechanism binary_tree(int rods, double speed);

// A square net of elastic cables, 1 m wide and 1 kg in all, of `side` x `side` point masses in a horizontal
// frame that turns about the vertical through its middle at `speed`; stretched by a tenth.
Mechanism spring_net(int side, double speed);

// A square net of inextensible cables, 2 m wide and 1 kg in all, that hangs as a bag from the same frame:
// every cell closes a loop.
Mechanism cable_net(int side, double speed);

// The same net of rods on ball joints at knots that weigh a tenth.
Mechanism rod_net(int side, double speed);

} // namespace flyball::bench
