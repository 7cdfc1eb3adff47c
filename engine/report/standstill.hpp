// A mechanism with coordinates held where they are, as dry friction holds them: as if driven at the speed
// zero. What drives by torque turn stands still with them where gears tie it to them, or where springs do and
// it has come to rest.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// Of a coordinate that stands still: rad or m, as its joint labels it.
struct Standing {
  CoordinateReference at;
  double value = 0;
};

// A torque and its load at rest (N m or N): numbers, or where their laws ask for more than rates the values
// of measures that the mechanism has for them.
struct TorqueAtRest {
  CoordinateReference at; // whose drive it is
  std::array<double, 2> value{};
  std::array<std::string, 2> measure{}; // its name; empty where `value` is known
  CoordinateReference held;             // that a gear train makes it act on
  double ratio = 1;                     // of its rate over that of the held coordinate
};

struct Standstill {
  Mechanism mechanism;     // without measures of its own
  std::vector<bool> fixed; // by held coordinate: it closes a loop of driven joints, as a clutch between two
                           // shafts does, and its joint is a fixed one
  std::vector<TorqueAtRest> carried; // which no balance of the mechanism has
  std::vector<TorqueAtRest> resting; // which act on coordinates that are free now, and have no other drive
};

// What is asked of the values of `held` and of `others`, which stand, too, by the laws of drives is in
// numbers. `at_rest`: drives by torque that have come to rest against what springs give; their torques must
// be of their own rates alone. Throws SceneError where they are not, or a law is no number then.
Standstill stand_still(const Mechanism& mechanism, std::span<const Standing> held,
                       std::span<const Standing> others, std::span<const CoordinateReference> at_rest);

// Sets of drives by torque that gears do not tie to held coordinates, the empty one first: which of them may
// have come to rest. With more than three drives none and all. Of what turns in place only those that held
// coordinates tie to what stands.
std::vector<std::vector<CoordinateReference>> may_rest(const Mechanism& mechanism,
                                                       std::span<const CoordinateReference> held);

// Along a held coordinate, of what it carries; `measures`: of the state. Nothing where a torque has no value.
std::optional<double> carried_torque(const Standstill& still, CoordinateReference held,
                                     std::span<const MeasureSolution> measures);
// Torque and load of one.
std::optional<std::array<double, 2>> values_at_rest(const TorqueAtRest& torque,
                                                    std::span<const MeasureSolution> measures);

// Whether "joint.speed" is the speed of a drive that stands still.
bool is_speed_at_rest(const Mechanism& mechanism, const Standstill& still, std::string_view name);

// What holds a joint of one axis that is fixed so (N m or N, positive along its coordinate), of its reaction;
// `turned`: its parent from the drawn pose.
double holding_force(const Joint& joint, const Reaction& reaction, const Mat3& turned);

} // namespace flyball
