// How a steady state moves with a parameter: d q_R / d p from the implicit function theorem, f_z dz/dp =
// -df/dp.
#pragma once

#include "engine/mechanism/varied_numbers.hpp"
#include "engine/solve/factored_state.hpp"

#include <span>
#include <string>

namespace flyball {

// By parameter: the rate of each coordinate of q_R (rad or m, as a step) per unit of the number at that
// address, at a steady state of `mechanism`; df/dp is exact (BalanceRate). Empty at a singular state, where
// the answer has no rate; an empty vector for a number that moves others at no finite rate. Throws SceneError
// for an address that does not exist.
std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           std::span<const std::string> addresses);
// The same of all these numbers of the mechanism, which are found already. `across`: also of a state along
// whose null directions nothing resists; those then stay still.
std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           const VariedNumbers& numbers, bool across = false);

} // namespace flyball
