// What was last typed of the selected part, beyond what the mechanism holds.
#pragma once

#include "app/document/part.hpp"

#include <functional>
#include <map>
#include <string>

namespace flyball {

// What was last typed of a body that is a uniform solid: it stays when a shape changes, and the other
// follows.
struct GivenMass {
  bool mass = false;  // the mass, or else
  double density = 0; // kg/m^3
};

// The inspector's own, which its parts are given.
struct InspectorState {
  Part independent; // a body whose mass does not follow its shapes, though it could
  std::map<std::string, GivenMass, std::less<>> given_masses; // by body
  bool mass_alone = false;                                    // a typed position moves the mass centre alone
  Part turned;                                                // whose rotation the angles below are
  Quat turned_to = Quat::Identity();
  Vec3 turns = Vec3::Zero(); // deg, about x, y and z
};

} // namespace flyball
