// The KKT matrix of few coordinates by the null-space method: with N a basis of the null space of J, from its
// QR, the balance is N^T (K + shift W) N. Redundant constraints do no harm, and the definiteness of the
// balance is known whenever it is factored. (Nocedal and Wright, Numerical Optimization, 2006, section 16.2.)
//
// Studies of the matrices themselves find them here.
#pragma once

#include "engine/kkt/constraint_space.hpp"
#include "engine/kkt/kkt_system.hpp"
#include "engine/kkt/reduced_hessian.hpp"
#include "engine/system/linearization.hpp"

#include <optional>

namespace flyball {

class DenseKkt final : public KktSystem {
 public:
  void linearize(const Problem& problem, const Unknowns& z, const Evaluation& evaluation) override;
  void factor(double shift = 0) override;
  bool exact_inertia() const override { return true; }
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  const std::vector<NullDirection>& null_directions() override;
  void direction_of(const NullDirection& direction, Eigen::VectorXd& x) override;

  void factor_constraints(const Problem& problem, const Evaluation& evaluation) override;
  int independent_rows(const Problem&, const Evaluation&) override { return constraints().rank(); }
  void balance(const Eigen::VectorXd& force, Eigen::VectorXd& lambda) override {
    constraints().multipliers(force, lambda);
  }
  void balance_with_least_norm(const Eigen::VectorXd& force, Eigen::VectorXd& lambda) override {
    lambda = constraints().least_norm_multipliers(force);
  }
  void close(const Eigen::VectorXd& closing, Eigen::VectorXd& x) override { constraints().solve(closing, x); }
  void project(const Eigen::VectorXd& force, Eigen::VectorXd& left) override;

  // Of the last linearize(). K, scaled: (nv, nv).
  const Eigen::MatrixXd& stiffness() const { return stiffness_; }
  // J, scaled: (rows, nv), with its range and null space; of this or of factor_constraints(), the later.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  const ConstraintSpace& constraints() const { return alone_is_later_ ? alone_ : space_; }
  // N^T K N, and below what size its diagonal is rounding.
  const Eigen::MatrixXd& reduced() const { return space_.rank() == 0 ? stiffness_ : reduced_; }
  const Eigen::VectorXd& noise() const { return noise_; }
  // N^T (K + shift W) N, factored.
  const ReducedHessian& hessian() const { return hessian_; }
  ReducedHessian& hessian() { return hessian_; }

  Linearization linearization; // as it came, and what studies of the motion add to it

 private:
  void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                Eigen::VectorXd& lambda) override;
  void scale_constraints(const Problem& problem, const Evaluation& evaluation, ConstraintSpace& space);
  void clear_rounding(const Problem& problem, const Magnitudes& magnitudes);
  void need_metric();
  const Eigen::MatrixXd& matrix() const { return shift_ == 0 ? stiffness_ : shifted_; }

  bool symmetric_ = true;
  std::optional<Problem> problem_; // for the metric; see linearize()
  const Kinematics<double>* kinematics_ = nullptr;
  bool has_metric_ = false, has_directions_ = false;
  ConstraintSpace space_, alone_; // of linearize() and of factor_constraints(), which may be at another state
  bool alone_is_later_ = false;
  ReducedHessian hessian_;
  Eigen::MatrixXd jacobian_, stiffness_, product_, reduced_, metric_, shifted_, shifted_reduced_;
  Eigen::VectorXd noise_, range_step_, target_, reduced_rhs_, reduced_step_;
  std::vector<NullDirection> directions_;
};

} // namespace flyball
