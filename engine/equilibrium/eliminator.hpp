// Solves the linearised balance of a system without loops by elimination, at a cost that grows with its
// bodies and not with their square: along the tree or as a sparse matrix. All in scaled units.
//
// A multiple of a metric can be added to the stiffness: the bodies' inertias in the main, so that a step's
// length is that of the motion it makes and not of the angles it takes.
#pragma once

#include "engine/equilibrium/problem.hpp"

namespace flyball {

class Eliminator {
 public:
  // A pivot that is zero but for rounding: `way` within the columns of one link.
  struct Flat {
    int v = 0, columns = 1;
    Vec3 way = Vec3::UnitX();
  };

  virtual ~Eliminator() = default;

  // Takes in a state. Kinematics, residual and magnitudes must be at q.
  virtual void linearize(const Problem& problem, const Eigen::VectorXd& q,
                         const Kinematics<double>& kinematics, const Residual<double>& residual,
                         const Magnitudes& magnitudes) = 0;

  // Eliminates K + shift W (shift in 1/s^2).
  virtual void factor(double shift = 0) = 0;

  // Solves (K + shift W) x = rhs. Directions without stiffness get no component.
  virtual void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) = 0;

  // W x, and x^T W x.
  virtual double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) = 0;

  // The direction of a zero pivot: its own way, and what follows of what is eliminated before it.
  virtual void direction_of(const Flat& flat, Eigen::VectorXd& x) = 0;

  // Of the last factor(), where there is a potential: negative eigenvalues of K + shift W (Sylvester).
  int negative_count() const { return negative_; }
  const std::vector<Flat>& flat() const { return flat_; }
  bool positive_definite() const { return negative_ == 0 && flat_.empty(); }
  double mass() const { return mass_; } // kg, of what moves

 protected:
  static constexpr double zero = 1e-11;     // of the stiffness that a coordinate carries
  static constexpr double rounding = 1e-15; // of the forces behind it
  static constexpr double own_share = 1e-6; // of the metric: what coordinates have beside the bodies

  std::vector<Flat> flat_;
  int negative_ = 0;
  double mass_ = 0;
};

} // namespace flyball
