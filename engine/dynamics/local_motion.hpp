// The motion about a steady state as x' = F(x), in as few numbers as it has: x = [y; v], y the coordinates on
// the null space N of the constraints at the steady state, v their rates,
//
//     theta = N y + closing,   u = u_0 + r N v + closing        closing: in the range of Phi_q^T at the state
//
// theta a step of q from the steady state (retract), u the velocity, r a rate that makes v as large as y
// where something swings at r. Both are closed down to rounding, so that the constraints' curvature is in F.
// What turns at a speed that is found has its rate among v and no y, for nothing depends on its phase; or,
// where angles between such parts matter, a y across the way along which all of them turn, whose phase alone
// is then free. Of what keeps its momentum the rate follows from that. Lengths are in parts of the
// mechanism's reach.
#pragma once

#include "engine/dynamics/equations.hpp"
#include "engine/kkt/workspace.hpp"

namespace flyball {

class LocalMotion {
 public:
  // At q, u: a steady state of the model's free coordinates at the drawn phase. `rate` in rad/s.
  // `with_angles`: those between parts that turn at found speeds are among y. Throws SceneError where there
  // is no such F: parts move without mass.
  LocalMotion(const MotionModel& model, const Eigen::VectorXd& q, const Eigen::VectorXd& u, double rate,
              bool with_angles);

  Eigen::Index size() const { return positions_.cols() + rates_.cols(); }

  // F (1/s) at x. False where the loops cannot be closed there or nothing can be solved.
  bool evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& out) { return evaluate(x, 0, 0, out); }
  // The same where the drives are `t` seconds on, and what turns at found speeds `turn` rad or reaches: each,
  // or with angles between them all along their way.
  bool evaluate(const Eigen::VectorXd& x, double t, double turn, Eigen::VectorXd& out);

  // Of the last evaluation, free coordinates.
  const Eigen::VectorXd& configuration() const { return q_; }
  const Eigen::VectorXd& velocity() const { return u_; }

  // Of a motion Re(x e^(i r t)), `rate` r: complex amplitudes of all free coordinates as tangent vectors
  // (rad, m), those that turn at found speeds included.
  Eigen::VectorXcd amplitudes(const Eigen::VectorXcd& x) const;
  // Those of coordinates that stand still in the steady state.
  bool stands(int v) const { return standing_ > 0 && positions_.leftCols(standing_).row(v).norm() > 1e-9; }

  // Where in x the angles between what turns at found speeds are, and how many.
  Eigen::Index first_angle() const { return standing_; }
  Eigen::Index angles() const { return positions_.cols() - standing_; }

 private:
  bool close_position(const Eigen::VectorXd& y, double t, double turn);
  bool close_velocity(const Eigen::VectorXd& v, double t);
  void place(double t);

  const MotionModel& model_;
  const Watch watch_;
  Equations equations_;
  Workspace w_;
  Eigen::VectorXd origin_, speed_; // the steady state
  double rate_;
  Eigen::MatrixXd turning_, kept_;    // scaled directions: of found speeds, of kept momenta
  Eigen::Index standing_ = 0;         // of y, before the angles
  Eigen::MatrixXd positions_, rates_; // those of y and v
  Eigen::VectorXd way_;               // scaled: along which a phase turns
  Eigen::MatrixXd kept_mass_;
  Eigen::VectorXd kept_momentum_;

  Eigen::VectorXd theta_, q_, u_, all_q_, all_u_, open_, step_, turned_;
  Kinematics<double> kinematics_;
  std::vector<LinkRates> carried_;
  MassMatrix mass_;
};

} // namespace flyball
