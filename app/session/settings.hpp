// What a person has chosen for every document, kept from one run of the program to the next.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/units.hpp"

#include <filesystem>

namespace flyball {

struct Settings {
  DisplayUnits units;
  bool legend = true; // of the view is open
  Navigation navigation = Navigation::own;
  bool operator==(const Settings&) const = default;
};

// An unreadable file, or a word in it that is not known, says nothing: that setting is as at first.
Settings read_settings(const std::filesystem::path& state_folder);
// Where they cannot be kept nobody is disturbed.
void keep_settings(const std::filesystem::path& state_folder, const Settings& settings);

} // namespace flyball
