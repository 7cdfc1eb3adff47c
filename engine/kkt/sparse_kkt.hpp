// The KKT matrix of any mechanism as the sparse equations of its bodies (body_equations.hpp).
//
// Factored as L D L^T with pivoting; in a plane net of n bodies that takes about n log n of storage and n^1.5
// of work (George, Nested dissection of a regular finite element mesh, 1973). The signs of its eigenvalues
// less those of the multipliers are those of the Hessian that the constraints leave (Nocedal and Wright,
// Numerical Optimization, 2006, theorem 16.3).
#pragma once

#include "engine/kkt/body_equations.hpp"
#include "engine/kkt/kkt_system.hpp"
#include "engine/kkt/sparse_constraints.hpp"
#include "engine/linear/sparse_factorization.hpp"

namespace flyball {

class SparseKkt final : public KktSystem {
 public:
  // Of a system with no_drive_rides().
  void linearize(const Problem& problem, const Unknowns& z, const Evaluation& evaluation) override;
  bool linearize_convex(const Problem& problem, const Unknowns& z, const Evaluation& evaluation) override;
  void factor(double shift = 0) override;
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  const std::vector<NullDirection>& null_directions() override { return directions_; }
  void direction_of(const NullDirection& direction, Eigen::VectorXd& x) override;
  bool inertia_is_certain(const Problem& problem, const Evaluation& evaluation) override;
  bool factors_cost_more() const override { return true; }

  void factor_constraints(const Problem& problem, const Evaluation& evaluation) override;
  void complete_constraints(const Problem& problem, const Evaluation& evaluation) override {
    factor_constraints(problem, evaluation);
  }
  int independent_rows(const Problem& problem, const Evaluation& evaluation) override;
  void balance(const Eigen::VectorXd& force, Eigen::VectorXd& lambda) override;
  void close(const Eigen::VectorXd& closing, Eigen::VectorXd& x) override;
  void project(const Eigen::VectorXd& force, Eigen::VectorXd& left) override;

  // Constraint rows that others imply, of the last factor().
  int redundant() const { return redundant_; }

 private:
  void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                Eigen::VectorXd& lambda) override;
  void take_in(const Problem& problem, const Unknowns& z, const Evaluation& evaluation, Lines lines);
  void set_force_free_directions();
  void add_null_directions();

  BodyEquations equations_;
  SparseFactorization factors_, counted_; // the latter only where rows may be redundant, to count these
  SparseConstraints constraints_;
  std::vector<NullDirection> directions_;
  double length_ = 0; // m, the mechanism's reach
  int redundant_ = 0;
  Eigen::VectorXd reduced_, none_, unused_;
  std::vector<Vec6> motion_, wrench_; // by node
};

} // namespace flyball
