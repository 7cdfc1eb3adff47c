// What the response curve can show over the parameter.
#pragma once

#include "engine/study/friction_branches.hpp"

#include <string>
#include <vector>

namespace flyball {

struct ResponseQuantity {
  std::string key;   // "value theta"
  std::string title; // "theta"
  std::string group; // "Coordinates"
  std::string unit;  // before a person's choice (see units.hpp): "rad", "m", "N m", "Hz"
  double factor = 1; // from SI units to this
};

// All that the point, with everything in it, can tell.
std::vector<ResponseQuantity> response_quantities(const ResponsePoint& point);
// Adds those that are not there yet, each at the end of its group.
void add_quantities(std::vector<ResponseQuantity>& to, const std::vector<ResponseQuantity>& more);
// Whether its points need reactions and drive torques.
bool needs_reactions(const std::string& key);

// In SI units; zero as the speed of what stands; several for a quantity of several lines ("frequencies"),
// none where the point does not tell.
std::vector<double> quantity_values(const ResponsePoint& point, const std::string& key);
// One of them: where a mark of the point stands.
std::optional<double> quantity_mark(const ResponsePoint& point, const std::string& key);

} // namespace flyball
