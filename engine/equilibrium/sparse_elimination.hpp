// The linearised balance as a sparse matrix of coordinates, for nets and meshes of springs: bodies side by
// side that feel their neighbours alone. Factored as L D L^T with an ordering of approximate minimum degree
// where there is a potential, else as L U. In a plane net of n bodies that takes about n log n of storage and
// n^1.5 of work (George, Nested dissection of a regular finite element mesh, 1973).
#pragma once

#include "engine/equilibrium/eliminator.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

namespace flyball {

class SparseElimination final : public Eliminator {
 public:
  void linearize(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& kinematics,
                 const Residual<double>& residual, const Magnitudes& magnitudes) override;
  void factor(double shift = 0) override;
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) override;
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  void direction_of(const Flat& flat, Eigen::VectorXd& x) override;

 private:
  using Sparse = Eigen::SparseMatrix<double>;

  void take_pattern(const System& system);
  void leave_out_what_is_loose();
  void sum_up(double shift);
  bool decompose();

  bool symmetric_ = true, analysed_ = false, solved_ = false;
  std::size_t pattern_ = 0; // hash of what the pattern was made for
  Sparse stiffness_, metric_, sum_;
  Linearization work_;
  Eigen::VectorXd noise_, gathered_;
  std::vector<int> place_; // of each coordinate in what is solved; -1: nothing holds it
  int held_ = 0;
  Eigen::SimplicialLDLT<Sparse> ldlt_;
  Eigen::SparseLU<Sparse> lu_;
};

} // namespace flyball
