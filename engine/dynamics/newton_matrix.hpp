// The matrix of implicit steps, I - gamma J, J the derivative of a motion's rates with y = [q; s; energies].
//
// Where all bodies have mass q is eliminated, since q' = s but for quaternions, and what is left is for the
// solver of the equations of motion (motion_solver.hpp). With massless bodies J comes from difference
// quotients and all of it is factored. The energies, which nothing depends on, have no columns; in the first
// form no rows either: Newton's iteration corrects them a round later.
//
// A rotation. Its quaternion D' = w D / 2 has the derivatives P with D and V with w, and a change dD makes
// the tangent step T dD. So dD = (I - gamma P)^-1 (b_D + gamma V dw), and its step is that of b_D and gamma N
// dw with N = T (I - gamma P)^-1 V.
#pragma once

#include "engine/dynamics/equations.hpp"
#include "engine/linear/spectral.hpp"

#include <functional>

namespace flyball {

class NewtonMatrix {
 public:
  // f(y, y'): false where it cannot be evaluated.
  using Rate = std::function<bool(const double* y, double* out)>;

  // J at an evaluated state of equations without massless bodies; y as packed by MotionOde.
  bool take_derivatives(Equations& equations, const double* y);
  // J by difference quotients: `rate_at_y` is f(y), `scale` what counts as one of each entry but the
  // energies.
  bool take_quotients(const Rate& rate, const double* y, const double* rate_at_y,
                      const Eigen::VectorXd& scale, int size);

  // False where the matrix is singular.
  bool factor(double gamma);
  // b := (I - gamma J)^-1 b.
  void solve(double* b);

 private:
  struct Rotation {
    int q = 0, v = 0;
    Eigen::Matrix4d by_position;                           // P
    Eigen::Matrix<double, 4, 3> by_velocity;               // V
    Eigen::Matrix<double, 3, 4> tangent;                   // T, rad
    Eigen::Matrix4d inverse = Eigen::Matrix4d::Identity(); // (I - gamma P)^-1
  };
  struct Scalar {
    int q = 0, v = 0;
  };

  MotionSolver* solver_ = nullptr; // null: by difference quotients
  int nq_ = 0, nv_ = 0;
  double gamma_ = 0;
  std::vector<Rotation> rotations_;
  std::vector<Scalar> scalars_;
  std::vector<Mat3> turns_; // N, by rotation
  Eigen::VectorXd step_, s_;
  Eigen::MatrixXd jacobian_;
  Lu factors_;
  Eigen::VectorXd perturbed_, rates_;
};

} // namespace flyball
