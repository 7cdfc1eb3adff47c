// Passing positions at which constraints become dependent: a linkage stretched out, where its arms could part
// company. Motion through such a position is smooth, but to resolve it is hopeless: rounding by which the
// loops are open grows without bound near it, and an integrator that follows it closely may leave on the
// wrong branch, if it leaves at all. So the last bit is leapt over, straight on.
#pragma once

#include "engine/dynamics/equations.hpp"

namespace flyball {

struct Leap {
  double time = 0; // s, on the far side
  Eigen::VectorXd q, s;
  Eigen::Vector3d energies =
      Eigen::Vector3d::Zero(); // J, what is dissipated, delivered and applied on the way
};

// The far side of a singular position that the state is about to pass, or nothing. `best` is the greatest
// independence seen so far.
std::optional<Leap> leap(Equations& equations, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s,
                         double best, double rate_scale);

} // namespace flyball
