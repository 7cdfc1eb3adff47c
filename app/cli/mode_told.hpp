// A mode as commands tell it.
#pragma once

#include "engine/stability/mode_motion.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace flyball::cli {

// {"value", "direction", "seen_from", "from_ground_rad_s"}; null where there is none. `frequency` in rad/s.
nlohmann::ordered_json whirl_json(const std::optional<Whirl>& whirl, double frequency);
// "  whirl +0.998 forward, seen from the drive", or "".
std::string whirl_text(const std::optional<Whirl>& whirl);

// {"eigenvalue": [re, im], "frequency_hz", "damping_ratio", "whirl", "shape": {coordinate: [re, im]}}.
nlohmann::ordered_json mode_json(const VibrationMode& mode, const std::optional<Whirl>& whirl);

} // namespace flyball::cli
