// Which integrator suits a motion.
#pragma once

#include "engine/dynamics/equations.hpp"

namespace flyball {

struct MethodChoice {
  Integrator method = Integrator::runge_kutta;
  std::string reason;    // a sentence
  double rate_scale = 1; // 1/s, how fast the motion is as a rule
  double fastest = 0;    // 1/s, the largest rate of the linearised motion; 0: not known
};

// From the linearised motion at a state (t; q and s as Equations has them) that is the last evaluated: BDF
// where fast motions die out long before the end (`duration`, s, from here), or are too small to be seen, for
// explicit steps stay as short as those ask for. All rates are found for small mechanisms, the fastest for
// large ones.
MethodChoice choose_method(Equations& equations, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s,
                           double duration, double tolerance, Integrator wanted);

} // namespace flyball
