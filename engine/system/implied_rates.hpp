// Coordinates that loops and gears make turn at constant rates as drives turn: the planets of a planetary
// set, the coupler of a parallelogram. Each has its rate w among the unknowns, as a drive by a torque of
// nothing (drive_torque.hpp), and the loops that only such coordinates move are equations of the rates,
//
//     d/dt Phi = Phi_q w = 0,    with the multipliers of Phi in the balance as ever.
//
// They are closed as drawn; that they stay so is asked of every phase (check_existence()).
#pragma once

#include "engine/system/kinematics.hpp"

namespace flyball {

// The coordinates, not turning yet, that have to turn for the loops to stay closed as drawn; and with those
// that may turn `beside` them, tied to them by loops and gears: those of a differential, whose speeds the
// forces decide. None where what moves is no coordinate of one axis by itself, or springs hold it.
std::vector<CoordinateReference> implied_turning(const System& system, const Parameters& parameters,
                                                 bool beside);

// Whether the loops stay closed as all that neither springs nor stops hold turns on with the drives: then a
// state in which those stand still, though the system's equations have no place for it, may well be steady.
bool loops_turn_with_drives(const System& system, const Parameters& parameters);

// The coordinates, not turning yet, that torques push on wherever they stand and nothing holds, alone or as
// gears tie them together: the planets of a differential, a wheel on a bearing in the air. They cannot stand
// still, and so turn.
std::vector<CoordinateReference> slipping_turning(const System& system, const Parameters& parameters);

// Where the search for implied rates begins: at those of the drawn pose.
void set_implied_rates(const System& system, Parameters& parameters);

// Puts all speeds that are found, those of drives by torque too, to rates with which the loops stay closed as
// drawn, near where the search for them begins: what begins otherwise tells nothing of the loops. As they are
// where there are none.
void set_closing_rates(const System& system, Parameters& parameters);

// Puts, for the loops whose equations are those of rates, how far they are open (m or 1) in the place of the
// rates of that. Gears mesh wherever they are put together.
void set_closures(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                  const Kinematics<double>& kinematics, Eigen::VectorXd& phi);

} // namespace flyball
