// One solve's fixed data: the system, its numbers, and the units that make its equations comparable.
#pragma once

#include "engine/system/linearization.hpp"
#include "engine/system/potential.hpp"

#include <atomic>

namespace flyball {

// Unknowns are scaled to radians and characteristic lengths, constraint rows likewise; forces then have units
// of energy in every equation, and a change of the unit of length changes nothing.
struct Scaling {
  Eigen::VectorXd column; // rad or m per scaled unit, by coordinate of q_R
  Eigen::VectorXd row;    // scaled units per m, rad or 1, by constraint row
};
void set_scaling(const System& system, const Parameters& parameters, Scaling& scaling);

struct Problem {
  const System& system;
  const Parameters& parameters;
  const Scaling& scaling;
  const std::atomic<bool>* cancel = nullptr;
  // As the system's elimination says; else by dense matrices whatever their size, which is what studies of
  // the matrices themselves need.
  bool eliminated = false;

  // The balance is the gradient of the amended potential, so its Jacobian is symmetric where it matters.
  bool symmetric() const { return system.conservative && system.single_drives; }
  Elimination elimination() const { return eliminated ? system.elimination : Elimination::dense; }
  bool is_dense() const { return elimination() == Elimination::dense; }
  bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
};

// z of eq. 24.
struct Unknowns {
  Eigen::VectorXd q, lambda;
};

} // namespace flyball
