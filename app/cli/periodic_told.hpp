// A periodic motion as `flyball solve` tells it.
#pragma once

#include "engine/periodic/periodic_state.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace flyball::cli {

// {"status", "message", "period_s", "period_error", "drive_periods", "coordinates", "drive_torques": {joint:
// {"mean", "min", "max", "error_estimate"}}, "drive_powers" likewise, "reactions" and "bearings": {name:
// {"force" and "torque": {"size", "x", "y", "z": likewise}}}, of gears "a" and "b"; "nonunique" where it is
// so; "measures": {name: the same with "unit"}, "start": {joint: {"value", "rate"}}, "stable",
// "stability_reason", "floquet", "residual", "iterations", "history", "segments", "evaluations",
// "run_time_s"}; what goes on has its "advance" (rad or m) a period and its "rate"; what is not available is
// null.
nlohmann::ordered_json to_json(const PeriodicState& state);
std::string to_text(const PeriodicState& state);

} // namespace flyball::cli
