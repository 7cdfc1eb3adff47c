// Downhill on the amended potential, one factorization of the KKT matrix or a few an iteration,
// and as many of them for a fine chain as for a coarse one.
//
// Newton steps within a trust region (More and Sorensen, Computing a trust region step, 1983). What is
// trusted is the length of the motion in the eliminator's metric and not that of the joint angles: in a fine
// chain a smooth bend takes small angles at many joints and a kink a large one at a single joint. Where the
// potential is not convex the signs of the pivots say so; then a model without compression leads on, and
// where that ends a direction of negative curvature from inverse iteration. Loops that a step opens are
// closed by Gauss-Newton as far as it takes to judge the step, and what is left is priced by the multipliers.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

enum class DescentEnd {
  minimum, // strict, or flat only along directions without stiffness; at speeds that will be others, near it
  near,    // the quadratic model serves as far as it goes, and that is not far
  unbounded, // the potential falls on, hundreds of times the reach away
  stalled,   // no step lowers it: not a potential after all, or rounding
  cancelled,
};

struct DescentOutcome {
  DescentEnd end = DescentEnd::stalled;
  int iterations = 0;
  bool factored = false; // the balance at z
};

// Whether the forces have a potential to go down by. Away from equilibria that of drives that ride on drives
// is one for few coordinates only, whose matrices can be made symmetric; where torques drive trees it is that
// at the speeds of the start, which stay.
bool has_descent(const Problem& problem);

// From z.q, whose loops must be closed; never raises the potential. Appends the scaled residual to `history`
// (may be null). Ends near a minimum where Newton-Raphson leads on at less cost, as it does with loops and to
// other speeds, unless `all_the_way`. `falls`: the balance has been linearised at z and is known to be no
// minimum's.
DescentOutcome descend(const Problem& problem, Unknowns& z, Workspace& w, std::vector<double>* history,
                       bool all_the_way, bool falls);

} // namespace flyball
