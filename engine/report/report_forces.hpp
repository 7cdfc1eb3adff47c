// What drives, joints and gears bear in a steady state, and what of it changes as the drives turn.
#pragma once

#include "engine/report/report.hpp"

namespace flyball {

// Evaluates a state with the drives `t` seconds on, without multipliers, and finds them. Where loops are
// redundant those of least norm, or in large mechanisms with none on rows that follow from others.
Unknowns with_reported_multipliers(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w);

// Fills multipliers, drive torques, reactions and gears. `z`: from the above at the drawn phase, evaluated
// with its multipliers.
void report_forces(const ReportInput& input, const Unknowns& z, Workspace& w, Solution& out);

} // namespace flyball
