// The matrix of implicit steps, I - gamma J, J the derivative of a motion's rates with y = [q; s; energies].
//
// Where all bodies have mass J is put together from the derivatives of the acceleration, and since q' = s but
// for quaternions, q is eliminated: what is factored has as many rows as the motion has coordinates. With
// massless bodies J comes from difference quotients and all of it is factored. The energies, which nothing
// depends on, have no columns; in the first form no rows either: Newton's iteration corrects them a round
// later.
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
  void solve(double* b) const;

 private:
  // A spherical link: its quaternion D' = w D / 2, and the matrices of its part of J and of the tangent step
  // that a change of D makes.
  struct Rotation {
    int q = 0, v = 0;
    Eigen::Matrix4d by_position;                           // of D' with D
    Eigen::Matrix<double, 4, 3> by_velocity;               // of D' with w
    Eigen::Matrix<double, 3, 4> tangent;                   // rad
    Eigen::Matrix4d inverse = Eigen::Matrix4d::Identity(); // (I - gamma by_position)^-1
  };
  struct Scalar {
    int q = 0, v = 0;
  };

  bool whole_ = false; // by difference quotients
  int nq_ = 0, nv_ = 0;
  double gamma_ = 0;
  Eigen::MatrixXd jacobian_, with_q_, with_s_;
  std::vector<Rotation> rotations_;
  std::vector<Scalar> scalars_;
  Lu factors_;
  Eigen::VectorXd perturbed_, rates_;
};

} // namespace flyball
