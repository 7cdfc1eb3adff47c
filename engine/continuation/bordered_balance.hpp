// The balance with one number of the mechanism among its unknowns, linearised at a state and bordered by a
// row that picks one of its solutions (Keller, Numerical solution of bifurcation and nonlinear eigenvalue
// problems, 1977; Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria, 2000, chapter 3):
//
//       [ K     J^T  f_p   ] [ x      ]      K, J: the KKT matrix of the balance, (n, n) and (rows, n)
//   B = [ J     0    phi_p ] [ lambda ]      f_p, phi_p: rates of forces and loops in the parameter
//       [ t_x^T 0    t_p   ] [ m      ]      t = [t_x; t_p]: the border, as a rule about the curve's
//       direction
//
// It is regular at a fold, where the KKT matrix is singular, and singular where branches cross. All is scaled
// (Scaling; the parameter by Family::scale()); a step or direction is [x; m], of n + 1 entries, and with the
// angles of what turns between these where it stands turned (turned_borders.hpp).
#pragma once

#include "engine/continuation/family.hpp"
#include "engine/kkt/workspace.hpp"
#include "engine/system/balance_rate.hpp"

#include <memory>
#include <optional>

namespace flyball {

class BorderedBalance {
 public:
  // By dense matrices on the null space of the constraints, or by elimination, as the family's problem says;
  // with angles among the unknowns where it ties some.
  // Both arguments must outlive it.
  static std::unique_ptr<BorderedBalance> make(Family& family, Workspace& w);
  virtual ~BorderedBalance() = default;

  // At a state and a value of the parameter, to which the family is set. Returns the scaled residual there.
  virtual double linearize(const Unknowns& z, double parameter) = 0;

  // Of a family of states, which nothing resists moving along: from here on, and until it is linearised
  // again, steps and directions are orthogonal to `directions` (n, d; scaled, orthonormal columns V), which
  // are such at a state nearby, and the determinant is that across the family: of K + V V^T (Wielandt's
  // deflation; the balance is orthogonal to the left null vectors of K along all of the family, so that V^T x
  // = 0 follows).
  virtual void keep_still(const Eigen::MatrixXd& directions);

  // These directions at the state that is linearised, kept still from here on. Fewer, where something resists
  // there.
  virtual Eigen::MatrixXd keep_still_there();

  // All such directions there that are orthogonal to `along`: the null space of K beside a crossing,
  // where only what is a symmetry's stays singular. Kept still from here on.
  virtual Eigen::MatrixXd keep_null_space_still(const Eigen::VectorXd& along);

  // Whether of what was asked last something resists a direction by little more than rounding.
  virtual bool hardly_resists() const { return false; }

  // The step that balances the forces and closes the loops to first order and has the product `along` with
  // the border, and the multipliers (N, N m) after it. False where B is singular.
  virtual bool step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
                    Eigen::VectorXd& lambda) = 0;

  // The direction of product 1 with the border along which the balance holds. False where B is singular.
  virtual bool direction(const Eigen::VectorXd& border, Eigen::VectorXd& out) = 0;

  // The sign of B's determinant with a size that can be followed to zero. Nothing where it is not found.
  virtual std::optional<double> determinant(const Eigen::VectorXd& border) = 0;

  // How many eigenvalues of K on the null space of the loops have a negative real part, directions kept still
  // left out. 0 where they are not counted.
  virtual int falling() { return 0; }

  // Where B is singular: of the directions along which the balance holds the one that is orthogonal to the
  // unit vector `tangent`, of length 1. False where there is none.
  virtual bool second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) = 0;

 protected:
  BorderedBalance(Family& family, Workspace& w) : family_(family), w_(w) {}

  // Of the null space of a singular B (its two columns, orthonormal, spanned by the tangent and one direction
  // more) that direction. False where there is none.
  static bool off_tangent(const Eigen::MatrixXd& null_space, const Eigen::VectorXd& tangent,
                          Eigen::VectorXd& out);

  // f_p and phi_p, scaled; leaves the family at the parameter and the balance evaluated at z.
  void find_rates(const Unknowns& z, double parameter);

  Family& family_;
  Workspace& w_;
  Eigen::VectorXd force_rate_, loop_rate_;

 private:
  BalanceRate rate_;
};

} // namespace flyball
