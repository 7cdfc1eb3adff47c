// Whether dry friction holds a mechanism at given coordinates, and by how much.
//
// Joints with friction stand still there, as if driven at the speed zero, and what else is free settles. What
// holding them takes is then what such drives would have to give. Where loops tie joints with friction to
// each other they share it as is best for holding: the least largest part of a limit that balances.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"

#include <atomic>
#include <cmath>
#include <optional>
#include <span>

namespace flyball {

struct HeldJoint {
  std::string joint;
  int index = 0, count = 1;
  bool angle = true;           // N m rather than N
  double limit = 0;            // N m or N
  std::optional<double> force; // that friction has to give, positive along the coordinate; of forces that
                               // change with the phase of the drives the largest. Nothing where loops leave
                               // it open how several joints share it
};

struct Holding {
  // The largest part of a limit that holding takes: below 1 friction holds. Infinite where a limit of zero
  // would have to hold something. Nothing where `message` says why.
  std::optional<double> takes;
  // Less than this holding cannot take. Differs from `takes` where loops leave it open how joints share.
  double at_least = 0;
  std::vector<HeldJoint> joints;        // with friction, in the scene's order
  std::vector<std::size_t> independent; // of `joints`: those that loops do not tie to the ones before them
  std::string first;                    // the joint that slips first, where that is known
  std::string message;                  // a sentence
  // Whether what is free beside the joints that stand rests stably there; found where it is explained.
  std::optional<bool> rest_stable;
};

// At the drawn pose with the coordinates of `at` ("joint" or "joint.index", rad or m) in place of the drawn
// ones. Throws SceneError for names of no coordinate. `explain`: whether the message says why speeds that are
// found are missing, and whether the rest is stable, which take time.
Holding find_holding(const Mechanism& mechanism, const std::vector<std::pair<std::string, double>>& at,
                     const std::atomic<bool>* cancel = nullptr, bool explain = true);

// The speeds of a drive between which friction holds the mechanism where it stands: at `lower` and `upper` it
// begins to slip.
struct HeldSpeeds {
  std::string joint; // the drive's
  int index = 0, count = 1;
  bool angle = true;                  // rad/s rather than m/s
  double speed = 0;                   // of the scene
  std::optional<double> lower, upper; // nothing: it holds down to rest; however fast, as far as was looked

  // (upper - lower) over their mean: a governor's insensitivity.
  std::optional<double> insensitivity() const {
    if (!lower || !upper) return {};
    return (*upper - *lower) / (std::abs(*upper + *lower) / 2);
  }
};

// Of each drive at a given speed other than zero; none where the mechanism does not hold at its own speeds.
std::vector<HeldSpeeds> find_held_speeds(const Mechanism& mechanism,
                                         const std::vector<std::pair<std::string, double>>& at,
                                         const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
