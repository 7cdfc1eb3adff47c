// What is being typed and looked at in the inspector, the outline and other fields.
#pragma once

#include "app/document/part.hpp"
#include "app/viewport/theme.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct App;

// Why a text cannot be taken, as a sentence; empty where it can.
using TextCheck = std::function<std::string(const std::string&)>;
using TextTaker = std::function<void(App&, const std::string&)>;

// The one field that is being typed in.
struct Typing {
  std::string name{}; // of the widget; empty: there is none
  std::string text{}, original{};
  std::string mistake{}, checked{}; // why `checked` cannot be taken
  TextCheck check{};
  TextTaker take{};
  bool wants_focus = false; // to be given the keyboard when it is drawn next
  int idle = 0;             // frames in which it had not the keyboard
  bool by_number = false;   // a double click selects the number, until the button is up again
};

// A number that is dragged by its label.
struct Scrub {
  std::string name;
  double start = 0, step = 0; // in the field's unit
  float travelled = 0;        // pixels
};

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
  Typing typing;
  Scrub scrub;
  // Edits wait until the panels are drawn, which refer to the mechanism as it was before.
  std::vector<std::function<void(App&)>> later;
  std::optional<double> plain;                   // what was typed in a field outside the document
  std::map<std::string, bool, std::less<>> open; // sections that were opened or closed by hand
  std::map<std::string, bool, std::less<>> seen; // those the inspector has shown open of itself, of `seen_of`
  Selection seen_of{};

  std::string search; // in the outline
  OutlineRows rows;
  float missing_height = 0;  // pixels, of what is missing below the outline
  std::string choice_search; // in the open list of names
  Part anchor, revealed;     // where a range of rows begins; the last one brought into view
  Part independent;          // a body whose mass does not follow its shapes, though it could
  std::map<std::string, GivenMass, std::less<>> given_masses; // by body
  bool mass_alone = false;                                    // a typed position moves the mass centre alone
  bool leave_joints = false; // a body that is moved leaves its joints where they are
  Part turned;               // whose rotation the angles below are
  Quat turned_to = Quat::Identity();
  Vec3 turns = Vec3::Zero(); // deg, about x, y and z
};

} // namespace flyball
