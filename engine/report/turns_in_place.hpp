// Mechanisms of shafts, clutches, brakes and gears: nothing in them depends on how far anything has turned.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <span>

namespace flyball {

// Whether all that there is turns about parallel axes through the mass centres, without springs, stops and
// forces but the drag of air at rest, and with torques of rates alone. Then nothing is balanced by where it
// stands: what is neither tied to something that stands nor held by its own friction comes to rest nowhere,
// but where its torques happen to be none.
bool turns_in_place(const Mechanism& mechanism);

// Whether the torque or load of a drive is one of where anything stands.
bool asks_for_place(const Mechanism& mechanism, const Joint& joint, int i);

// Whether these coordinates, held, and drives at given speeds tie the two bodies of another to each other, or
// gears tie it to anything.
bool is_tied(const Mechanism& mechanism, std::span<const CoordinateReference> held,
             CoordinateReference other);

} // namespace flyball
