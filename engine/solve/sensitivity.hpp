// How a steady state moves with a parameter: d q_R / d p from the implicit function theorem, f_z dz/dp =
// -df/dp.
#pragma once

#include "engine/mechanism/varied_numbers.hpp"
#include "engine/solve/factored_state.hpp"

#include <span>
#include <string>

namespace flyball {

// What becomes of rates where the balance is singular: there are none, or, where nothing resists its null
// directions, the state moves along the others, and along these not at all.
enum class NullDirections { refused, kept_still };

// By parameter: the rate of each coordinate of q_R (rad or m, as a step) per unit of the number at that
// address, at a steady state of `mechanism`; df/dp is exact (BalanceRate). Empty at a singular state, where
// the answer has no rate; an empty vector for a number that moves others at no finite rate, or pushes along
// null directions. Throws SceneError
// for an address that does not exist.
std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           std::span<const std::string> addresses);
// The same of all these numbers of the mechanism, which are found already.
std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           const VariedNumbers& numbers,
                                           NullDirections null = NullDirections::refused);

} // namespace flyball
