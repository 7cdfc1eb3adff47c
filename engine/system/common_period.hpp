// Whether several speeds have a common period.
#pragma once

#include <optional>
#include <vector>

namespace flyball {

// Of a speed: those that differ by less are one, and ratios that do are whole.
inline constexpr double same_speed = 1e-9;

// Turns of the fastest drive in a period: that multipliers are first found over, that motions are followed
// for and phases looked at, and that multipliers are found over at most.
inline constexpr int usual_turns = 64, followed_turns = 240, most_turns = 1024;

// The shortest time (s) in which each of the speeds (rad/s, none of them zero) makes whole turns, none of
// them more than `most`. Nothing where there is none to nine digits, or no speed.
std::optional<double> common_period(const std::vector<double>& speeds, int most);

} // namespace flyball
