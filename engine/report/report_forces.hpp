// What drives, joints, gears and bearings bear in a steady state, and what of it changes as the drives turn.
#pragma once

#include "engine/report/report.hpp"
#include "engine/system/reactions.hpp"

namespace flyball {

// Evaluates a state with the drives `t` seconds on, without multipliers, and finds them. Where loops are
// redundant those of least norm, or in large mechanisms with none on rows that follow from others.
Unknowns with_reported_multipliers(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w);

// The same at the drawn phase, evaluated with them.
Unknowns evaluate_reported(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);

// Which forces redundant loops leave open at a state with the drives `t` seconds on: many others balance as
// well.
struct OpenForces {
  std::vector<OpenWrench> joints; // by Mechanism::joints; none of gears
  std::vector<bool> gears;        // likewise
  std::vector<bool> drives;       // by System::drives
};
// `joints`: how many the mechanism has.
OpenForces find_open_forces(const Problem& problem, std::size_t joints, const Eigen::VectorXd& q, double t,
                            Workspace& w);

// The ends of a gear as it names its joints, not as forces reach it.
struct GearEnds {
  GearForces::End a, b;
};
GearEnds ends_in_order(const Mechanism& mechanism, const System& system, const GearForces& gear);

struct ReportedForces {
  std::vector<JointMultipliers> multipliers;
  std::vector<DriveTorque> drive_torques;
  std::vector<Reaction> reactions;
  std::vector<GearReaction> gears;
  std::vector<BearingForce> bearings;
  bool nonunique = false; // any of them
};
// Of a state by evaluate_reported(), which the workspace leaves.
ReportedForces report_forces(const Mechanism& mechanism, const Problem& problem, const Unknowns& z,
                             Workspace& w);

} // namespace flyball
