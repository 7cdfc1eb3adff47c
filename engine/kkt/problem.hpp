// One solve's fixed data: the system, its numbers, and the units that make its equations comparable.
#pragma once

#include "engine/system/linearization.hpp"
#include "engine/system/potential.hpp"

#include <atomic>

namespace flyball {

// Unknowns are scaled to radians and characteristic lengths, constraint rows likewise; forces then have units
// of energy in every equation, and a change of the unit of length changes nothing. Speeds that are found are
// scaled by found_speed_unit(), and their equations have units of power.
struct Scaling {
  Eigen::VectorXd column; // rad or m (or a second) per scaled unit, by coordinate of q_R
  Eigen::VectorXd row;    // scaled units per m, rad or 1, by constraint row
};
void set_scaling(const System& system, const Parameters& parameters, Scaling& scaling);

// What a speed that is found is measured by, rad/s or m/s: that at which its search begins; where that is
// rest, as of what loops turn, a radian or the reach a second.
double found_speed_unit(const System& system, const Parameters& parameters, const Link& link);

struct Problem {
  const System& system;
  const Parameters& parameters;
  const Scaling& scaling;
  const std::atomic<bool>* cancel = nullptr;
  // The system's own, or the dense matrices whatever their size, for studies of the matrices themselves.
  KktForm form = KktForm::dense;

  // To be taken for the gradient of the amended potential although drives ride on drives, or torques drive at
  // speeds that then stay as they are: of a descent.
  bool as_gradient = false;

  // The balance is the gradient of the amended potential, so its Jacobian is symmetric where it matters.
  bool symmetric() const { return system.conservative && (system.single_drives || as_gradient); }
  // The same but for the torques of drives, of a system that speeds_can_border().
  bool symmetric_at_speeds() const {
    return !system.torques.empty() && form != KktForm::dense && system.conservative_at_speeds;
  }
  bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
};

// The units of the linearised motion: those of the balance (Scaling), but what turns at a speed that is found
// (drive_torque.hpp) is a coordinate like others here, a cyclic one, since no force depends on it, and is
// measured by its angle or way. By the speed its inertia would count by the square of the unit of time, and
// beside what others have either would be lost.
Scaling motion_scaling(const Problem& problem);

// Up to which a speed that is found is followed, rad/s or m/s: far above what it is measured by, since a
// search may begin almost at rest.
double largest_found_speed(const Problem& problem, const Link& link);

// Pivots of the constraints below this, of the largest, belong to dependent rows: where the loops, whose rows
// come to `phi` (m, rad or 1), are open, those of the size by which they are; closed, rounding.
double rank_tolerance(const Problem& problem, const Eigen::VectorXd& phi);

// z of eq. 24.
struct Unknowns {
  Eigen::VectorXd q, lambda;
};

} // namespace flyball
