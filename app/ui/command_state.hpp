// The command palette, the sheet of shortcuts, where keys go, and what the commands that copy ask for.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <memory>
#include <string>
#include <vector>

namespace flyball {

// Of Mirror (the plane through the point at right angles to the axis) and Circular copy.
struct CopyChoice {
  int axis = 0;              // x, y or z
  Vec3 point = Vec3::Zero(); // m
  int count = 3;
};

struct PaletteIndex; // see palette_entries.hpp

// Where keys go; see key_focus.hpp.
struct KeyFocus {
  bool in_panel = false;     // the last click was in a panel, or one types there
  bool among_fields = false; // in one of numbers and words, rather than a list of parts
  // Letters are commands all the same, as long as no number is begun: among plots, and once one has been a
  // command in the view.
  bool letters = false;
  bool number_begun = false; // a digit or sign was pressed there outside of any field
};

struct CommandState {
  bool palette_wanted = false, palette_showing = false; // wanted: to be opened by the next frame
  std::string search;
  int chosen = 0; // row of the palette
  std::shared_ptr<PaletteIndex> index{};
  std::vector<std::string> recent{}; // entries of the palette, the last used first
  bool shortcuts = false;
  KeyFocus focus;
  CopyChoice copy;
};

} // namespace flyball
