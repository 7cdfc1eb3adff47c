// How fast the balance changes with numbers of the mechanism while coordinates and multipliers stand, by
// forward-mode differentiation of all that lies between: frames, drawn lengths, inertia, the balance itself.
// With it the implicit function theorem gives the rates of a steady state, f_z dz/dp = -df/dp.
#pragma once

#include "engine/system/residual.hpp"

namespace flyball {

class BalanceRate {
 public:
  // `t` s after phase zero of the drives, which stand where they are while their speeds change. `parameters`:
  // those of the mechanism, whose numbers have these rates. `starts`: how fast what turns at speeds that are
  // found is displaced beside that, by link (rad or m; empty: not at all).
  void evaluate(const System& system, const Mechanism& mechanism, const NumberRates& rates,
                const Parameters& parameters, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda,
                double t = 0, const Eigen::VectorXd& starts = {});

  // Of forces by coordinate of q_R (N m or N) and of loops by row (m or 1; gears rad or m), per unit.
  const Eigen::VectorXd& force() const { return force_; }
  const Eigen::VectorXd& phi() const { return phi_; }
  // The mechanism's, with their rates.
  const BasicParameters<Dual>& parameters() const { return parameters_; }

 private:
  BasicParameters<Dual> parameters_;
  Configuration<Dual> q_, lambda_;
  Kinematics<Dual> kinematics_;
  Residual<Dual> residual_;
  Eigen::VectorXd force_, phi_;
};

} // namespace flyball
