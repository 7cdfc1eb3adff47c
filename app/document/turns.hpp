// A body's rotation by three turns, as a person enters it, and the expressions that give these.
//
// The scene keeps a quaternion. That of three turns is made of sines and cosines of their halves, so
// expressions for the turns are kept exactly as expressions of its four numbers, "cos(a/2)" and "sin(a/2)" of
// a turn by a about one axis, and are read back from these.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <array>
#include <optional>
#include <string>

namespace flyball {

// About the world's x, then y, then z axis.
struct Turns {
  Vec3 angles = Vec3::Zero();         // deg
  std::array<std::string, 3> texts{}; // expressions of the angles (in rad); empty: by itself
};

Quat rotation_by(const Vec3& angles); // deg
Vec3 turns_of(const Quat& rotation);  // deg, to nine places

// Of a body whose rotation is given by expressions of turns. Nothing where it is given by none, or by others
// of the quaternion. Throws SceneError where they cannot be evaluated.
std::optional<Turns> given_turns(const Mechanism& mechanism, const Body& body);
bool is_rotation_given(const Body& body);
void forget_rotation(Formulas& formulas); // of a body: its rotation stays what it is
// Without expressions the rotation itself; else these, which are to be evaluated.
void set_turns(Body& body, const Turns& turns);

} // namespace flyball
