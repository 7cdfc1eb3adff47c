// The command palette, the sheet of shortcuts, and what the commands that copy ask for.
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

struct CommandState {
  bool palette_wanted = false, palette_showing = false; // wanted: to be opened by the next frame
  std::string search;
  int chosen = 0; // row of the palette
  std::shared_ptr<PaletteIndex> index{};
  std::vector<std::string> recent{}; // entries of the palette, the last used first
  bool shortcuts = false;
  CopyChoice copy;
};

} // namespace flyball
