// A solution as the JSON object that `flyball solve --json` prints.
#pragma once

#include "engine/equilibrium/analysis.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <nlohmann/json.hpp>

namespace flyball::cli {

// Every key is always there; what is not available is null.
nlohmann::ordered_json to_json(const Mechanism& mechanism, const Solution& solution);

// {joint: value or array}, driven ones left out.
nlohmann::ordered_json coordinates_json(const std::vector<CoordinateSolution>& coordinates);

// {"equilibria": [as above], "search": {"bounds", "starts", "complete"}}.
nlohmann::ordered_json to_json(const Mechanism& mechanism, const AllSolutions& all);

} // namespace flyball::cli
