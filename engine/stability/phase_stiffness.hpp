// How the balance changes with the angle, or the way along its axis, of what turns at a speed that is found.
// In most mechanisms it does not: what turns so is a cyclic coordinate. Where it turns as fast as another
// drive does, or not at all, a steady state need not be the same with it elsewhere: a shaft left to itself
// stands in a field of weight, and a spring between two shafts that turn alike holds the one against the
// other. Then the angle belongs to the linearised motion as other coordinates do.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

struct PhaseStiffness {
  // Of q_R: those whose angle matters by itself, most often none; nor where loops let none turn so that it
  // would.
  std::vector<int> entries;
  Eigen::MatrixXd columns; // (nv, entries), N or N m per rad or m: of the forces along all coordinates
};

// At z and the drawn phase, with its multipliers: by differences of sixth order, to some 14 digits of the
// largest force.
PhaseStiffness phase_stiffness(const Problem& problem, const Unknowns& z, Workspace& w);

// Whether the mechanism is balanced, with some multipliers, wherever it is moved along `turned` (nv; rad or m
// of each speed that is found) from z; looked at in two places at a distance. Of `free` directions alone (nv,
// k; rad or m of each coordinate, which no loop holds), where others are held by what is no part of the
// balance.
bool balanced_along(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& turned, Workspace& w,
                    const Eigen::MatrixXd* free = nullptr);

} // namespace flyball
