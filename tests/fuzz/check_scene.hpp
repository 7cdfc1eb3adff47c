// What must hold for any bytes given as a scene: they load or are refused with a reason; what loads saves to
// something that loads as the same; what is valid solves to an answer without a number that is none, or to a
// refusal in words.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace flyball::fuzz {

// Whether a mechanism solves in milliseconds.
bool small_enough(const Mechanism& mechanism);

// What does not hold, in words. Mechanisms too large to solve in milliseconds are only loaded and saved; a
// solve is cancelled after `limit`.
std::optional<std::string> check_scene(std::string_view bytes, std::chrono::milliseconds limit);

} // namespace flyball::fuzz
