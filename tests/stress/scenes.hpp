// The shipped scenes and ways to change all numbers of a kind.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <functional>

namespace flyball::stress {

struct NamedScene {
  std::string name;
  Mechanism mechanism;
};
// In the order of their names.
const std::vector<NamedScene>& shipped_scenes();

// The numbers of a kind, one after the other.
void each_stiffness(Mechanism& m, const std::function<void(double&)>& change); // springs and stops
void each_damping(Mechanism& m, const std::function<void(double&)>& change);   // of joints and springs
void each_speed(Mechanism& m, const std::function<void(double&)>& change);
bool has_springs(const Mechanism& m);
bool has_dampers(const Mechanism& m);
// Some speed is found rather than given: without a resistance, or without a momentum, there is none.
bool finds_speeds(const Mechanism& m);
// Every coordinate is an angle of a tree: somewhere in a whole turn the amended potential is least.
bool must_rest(const Mechanism& m);

// The same mechanism in other units, which settles into the same pose: lengths, masses and times by these
// factors.
Mechanism alike(Mechanism m, double length, double mass, double time);

} // namespace flyball::stress
