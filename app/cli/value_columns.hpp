// What rows of a study tell of a steady state: a number each of its free coordinates, speeds that torques
// give, and measures. The same columns at every point, whether it has an answer or not: coordinates that may
// slip have one for where they stand, and one for how fast they slip.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"
#include "engine/study/sweep.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

struct ValueColumn {
  std::string name, unit; // "slide", or "free.2"
  bool measure = false;   // one of the measures rather than the coordinates
  std::size_t place = 0;  // there
  bool speed = false;     // of the coordinate
};
// Of what turns at the mechanism's own numbers, or at the ends of the ranges.
std::vector<ValueColumn> value_columns(const Mechanism& mechanism,
                                       std::span<const Variation> variations = {});

// Not finite where there is none, or a coordinate turns with the drives. The speed of what stands is zero.
double value_at(std::span<const CoordinateSolution> coordinates, std::span<const MeasureSolution> measures,
                const ValueColumn& value);

// Of a state that rests on dry friction: "held" where that holds all, "slips" where something does; else
// empty.
std::string_view friction_word(std::span<const FrictionForce> frictions);

} // namespace flyball::cli
