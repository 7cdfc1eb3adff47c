// The equations of motion, eq. 19: [M Phi_q^T; Phi_q 0] [q_R''; lambda] = [Q*; gamma].
//
// Where M has null directions on the constraints, bodies move without momentum. Their velocity follows from
// the balance of forces: where dampers act it is solved for (motion of first order), where only springs do
// the position is (a balance at every moment), and where nothing acts at all they stand still against their
// parents. No mass is invented. So the velocity that is integrated, s, need only carry the momentum: it moves
// everything that has mass as the true velocity u does, with zeros in as many coordinates as there are null
// directions ("idle" ones). s = u where every direction has mass.
#pragma once

#include "engine/dynamics/dense_motion.hpp"
#include "engine/dynamics/event_elements.hpp"
#include "engine/dynamics/sparse_motion.hpp"
#include "engine/dynamics/tree_motion.hpp"
#include "engine/dynamics/watch.hpp"
#include "engine/system/reactions.hpp"

namespace flyball {

class Equations {
 public:
  // Where `watch` is over, what evaluates fails.
  explicit Equations(const MotionModel& model, const Watch& watch);
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;

  // Finds independent constraints and null directions at a state whose loops are closed; `u` is a velocity
  // that keeps them closed. Moves what stands in balance into it, in q. Throws SceneError, naming joints,
  // for what has no equations of motion. To be called again where structure_changed() says so; true where the
  // choice, and so the meaning of s, is another than before.
  bool analyse(double t, Eigen::VectorXd& q, const Eigen::VectorXd& u);

  // Stops as springs that are there or not, and rotation vectors on one side, so that the equations are
  // smooth between events; without, a stop acts as soon as it is reached.
  void latch(const std::vector<StopElement>& stops, const std::vector<bool>& touching,
             std::vector<FlipElement> flips);

  // s of a velocity u, and both evaluated: false where the equations cannot be solved. Then s is u, and what
  // is reported of the last evaluation means nothing until the next that succeeds.
  [[nodiscard]] bool reduce(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u, Eigen::VectorXd& s);
  [[nodiscard]] bool evaluate(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s);
  // Why they cannot, as a clause: which numbers are too far apart.
  std::string unsolved() const { return solver_->unsolved(); }

  // Of the last evaluation. Configuration and velocity of the released system, drives last.
  const Eigen::VectorXd& configuration() const { return q_; }
  const Eigen::VectorXd& velocity() const { return u_; }
  const Eigen::VectorXd& acceleration() const { return a_; } // s' of the free coordinates, q_R'' where s = u
  const Eigen::VectorXd& multipliers() const { return lambda_; } // all rows; zero on dependent ones
  const Kinematics<double>& kinematics() const { return kinematics_; }
  // N m or N: what the coordinate of System::drives asks for.
  double drive_force(int drive) const { return solver_->drive_force(drive); }
  double drive_power() const; // W, of all drives
  ForcePowers powers();
  double stored_energy() const; // J
  double energy_scale();        // J, of the motion and of what the forces do over a radian or the reach

  // Puts q on the constraints and in balance, and s on the constraints' rates, by shortest steps, down to
  // rounding. False where that fails. `shift` gets the size of the correction of q, scaled.
  bool project(double t, Eigen::VectorXd& q, Eigen::VectorXd& s, double* shift = nullptr);
  // The same with the velocity changed by an impulse of the constraints, so that momentum is kept.
  bool catch_up(double t, Eigen::VectorXd& q, Eigen::VectorXd& s);
  // The smallest pivot of the independent constraint rows over the largest, of the last evaluation.
  // Not known, and so 1, where the equations are sparse or go along a tree.
  double independence() const { return solver_ == &dense_ ? dense_.saddle().independence() : 1; }
  bool needs_projection() const { return !rows_.empty() || standing_ > 0; }

  // How far the loops are open, and how fast they open: the largest row (m, rad or 1), at an evaluated state.
  double position_drift() const;
  double velocity_drift();

  // Whether another choice of independent rows or idle coordinates is due, from an evaluated state.
  bool structure_changed() const;
  // What no motion can follow any more, as a clause; empty as a rule.
  std::string trouble() const;

