// Downhill on the amended potential, each iteration at the cost of an Eliminator
// and as many of them for a fine chain as for a coarse one.
//
// Newton steps within a trust region (More and Sorensen, Computing a trust region step, 1983). What is
// trusted is the length of the motion in the eliminator's metric and not that of the joint angles: in a fine
// chain a smooth bend takes small angles at many joints and a kink a large one at a single joint. Where the
// potential is not convex the signs of the pivots say so; then a model without compression leads on, and
// where that ends a direction of negative curvature from inverse iteration. Loops that a step opens are
// closed by Gauss-Newton as far as it takes to judge the step, and what is left is priced by the multipliers.
#pragma once

#include "engine/solve/descent.hpp"

namespace flyball {

// As descend(), for a problem that is the gradient of the potential and either is not dense or has
// is_plain_tree(). Ends near a minimum where Newton-Raphson leads on at less cost, as with loops it does,
// unless `all_the_way`. `falls`: the balance has been linearised at z and is known to be no minimum's.
DescentOutcome descend_by_trust(const Problem& problem, Unknowns& z, Workspace& w,
                                std::vector<double>* history, bool all_the_way, bool falls);

} // namespace flyball
