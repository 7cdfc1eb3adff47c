// Which colour each body has, as a number; the theme says what it looks like. A body keeps its number through
// every edit, whatever becomes of the others: a scene file has colours of shapes only, so the numbers are
// chosen when a body enters the document and go with the document's steps. Those that a rename has made
// others than the names ask for are kept beside the file (kept_beside.hpp), and with unsaved work
// (autosave.hpp).
//
// The number is the one that the body's name asks for (the same in every session), unless that hue is taken:
// then the next one that is used least, and never a neighbour's while another is to be had.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace flyball {

// So many hues, each in two shades: numbers from `body_hue_count` on are the darker ones.
inline constexpr int body_hue_count = 6, body_shade_count = 2;

using BodyHues = std::vector<std::uint8_t>; // by body

using NamedHues = std::map<std::string, std::uint8_t>; // by the body's name

// Of a mechanism that was just read; bodies that are known have theirs.
BodyHues choose_hues(const Mechanism& mechanism, const NamedHues& known = {});
// Those of the bodies that their names do not ask for, where there are any: what a file cannot tell.
NamedHues hues_to_keep(const Mechanism& mechanism, const BodyHues& hues);
// After an edit. Bodies are known by their names, one that was renamed by its place.
BodyHues carried_hues(const Mechanism& before, const BodyHues& hues, const Mechanism& after);
// Whether both have the same bodies by name, in the same order.
bool same_bodies(const Mechanism& a, const Mechanism& b);

// The numbers and whose they are.
struct BodyColouring {
  std::shared_ptr<const Mechanism> of; // null: nobody has chosen any
  std::shared_ptr<const BodyHues> hues;
};
// For a mechanism that may be a little older or newer than that.
BodyHues hues_for(const Mechanism& mechanism, const BodyColouring& colouring);

} // namespace flyball
