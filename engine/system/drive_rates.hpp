// How fast drives go on, and times at which to look so that what is so at each of them is so at every phase.
//
// The angles of drives that turn at w_1, w_2, ... come near every place of the torus on which the motion lies
// (Arnold, Mathematical Methods of Classical Mechanics, section 51): all of them where the rates have no
// common measure, and then what two drives do to each other takes as long to come round as their beat
// |w_1 - w_2| tells.
#pragma once

#include "engine/system/parameters.hpp"

namespace flyball {

struct DriveRate {
  double rate = 0;   // rad/s; of a slide 1/s, its speed over the mechanism's reach
  bool turns = true; // and comes round
};

// Of all that is driven, positive, no two alike; what is found from rest counts as 1/s. What torques drive:
// as it is given, or as it is in `q` where it is not next to rest there.
std::vector<DriveRate> drive_rates(const System& system, const Parameters& parameters);
std::vector<DriveRate> drive_rates(const System& system, const Parameters& parameters,
                                   const Eigen::VectorXd& q);

// 1/s; zero where nothing is driven.
double fastest_rate(const std::vector<DriveRate>& rates);
// 1/s, of what is given, torques' beginnings included; zero where all of it is at rest.
double fastest_given_rate(const System& system, const Parameters& parameters);

// s: for every rate and every low combination of rates several that lie apart on a turn of it (a third of the
// reach counts as a radian), without those for which the times before them do. Of one rate four.
std::vector<double> phase_times(const std::vector<DriveRate>& rates);

// rad: of an angle that has gone on for so long, that of double precision.
double angle_rounding(const std::vector<DriveRate>& rates, double time);

} // namespace flyball
