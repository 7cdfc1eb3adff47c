// Dry friction in the motion: which joints stick and which way the others slip. Between two changes of this
// the equations are smooth: a joint that sticks has one constraint more, that its coordinate stands still,
// whose multiplier is what friction gives; one that slips has a constant force against its rate.
#pragma once

#include "engine/dynamics/motion_model.hpp"

namespace flyball {

// A coordinate with friction that is not zero.
struct FrictionElement {
  int link = 0;
  double limit = 0; // N m or N
};
std::vector<FrictionElement> list_frictions(const MotionModel& model);

// One that is held by a constraint, maybe together with others that loops tie to it.
struct FrictionHold {
  std::size_t element = 0;
  int row = 0;      // of the constraints
  double least = 0; // N m or N: what friction gives along it is between these
  double most = 0;
  struct Tied {
    std::size_t element = 0;
    double rate = 0; // of its coordinate with the held one's
  };
  std::vector<Tied> tied{};
};

// What takes more than its limits by this does not stick.
inline constexpr double slipping_by = 1 + 1e-9;

struct FrictionModes {
  std::shared_ptr<const MotionModel> model;
  std::vector<FrictionHold> holds;
  // Elements whose coordinates are at dead points: they stand still while the loops move, and to hold them
  // holds nothing. Or would stop at once what passes on.
  std::vector<std::size_t> at_dead_points;
};

// `slips` by element: 1 where the coordinate grows, -1 where it falls, 0 where it sticks at q. The model has
// the states of `free`. `u`: the rates with which it comes to q, `rate` (1/s): a usual one. Throws SceneError
// where loops tie one that sticks to several others.
FrictionModes with_modes(const MotionModel& free, const std::vector<FrictionElement>& frictions,
                         const std::vector<int>& slips, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                         double rate);

} // namespace flyball
