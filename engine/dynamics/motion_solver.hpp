// What solves the equations of motion at a state (eq. 19), for the accelerations and for the steps of
// implicit methods: by dense matrices (dense_motion.hpp), along a tree in time proportional to its bodies
// (tree_motion.hpp), or as sparse equations of the bodies (sparse_motion.hpp).
//
// The steps of implicit methods. With y = [q; s], q' = s and M s' + h(q, s) = 0, and with K the derivative of
// M s' + h with q at fixed s', C that with s, the Jacobian J of y' gives (I - gamma J) [dq; ds] = [b_q; b_s]
//   dq - gamma ds = b_q,   ds + gamma M^-1 (K dq + C ds) = b_s,
// so that what is factored has a row for each coordinate, not two:
//   (M + gamma C + gamma^2 K) ds = M b_s - gamma K b_q.
// Steps of q are tangent. Those of a rotation, whose coordinates are a quaternion, are gamma N ds and not
// gamma ds, with a 3 x 3 matrix N that is one but for terms of gamma (newton_matrix.hpp). Then K is K N where
// it acts on ds.
#pragma once

#include "engine/system/motion.hpp"

namespace flyball {

// Where a motion is: configuration and velocity of the released system, with rotation vectors on the side
// where their forces are taken, and the motion of its links.
struct MotionPoint {
  const Parameters& parameters;
  const Eigen::VectorXd &q, &u;
  const Kinematics<double>& kinematics;
  const std::vector<LinkRates>& carried; // see move()
};

class MotionSolver {
 public:
  virtual ~MotionSolver() = default;

  // Takes in M and Phi_q. False where they have no solution.
  virtual bool factor(const MotionPoint& point) = 0;
  // s' of the free coordinates and the multipliers of all rows, with the last factor(); the point's
  // kinematics are without accelerations. False where they are not finite.
  virtual bool accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) = 0;
  // N m or N that the coordinate of System::drives asks for, of the last accelerate().
  virtual double drive_force(int drive) const = 0;
  // Why factor() or accelerate() failed, as a clause.
  virtual std::string unsolved() const = 0;

  // Takes in K and C at a point whose kinematics have the accelerations of the last accelerate(). False where
  // they are not finite.
  virtual bool linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) = 0;
  // Factors M + gamma C + gamma^2 K N with what was taken in last. `turns`: N by spherical link, in the axes
  // of its parent. False where that is singular.
  virtual bool factor_step(double gamma, const std::vector<Mat3>& turns) = 0;
  // ds, in the place of b_s; b_q as a tangent step.
  virtual void solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) = 0;
};

} // namespace flyball
