// Gears, belts, racks and screws: the same tie of two coordinates by other numbers; and what joints and
// forces are called.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flyball {

// "revolute joint", "gear joint", "belt".
std::string joint_noun(const Joint& joint);
// "spring", "drag"; "damper" of a spring that only damps.
std::string force_noun(const Force& force);

// Those that two coordinates, as find_coordinate knows them, can be tied by; none where one is unknown or a
// component of a rotation vector.
std::vector<GearKind> gear_kinds(const Mechanism& mechanism, const std::array<std::string, 2>& coordinates);

// The first coordinates of one joint or of two that a kind can tie; nothing where there are none.
std::optional<std::array<std::string, 2>> gear_ends(const Mechanism& mechanism,
                                                    const std::vector<std::string>& joints, GearKind kind);

// The same motion by another of these. Of a rack or screw the coordinate that turns comes first.
void change_gear_kind(const Mechanism& mechanism, Joint& gear, GearKind kind);

// Turns one of its coordinates round: the same motion with the opposite ratio.
void reverse_ratio(Joint& gear);

} // namespace flyball
