// What a person has chosen for every document, kept from one run of the program to the next.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/units.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace flyball {

// The colours that were asked for; as the desktop has them where it says so, else light.
enum class ThemeChoice { system, light, dark, high_contrast };
// Of "system", "light", "dark" and "high-contrast".
std::optional<ThemeChoice> theme_choice_of(std::string_view word);

inline constexpr double least_zoom = 0.7, most_zoom = 3;

struct Settings {
  DisplayUnits units;
  bool legend = true;                            // of the view is open
  bool ghost = true, grid = true, shadow = true; // are in the view
  Navigation navigation = Navigation::own;
  ThemeChoice theme = ThemeChoice::system;
  double zoom = 1; // of the interface, times what the display has
  bool operator==(const Settings&) const = default;
};

// An unreadable file, or a word in it that is not known, says nothing: that setting is as at first.
Settings read_settings(const std::filesystem::path& state_folder);
// Where they cannot be kept nobody is disturbed.
void keep_settings(const std::filesystem::path& state_folder, const Settings& settings);

} // namespace flyball
