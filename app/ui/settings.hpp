// What a person has chosen for every document, kept from one run of the program to the next.
#pragma once

#include "app/session/units.hpp"

#include <filesystem>

namespace flyball {

struct App;

struct Settings {
  DisplayUnits units;
  bool legend = true; // of the view is open
  bool operator==(const Settings&) const = default;
};

// An unreadable file, or a word in it that is not known, says nothing: that setting is as at first.
Settings read_settings(const std::filesystem::path& state_folder);
// Where they cannot be kept nobody is disturbed.
void keep_settings(const std::filesystem::path& state_folder, const Settings& settings);

// Fields, results and plots show their numbers in other units from now on; kept.
void choose_units(App& app, const DisplayUnits& units);
// Opens or folds the legend of the view; kept.
void open_legend(App& app, bool open);

} // namespace flyball
