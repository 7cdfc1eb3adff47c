// What is looked at in the inspector and the outline.
#pragma once

#include "app/document/part.hpp"
#include "app/viewport/theme.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace flyball {

// Of the outline, kept while the mechanism and what is searched for stay the same.
struct OutlineRows {
  std::uint64_t revision = 0; // of the document; 0: nothing is kept
  Theme theme = Theme::light;
  std::string search;
  std::vector<Color> colours;                // of the bodies
  std::array<std::vector<PartId>, 3> listed; // bodies, joints, forces
};

// What was last typed of a body that is a uniform solid: it stays when a shape changes, and the other
// follows.
struct GivenMass {
  bool mass = false;  // the mass, or else
  double density = 0; // kg/m^3
};

struct InspectorState {
  bool history = false;   // the list of steps is shown
  int history_shown = -1; // the step last brought into view there

  std::string search; // in the outline
  OutlineRows rows;
  float missing_height = 0; // pixels, of what is missing below the outline
  Part anchor, revealed;    // where a range of rows begins; the last one brought into view
  Part independent;         // a body whose mass does not follow its shapes, though it could
  std::map<std::string, GivenMass, std::less<>> given_masses; // by body
  bool mass_alone = false;                                    // a typed position moves the mass centre alone
  bool leave_joints = false; // a body that is moved leaves its joints where they are
  Part turned;               // whose rotation the angles below are
  Quat turned_to = Quat::Identity();
  Vec3 turns = Vec3::Zero(); // deg, about x, y and z
};

} // namespace flyball
