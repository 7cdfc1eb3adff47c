// Finds commands, parts and numbers by name.
#pragma once

#include "app/ui/panels/palette_entries.hpp"

#include <optional>

namespace flyball {

struct Session;
struct Ui;

class CommandPalette {
 public:
  // It is opened by the next frame.
  void open() { wanted_ = true; }
  bool wanted() const { return wanted_; }
  bool showing() const { return showing_; }
  const std::vector<PaletteEntry>& found() const { return index_.found; } // in the last frame
  int chosen() const { return chosen_; }                                  // row; -1: none
  // What it knows of a document; revisions of another begin anew.
  void forget() { index_ = {}; }
  // Returns the entry that was chosen; see use_palette_entry().
  std::optional<PaletteEntry> draw(const Session& session, Ui& ui, const CommandRunner& commands);

 private:
  bool wanted_ = false, showing_ = false;
  std::string search_;
  int chosen_ = -1; // row that Enter takes; none before something is typed or an arrow pressed
  PaletteIndex index_;
  std::vector<std::string> recent_; // names of entries, the last used first
};

} // namespace flyball
