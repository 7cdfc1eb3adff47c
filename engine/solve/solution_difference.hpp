// How far steady states are from each other by what solving tells of them: the metric of
// configuration_difference.hpp on coordinates as they are told. Angles in radians, by the short way round;
// lengths in parts of the mechanism's reach; speeds that are found by their size. What drives prescribe is
// alike.
#pragma once

#include "engine/solve/solution.hpp"

#include <vector>

namespace flyball {

// Of one coordinate, scaled and with its sign; 0 where it is driven.
double value_difference(const CoordinateSolution& from, const CoordinateSolution& to);
// Of the speed that is found of it, as a part of the largest of the two and of that where the search for it
// began; 0 where there is none, or where it follows from others.
double speed_difference(const CoordinateSolution& from, const CoordinateSolution& to);

// The largest of all; infinity where they have not as many coordinates.
double scaled_distance(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b);
// The sum of squares of all; infinity likewise.
double squared_distance(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b);

// A part of the way from one state to another, by the short way round: values and speeds. What else is told,
// errors included, is of the nearer one.
std::vector<CoordinateSolution> coordinates_between(const std::vector<CoordinateSolution>& a,
                                                    const std::vector<CoordinateSolution>& b, double part);

} // namespace flyball
