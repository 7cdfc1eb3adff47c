// How measures change along steady states that stand turned (search/turned_rates.hpp).
#pragma once

#include "engine/report/measures.hpp"
#include "engine/search/turned_rates.hpp"

namespace flyball {

// By the number `which` of `mechanism`, per its unit, at the state q whose rate with it this is: central
// differences along the state, to some nine digits. Not numbers where no mechanism can be made beside it. The
// numbers are varied, and set back; so are the measures, bound as before.
Eigen::VectorXd turned_measure_rates(const Problem& problem, const Eigen::VectorXd& q, const TurnedRate& rate,
                                     MeasureSet& measures, const Mechanism& mechanism, VariedNumbers& numbers,
                                     std::size_t which, Workspace& w);

} // namespace flyball