  // The forces that joints transmit at the evaluated state, with least-norm multipliers.
  TransmittedForces reactions();
  // With the accelerations of the evaluated state, those of what has mass (see CoordinateMotion).
  const Kinematics<double>& accelerated_kinematics();

  bool has_massless() const { return !idle_.empty(); }
  // Linearised motion about the evaluated state on the tangent space: M, C, K. For choosing a method.
  struct Pencil {
    Eigen::MatrixXd mass, velocity, stiffness;
  };
  Pencil pencil();
  // Takes in the derivatives of the acceleration at the evaluated state, for the iterations of implicit
  // steps. Not for what has massless bodies. False where they are not finite.
  bool linearise();
  // What solves the equations, and those steps.
  MotionSolver& solver() { return *solver_; }

  const MotionModel& model() const { return model_; }

 private:
  bool evaluate_uncaught(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s);
  void load(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  void place(const Eigen::VectorXd* s = nullptr, const Eigen::VectorXd* a = nullptr);
  MotionPoint point();
  const Eigen::VectorXd& sided_configuration();
  bool choose_tree(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  bool choose_sparse(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  void take_all();
  bool is_sparse() const { return sparse_ && solver_ == &*sparse_; }
  const Eigen::VectorXd& phi() const { return is_sparse() ? sparse_->phi() : dense_.phi(); }
  bool factor_constraints();
  void shortest(const Eigen::VectorXd& closing, Eigen::VectorXd& step);
  void choose_structure(double t, Eigen::VectorXd& q, const Eigen::VectorXd& u);
  void choose_rows();
  void choose_idle();
  void choose_kinds();
  bool find_null_directions();
  void evaluate_damping(Eigen::MatrixXd& out) const;
  bool find_damped_velocity();
  bool find_standing_stiffness();
  bool find_standing_velocity();
  bool balanced_to_rounding();
  bool set_velocity();
  [[nodiscard]] bool sort_kinds(const Eigen::MatrixXd& damping);
  Eigen::VectorXd null_force() const;
  Eigen::VectorXd null_motion(const Eigen::VectorXd& idle) const;
  [[nodiscard]] bool find_standing_balance(double t, Eigen::VectorXd& q, const Eigen::VectorXd& s, int limit);
  double open_rows();
  bool close_loops(double t, Eigen::VectorXd& q, const Eigen::VectorXd& s, double& shift);
  std::string motion_of(const Eigen::MatrixXd& kinds) const;
  [[noreturn]] void refuse(const std::string& what) const;
  [[noreturn]] void refuse_numbers() const;
  std::optional<Eigen::VectorXd> balancing_step() const;

  const MotionModel& model_;
  const Watch& watch_;
  const System& system_; // released
  Parameters parameters_;
  int n_ = 0, drives_ = 0;
  std::vector<int> rows_;           // independent rows of Phi
  std::vector<int> regular_, idle_; // free coordinates
  int damped_ = 0, standing_ = 0;   // of the null directions; the rest feel nothing

  std::vector<FlipElement> flips_;
  Eigen::VectorXd q_, sided_q_, u_, s_, a_, lambda_;
  Kinematics<double> kinematics_;
  std::vector<LinkRates> carried_;
  DenseMotion dense_;
  std::optional<TreeMotion> tree_;     // of a model that goes along it
  std::optional<SparseMotion> sparse_; // of a model whose equations may be sparse
  MotionSolver* solver_ = &dense_;     // one of these
  Eigen::VectorXd row_values_, bias_, target_force_, target_rows_, scaled_a_, scaled_lambda_, full_a_, step_;

  // Null directions Y of M and Phi_q in scaled coordinates, the identity on the idle ones: (n, idle).
  Eigen::MatrixXd null_, damping_, null_damping_, kinds_, standing_stiffness_;
  Eigen::VectorXd idle_velocity_, standing_force_, standing_rate_, kind_sizes_;
  double chosen_independence_ = 1;
  double least_damping_ = 0;
  double null_mass_ = 0; // what mass is left on them, relative
  Eigen::VectorXd zero_lambda_;
  Linearization linearization_;
  Residual<double> moving_residual_;
  Magnitudes magnitudes_;
};

} // namespace flyball
