// What friction makes of a steady state, as `flyball solve` tells it.
#pragma once

#include "engine/study/friction_report.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace flyball::cli {

// {"band": {name: [low, high]}, "band_whole", "band_folds", "band_at_least", "band_message", "holding":
// {"takes", "at_least", "first", "joints": {joint: {"limit", "force"}}, "message"}, "held_speeds": {drive:
// {"speed", "lower", "upper", "insensitivity"}}}; what is not available is null.
nlohmann::ordered_json to_json(const FrictionReport& friction);
std::string to_text(const FrictionReport& friction);

// Of one band: {"band", "band_error_estimate", "band_whole", "band_folds", "band_at_least", "band_message"}.
nlohmann::ordered_json to_json(const FrictionBand& band);
// Indented lines that follow what they are about, each with a line end before it.
std::string band_lines(const FrictionBand& band);

} // namespace flyball::cli
