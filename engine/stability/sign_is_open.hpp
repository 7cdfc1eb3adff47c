// Whether the error of a state leaves the sign of its least stiffness open.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

// The least stiffness changes by its own size within `error` (of q_R; rad, m), or is below its rounding: at a
// fold or branch point it does, and nobody can tell whether the state is stable. `minimum`: as pivots have
// it. Of a dense problem with a potential; false of others. The workspace is used for states beside this one.
bool sign_is_open(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& error, bool minimum,
                  Workspace& w);

} // namespace flyball
