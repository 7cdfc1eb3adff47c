// [M C^T; C 0] [a; l] = [f; g], eq. 19, by the null-space method: M need only be positive definite where C
// vanishes, so bodies without mass in loops do no harm.
#pragma once

#include "engine/linear/spectral.hpp"

namespace flyball {

class SaddlePoint {
 public:
  // C: (rows, n) with independent rows. False where they are not.
  bool factor_constraints(const Eigen::MatrixXd& c);
  // M: (n, n), symmetric; after the constraints. False where it is not positive definite on their null space.
  bool factor_mass(const Eigen::MatrixXd& m);

  void solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& a, Eigen::VectorXd& l);
  // For g = 0 the accelerations in place of the forces, by columns.
  void respond(Eigen::MatrixXd& forces) const;
  // The shortest a with C a = g; needs the constraints alone.
  void shortest(const Eigen::VectorXd& g, Eigen::VectorXd& a);

  // The smallest pivot of C over its largest: 1 without rows.
  double independence() const { return independence_; }

 private:
  Eigen::Index n_ = 0, rows_ = 0;
  double independence_ = 1;
  Eigen::MatrixXd transposed_, turned_, free_;
  HouseholderQr qr_;
  Cholesky cholesky_;
  Eigen::VectorXd work_, first_, force_;
};

} // namespace flyball
