// How a steady state moves with a parameter: d q_R / d p from the implicit function theorem, f_z dz/dp =
// -df/dp.
#pragma once

#include "engine/solve/newton.hpp"

#include <string>

namespace flyball {

// Rate of each coordinate of q_R (rad or m, as a step) per unit of the parameter at `address`, at a steady
// state z of `mechanism`. df/dp by central differences (relative error about 1e-9). Empty at a singular
// state, where the answer has no rate. Throws SceneError for an address that does not exist.
Eigen::VectorXd sensitivity(const Problem& problem, const Mechanism& mechanism, const Unknowns& z,
                            const std::string& address, Workspace& w);

} // namespace flyball
