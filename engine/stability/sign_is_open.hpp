// Whether the error of a state leaves it open whether it is stable.
#pragma once

#include "engine/solve/newton.hpp"
#include "engine/stability/stability.hpp"

namespace flyball {

// Within `error` (of q_R; rad, m, or of a speed) of a steady state z the least stiffness changes by its own
// size, or is below its rounding; or, where torques drive, the largest real part of its eigenvalues does: at
// a fold or branch point that is so, and nobody can tell whether the state is stable. On kinks of springs on
// their softer side. Of a dense problem; false of others, and of what is open anyway. The workspace is used
// for states beside this one.
bool sign_is_open(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& error,
                  const Stability& stability, Workspace& w);

// The same of a state whose error is not known, with its balance factored: where that is nearly singular the
// error is that of the same state found from a little beside.
bool sign_is_open(const FactoredState& at, const Stability& stability);

// Takes the verdict back.
void leave_open(Stability& stability);

// Of a state at singular loops: along their tangents more moves than can, so that what grows there need not
// grow, and nothing swings so.
void leave_out_modes(Stability& stability);

} // namespace flyball
