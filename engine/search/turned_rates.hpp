// How a steady state that stands turned (phase_search.hpp) moves with a number of the mechanism, by its
// balance with the angles among the unknowns (turned_balance.hpp); V as it is: numbers that tie the angles
// otherwise, as a gear's ratio does, change it.
#pragma once

#include "engine/mechanism/varied_numbers.hpp"
#include "engine/search/phase_search.hpp"

namespace flyball {

struct TurnedRate {
  Eigen::VectorXd q;      // of q_R, as a step, per unit of the number; empty: none that is finite
  Eigen::VectorXd starts; // by link: rad or m, of what turns at speeds that are found
};

// By number. `problem` has the angles of the state; its multipliers are those of TurnedState.
std::vector<TurnedRate> turned_rates(const Problem& problem, const Unknowns& z, const AngleTies& ties,
                                     const Mechanism& mechanism, const VariedNumbers& numbers, Workspace& w);

} // namespace flyball
