// The measures of a mechanism in motion, and how they change along directions of its state.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/measures.hpp"
#include "engine/system/motion.hpp"

namespace flyball {

// Of the released system, drives last: configuration, velocity and acceleration; multipliers of all rows.
struct MotionOfAll {
  Eigen::VectorXd q, u, a, lambda;
};

// A direction in the space of all states and numbers: changes of q as a tangent vector, of u, a and lambda,
// and of the number `number` of those that vary (-1: none).
struct MotionDirection {
  Eigen::VectorXd q, u, a, lambda;
  int number = -1;
  double change = 0; // of that number, in its unit
};

class MotionOutputs {
 public:
  // The last `count` measures of the model's mechanism, whose numbers at these addresses vary.
  MotionOutputs(const MotionModel& model, std::span<const std::string> addresses, std::size_t count,
                bool accelerated);

  // The model's own numbers count. Not finite where one is not known.
  Eigen::VectorXd values(const MotionOfAll& at);

  // Their rates along the direction, which is to be as large as what the state is measured by (a radian, the
  // mechanism's reach, ...): central differences over 4e-3 of it, or less where that tells more, extrapolated
  // twice (Richardson; Ridders, Accurate computation of F'(x) and F'(x)F''(x), 1982), and what the last
  // extrapolation changed, or half a step where it had nothing to go by. On a kink there is none: half of how
  // much the slope jumps, else 0.
  struct Rates {
    Eigen::VectorXd value, error, kink;
  };
  Rates along(const MotionOfAll& at, const MotionDirection& direction);

 private:
  Eigen::VectorXd evaluate(const MotionOfAll& at, const Parameters& parameters);

  const MotionModel& model_;
  std::size_t count_;
  bool accelerated_;
  Mechanism varied_;
  VariedNumbers numbers_;
  std::vector<double> set_; // values of these
  MeasureSet measures_;
  Parameters parameters_;
  Kinematics<double> kinematics_;
  std::vector<LinkRates> carried_;
  Residual<double> residual_;
  std::vector<double> coordinates_, rates_, torques_;
  std::vector<double> near_; // coordinates of the state, whose whole turns count
};

} // namespace flyball
