// Which coordinates have dry friction that holds or slips, which are at a given speed, and the addresses of
// what friction gives.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

// In the mechanism's order, without those at a given speed.
std::vector<CoordinateReference> find_frictions(const Mechanism& mechanism);

// Whether a drive gives the speed, also through gears: friction then holds nothing there, and the drive bears
// its limit against the way it goes.
bool is_at_given_speed(const Mechanism& mechanism, CoordinateReference at);

bool has_friction(const Mechanism& mechanism);  // some that find_frictions() finds, so that states are bands
bool rubs_anywhere(const Mechanism& mechanism); // also where it loads drives alone

const Friction& friction_at(const Mechanism& mechanism, CoordinateReference at);

// "joints.slide.friction.share": of its limit, from -1 to 1.
std::string share_address(const Mechanism& mechanism, CoordinateReference at);

} // namespace flyball
