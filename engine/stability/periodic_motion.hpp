// A linearised motion whose matrices have a period, as Fourier series, and the system of first order that it
// makes.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

class PeriodicMotion {
 public:
  // Samples linear_motion() over `period` (s), in which the fastest drive makes `turns` turns, until the
  // series gives the matrices between the samples, too. The coordinates are those of an orthonormal null
  // space basis N(t) of the constraints: with delta = N p the motion has N^T [M N p'' + (2 M N' + D N) p' +
  // (M N'' + D N' + K N) p] = 0. N is carried from phase to phase by parallel transport, and what it has
  // turned by at the end of the period is taken back evenly over it, so that it has that period, too (twice
  // as long a one where it returns as its mirror image). Nothing where the series does not end or the number
  // of free directions changes.
  static std::optional<PeriodicMotion> sample(const Problem& problem, const Eigen::VectorXd& q, double period,
                                              int turns, Workspace& w);

  double period() const { return period_; }
  Eigen::Index harmonics() const { return series_.cols() / 2; } // of the matrices
  // Whether some direction has neither mass nor damping nor stiffness at all phases.
  bool singular() const { return singular_; }
  // Of the state x = (p of what has mass, its rate in units of rate(), p of what is damped only). What has
  // neither mass nor damping is condensed statically.
  Eigen::Index size() const { return 2 * massive_.cols() + damped_.cols(); }
  // A(t) of x' = A x, (size, size), 1/s. False where a matrix that must be inverted is singular at t.
  [[nodiscard]] bool state_matrix(double t, Eigen::MatrixXd& a) const;

 private:
  struct Matrices {
    Eigen::MatrixXd mass, velocity, stiffness; // (k, k)
  };
  Matrices at(double t) const;
  bool sort_directions(const std::vector<Matrices>& samples);
  std::optional<Eigen::MatrixXd> invert(double t) const; // A(t) from the matrices there
  void expand_state_matrix();

  double period_ = 0, rate_ = 1; // s; 1/s
  Eigen::Index k_ = 0;
  bool singular_ = false;
  Eigen::MatrixXd series_;                      // (3 k^2, harmonics): mean, then cosine and sine of each
  Eigen::MatrixXd massive_, damped_, standing_; // directions of p, columns
  Eigen::MatrixXd state_series_;                // (size^2, harmonics) of A, where it ends soon; else empty
};

} // namespace flyball
