// What is told of a steady state's stability: by pivots, matrices or the lowest eigenvalues, as its size
// asks.
#pragma once

#include "engine/search/steady_state.hpp"
#include "engine/stability/stability.hpp"

#include <string>

namespace flyball {

// Whether there are too many coordinates to find all eigenvalues, and the balance is solved without dense
// matrices.
bool is_large(const Problem& problem);
// Whether the pivots of the factored balance then tell the stability; where torques drive they do not.
bool pivots_decide(const Problem& problem);

// Few coordinates by the matrices, whatever the form that solving takes.
Problem by_matrices(const Problem& problem);

// The eigenvalues are left out where they are many and no `modes` are asked for.
Stability stability_of(const Problem& problem, SteadyState& steady, bool with_eigenvalues, int modes);

// Whether a spring, damper or vane stands where the slope of its law jumps.
bool stands_on_kink(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);

// Whether what decides may have the other sign within the error of the state.
bool sign_may_change(const Problem& problem, SteadyState& steady, const Stability& stability);

// What cannot be told, of a state whose error is taken for that of something too soft to be seen beside what
// is stiff, which may hold it.
void leave_verdict_open(SteadyState& steady, Stability& stability);

// Adds the eigenvalues nearest to zero of a large mechanism to what its pivots say; where those decide
// nothing one that grows does. Returns why there are none.
std::string add_lowest_eigenvalues(const Problem& problem, const Unknowns& z, int count, Workspace& w,
                                   Stability& out);

// Of a large mechanism as many eigenvalues as are asked for.
void keep_asked_for(const Problem& problem, int modes, Stability& stability);

// Of the balance on the null space, scaled and equilibrated, where that is not too large.
void add_condition(const Problem& problem, SteadyState& steady, Solution& out);

} // namespace flyball
