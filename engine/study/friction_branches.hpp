// Branches of steady states that rest on dry friction, along one number: what it holds as drawn, and what
// slips at constant rates, from where one turns into the other to where that does.
#pragma once

#include "engine/continuation/branches.hpp"

namespace flyball {

// As follow_branches(), and where at values of the number no branch of that goes states that rest on
// friction. These are solved at values beside each other, closer where the state bends; a branch ends where a
// joint begins to slip or sticks (SpecialPointType::slip, located to rounding), or where solving leads to no
// state beside the last, as at a fold. Throws as follow_branches does.
ResponseDiagram follow_response(const Mechanism& mechanism, const std::string& address, double from,
                                double to, const BranchOptions& options = {});

// The second half of that: adds such states to a diagram of what there is without friction over this number,
// with their run time. Nothing where the mechanism has no friction. Throws as follow_branches does.
void add_friction_branches(const Mechanism& mechanism, const std::string& address, double from, double to,
                           const BranchOptions& options, ResponseDiagram& diagram);

// A steady state as a point of such a curve.
ResponsePoint response_point(const Solution& solution, double parameter);

} // namespace flyball
