// What the solvers call short, closed, balanced or the same: each with its unit and reason.
//
// "Scaled" is a step in radians or in reaches of the mechanism (Scaling::column), an opening of a loop in
// radians or reaches (Scaling::row), and a force as a part of the sizes of the terms it is the sum of. eps is
// 2.2e-16. Which pivots are zero is said where they are made (kkt/kkt_system, kkt/reduced_hessian), how much
// rounding an answer has is not assumed but estimated (refine).
#pragma once

#include <limits>

namespace flyball::tolerance {

// Newton-Raphson.
constexpr double step = 1e-9;             // scaled; quadratic convergence puts the error at its square
constexpr double short_step = 1e-4;       // scaled; where it falls tenfold, too, convergence is quadratic
constexpr double last_step = 1e-8;        // scaled; the next is its square, rounding
constexpr double trusted_error = 1e-2;    // of the step's tolerance: foreseen by the last two, so not taken
constexpr double neutral_step = 1e-5;     // scaled; along null directions rounding makes steps as long
constexpr double linear_step = 1e-6;      // scaled; while shrinking slowly: linear convergence, a double root
constexpr double linear_residual = 1e-15; // scaled, beside linear_step: nothing is left but rounding
constexpr double proximal_residual =
    1e-12; // scaled, where null directions are kept still: as above, many bodies
constexpr double singular_residual = 1e-13; // scaled: without stiffness only the balance itself decides
// Scaled: short steps with more left are no state. No coordinate resists that force, or no step closes the
// loop.
constexpr double balance = 1e-8;
constexpr double near_balance = 1e-6; // scaled; nearer than this Newton's method stays, unstable or not
constexpr double far = 1e8;           // scaled step; only a balance as good as linear leads so far
constexpr double farthest = 1e14;     // scaled step; beyond it eps is a hundredth of a reach

// Damping, of Newton-Raphson and the descents.
constexpr double sufficient_decrease = 1e-4; // of what the slope promises (Armijo; Nocedal and Wright, 3.1)
constexpr double least_fraction = 1e-6;      // of a Newton step: shorter ones lead nowhere
constexpr double merit_rounding = 1e-13;     // scaled: a merit as low falls no further
constexpr double least_homotopy_step = 1e-4; // of the squared speed

// Loops, scaled.
constexpr double closed = 1e-10;                  // closing them has worked
constexpr double closed_to_rounding = 1e-14;      // and need not go on
constexpr double least_closing_step = 1e-15;      // shorter steps change nothing
constexpr double least_closing_fraction = 1e-8;   // of a step that opens them more
constexpr double closed_on_descent = 1e-13;       // a step of a descent need not have them closer
constexpr double almost_closed_on_descent = 1e-6; // where what is open costs little of what the step gains
constexpr double slowly_closed = 1e-11;        // where the last iterations gained nothing: rounding, surely
constexpr double slowly_closed_at_most = 1e-9; // the same, where they were open as much before

// Descents of the amended potential.
constexpr double potential_rounding = 1e-14; // of its terms: a smaller difference is none
constexpr double energy_rounding = 1e-12;    // the same between two poses far apart
constexpr double saddle_step = 1e-6;         // scaled; steps so short, and a fall: step off a saddle
constexpr double small_force = 1e-6;         // scaled; so small at a saddle, or along null directions
constexpr double neutral_force = 1e-9;       // scaled; less does not push along a null direction
constexpr double converged_step = 1e-8;      // scaled; a minimum
constexpr double stalled_step = 1e-5;        // scaled; a minimum where rounding allows no step, else stalled
constexpr double newton_leads_step = 1e-3;   // scaled; Newton-Raphson may take over
constexpr double speeds_lead_step = 0.2;     // scaled; likewise where speeds will be others
constexpr double least_radius = 1e-12;       // of the mechanism's size: no step is taken any more

// Verdicts on states.
constexpr double same_state = 1e-6; // scaled distance; states nearer are one
constexpr double known = 1e-6; // of the reach, or of the distance where longer: what is known worse is none
constexpr double proximal_shift = 1e-3;  // of the potential's curvature: stills null directions, little else
constexpr double inertia_shift = 1e-5;   // the same, where it is to outweigh rounding alone
constexpr double still_factored = 1e-14; // scaled step and residual: factors taken there serve here
constexpr double still_factored_large = 1e-12; // the same of many bodies, whose rounding adds up

// Phases of the drives.
constexpr double phase_balance = 1e-8; // scaled; what turns with the drives is rarely so small by chance
constexpr double phase_rounding = 64 * std::numeric_limits<double>::epsilon(); // scaled; less is no variation
constexpr double phase_variation = 1e-2; // scaled; what the drives move further does not stand
constexpr double phase_stands = 1e-12;   // scaled; what they move less stands: it is no motion

// Forces that push on without end.
constexpr double push_rounding = 1e-9;  // of the terms that a force is the sum of
constexpr double constant_push = 1e-6;  // of a force: it has not become less by more
constexpr double remaining_push = 1e-3; // of a force: all round a turn as much is left

// Directions of a state.
constexpr double takes_part = 1e-6; // of a direction's largest entry: the coordinate moves in it
constexpr double symmetric = 1e-9;  // of a stiffness: that of a potential may differ from its transpose so
constexpr double second_difference = 1e-3; // scaled step, and of the stiffness what its error may be

// Eigenvalues s of the linearised motion.
constexpr double on_axis = 1e-8;             // of |s|: a real part as small is rounding
constexpr double on_axis_of_largest = 1e-12; // of the largest |s|: rounding that all eigenvalues share
// Of the largest |s|: a null direction has a double zero, of which rounding leaves its root.
constexpr double null_eigenvalue = 1e-5;
constexpr double null_damping = 1e-11; // of C + G: so little of it along a null direction is none
constexpr double massless = 1e-13;     // of M: an inertia as small is rounding
constexpr double without_force =
    1e-10;                       // of K or of C + G: so little of it along a massless direction is none
constexpr double coupled = 1e-8; // of K: between massless directions and others

// Floquet multipliers mu.
constexpr double multiplier = 1e-8;          // | |mu| - 1 |: rounding of one by itself
constexpr double multipliers_meet = 1e-3;    // distance of two: nearer they are known to the root of that
constexpr double meeting_multiplier = 1e-6;  // | |mu| - 1 | of these
constexpr double neutral_multiplier = 1e-4;  // |mu - 1|: of a neutral direction and its rate, which meet at 1
constexpr double departed_multiplier = 1e-6; // |mu| - 1 of an undamped motion: it has left the circle

// Branches; lengths are scaled arclength.
constexpr double special_point = 1e-11;    // length: folds, crossings and Hopf points are located so well
constexpr double same_parameter = 1e-6;    // of the parameter's range, and
constexpr double same_branch_pose = 1e-5;  // scaled: points nearer are one
constexpr double least_branch_step = 1e-9; // length; where even this fails the loops lock
constexpr double longest_corner = 1e-6;    // length; a stop reached or left bends the branch within it

} // namespace flyball::tolerance
