// A solution as the JSON object that `flyball solve --json` prints.
#pragma once

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/report/analysis.hpp"

#include <nlohmann/json_fwd.hpp>

namespace flyball::cli {

// null where it is not finite.
nlohmann::ordered_json number_json(double value);

// Every key is always there; what is not available is null. `drive_torque_ranges` has those that vary with
// the phase of the drives: {"mean", "min", "max"}. A gear's entry in `reactions` is what it does to the child
// of its second joint as vectors, and along the coordinates of both as "a" and "b"; the reactions of these
// joints include it.
nlohmann::ordered_json to_json(const Mechanism& mechanism, const Solution& solution);

// {"period_s", "error", "multipliers": [[re, im]], "growth_rates": [1/s]}.
nlohmann::ordered_json floquet_json(const Floquet& floquet);

// {"position", "velocity", "acceleration"}: m, m/s, m/s^2, world frame.
nlohmann::ordered_json to_json(const PointMotion& motion);

// [{"where": path, "message": sentence}].
nlohmann::ordered_json warnings_json(const std::vector<SceneError>& warnings);
// A command's answer with what is to be said of the mechanism, as "warnings".
nlohmann::ordered_json with_warnings(nlohmann::ordered_json answer, const Mechanism& mechanism);

// {name: {value, unit, error_estimate}}; values that are not there are null, with the reason.
nlohmann::ordered_json measures_json(const std::vector<MeasureSolution>& measures);
// {joint: value or array}, driven ones left out.
nlohmann::ordered_json coordinates_json(const std::vector<CoordinateSolution>& coordinates);

// {joint: value or array}: of drives by torque, as found.
nlohmann::ordered_json speeds_json(const std::vector<CoordinateSolution>& coordinates);

// {joint: {"force", "limit", "slips"}}.
nlohmann::ordered_json frictions_json(const std::vector<FrictionForce>& frictions);

// {"equilibria": [as above], "search": {"bounds", "starts", "complete"}}.
nlohmann::ordered_json to_json(const Mechanism& mechanism, const AllSolutions& all);

} // namespace flyball::cli
