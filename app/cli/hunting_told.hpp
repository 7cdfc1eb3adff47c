// How a mechanism begins to hunt, as `flyball branch` and `flyball hunting` tell it.
#pragma once

#include "engine/study/hopf_point.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace flyball::cli {

// {"frequency_rad_s", "loss", "lyapunov", "error_estimate", "coordinate", "unit", "growing", "reason"}; what
// is not available is null.
nlohmann::ordered_json hunting_json(const HopfPoint& point);
// "6.556 rad/s (1.043 Hz), hard: l1 = 0.0451 1/rad² (± 4e-10) by the amplitude of arm1"
std::string hunting_text(const HopfPoint& point);

} // namespace flyball::cli
