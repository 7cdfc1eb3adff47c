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

struct Session;

// Parts and numbers of the mechanism, until it changes, and what was found last.
struct PaletteIndex {
  std::uint64_t revision = 0;
  std::vector<PaletteEntry> entries;
  std::string search;
  std::vector<PaletteEntry> found;
  bool fresh = false; // `found` answers `search`
};

// The best first, those used recently before others that answer as well; without a search all commands.
const std::vector<PaletteEntry>& palette_entries(const Session& session, const CommandRunner& commands,
                                                 PaletteIndex& index, const std::string& search,
                                                 const std::vector<std::string>& recent);
// Whether nothing is sought.
bool is_blank(const std::string& search);
// "15 rad/s": a number in the unit that is shown.
std::string number_words(const Session& session, const std::string& si_unit, double value);

} // namespace flyball
