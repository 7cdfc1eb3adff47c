// What the palette finds: commands, the mechanism's parts, and its numbers, which can be set there.
#pragma once

#include "app/document/part.hpp"
#include "app/session/fuzzy_match.hpp"
#include "app/ui/commands.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct PaletteEntry {
  std::string name;  // "edit.undo", "part/body/ball1", "number/joints.spin.drive.speed"
  std::string title; // what is searched first, and shown
  std::string about; // shown beside it
  std::string more;  // searched, too
  std::string right; // keys, or the number with its unit
  bool enabled = true;
  const Command* command = nullptr;
  Part part;
  std::string address;
  std::optional<double> value;    // that was typed behind a number's name, SI
  std::vector<std::size_t> marks; // bytes of the title that were typed
};

// Parts and numbers of the mechanism, until it changes, and what was found last.
struct PaletteIndex {
  std::uint64_t revision = 0;
  std::vector<PaletteEntry> entries;
  std::string search;
  std::vector<PaletteEntry> found;
  bool fresh = false; // `found` answers `search`
};

// The best first, those used recently before others that answer as well; without a search all commands.
const std::vector<PaletteEntry>& palette_entries(App& app);
// Does what the entry says: runs the command, selects the part and brings it into view, goes to the number's
// slider or field, or sets it.
void use_palette_entry(App& app, const PaletteEntry& entry);

} // namespace flyball
