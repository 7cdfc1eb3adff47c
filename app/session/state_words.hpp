// A steady state in words.
#pragma once

#include "engine/solve/solution.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flyball {

// "A minimum of the amended potential."
const char* reason_text(StabilityReason reason);

// How an unstable state is left: "It hunts: swings at 2.44 Hz double every 0.136 s."; empty where no
// eigenvalue tells.
std::string growth_words(const Solution& solution);

// Why it stays undecided where swings have no damper: "Nothing damps the swing at 12.3 Hz: it neither grows
// nor dies out."; else empty.
std::string undamped_words(const Solution& solution);

// What the engine says of a state; where it names a command of the terminal, the window's own, and a body
// that no joint holds by its name.
std::string window_message(const Solution& solution);

// Whether two lists of coordinates are one state but for rounding: whole turns, and joints in which nothing
// resists, do not count.
bool same_state(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b,
                const std::vector<std::string>& neutral);

// What a drive by torque gives and its load, zero where they are rounding beside what the joints bear.
std::optional<DriveTorque::Given> told_torque(const Solution& solution, const DriveTorque& drive);

} // namespace flyball
