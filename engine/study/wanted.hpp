// What is wanted of a steady state, by name: a free coordinate, the speed that a drive by torque finds, or a
// measure.
#pragma once

#include "engine/continuation/extended_balance.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>

namespace flyball {

struct Wanted {
  const CoordinateInfo* coordinate =
      nullptr;             // of the system, or of its speed (see found_value); null: a measure
  std::size_t measure = 0; // of the mechanism
};

// "joint", "joint.index", "joint.speed" or a measure's name. Throws SceneError that names what there is.
Wanted find_wanted(const Mechanism& mechanism, const System& system, const std::string& name);

// That it has a value. `lowest` and `highest`: what it covers where it is looked for, by which a measure is
// scaled.
Condition wanted_is(const Wanted& wanted, double value, double lowest, double highest);
double scale_of_measure(double value, double lowest, double highest);

// "rad", "m", "rad/s", "m/s" or the measure's.
std::string unit_of(const Mechanism& mechanism, const System& system, const Wanted& wanted);
// What differences are measured by; of a measure nothing by itself.
std::optional<double> scale_of(const System& system, const Parameters& parameters, const Wanted& wanted);
// A value less a wanted one, of angles that turn freely the short way round.
double away_from(const System& system, const Parameters& parameters, const Wanted& wanted, double value,
                 double goal);

} // namespace flyball
