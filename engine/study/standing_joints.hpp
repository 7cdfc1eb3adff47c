// A mechanism whose joints with friction stand where stiff springs pull them: the balance is solved at places
// that are given, folds of what friction would give along the way or not.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"
#include "engine/study/free_number.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Each has a number that moves it, and what tells which share of its limit friction gives there.
struct StandingJoint {
  FreeNumber number;   // where its spring pulls it, or the share itself where a loop ties it to others
  std::string measure; // of the share; empty where the number is it
  std::string name;    // of the coordinate
  std::string share;   // address of the scene's own
};

struct StandingJoints {
  Mechanism mechanism; // in the state
  std::vector<StandingJoint> joints;
};

// Of a state that needs no friction but the shares of the scene. `independent`: of find_frictions(), as of
// Holding; the others keep their friction. A spring gives a joint's limit within `give` of a radian or of
// `reach` (m). Nothing where laws or measures ask for the springs of such joints.
std::optional<StandingJoints> stand_on_springs(const Mechanism& mechanism, const Solution& state,
                                               const std::vector<std::size_t>& independent, double reach,
                                               double give);

// Of these names those of angles whose whole turns no spring, stop or torque tells apart; none where one
// might that is not among them.
std::vector<std::string> freely_turning(const Mechanism& mechanism, const std::vector<std::string>& names);

} // namespace flyball
