// A large symmetric matrix factored in two halves at once, and what these leave of the unknowns between them
// (the Schur complement) after that. For regular matrices only: where anything comes near to a pivot of zero
// it says no, and the whole has to be looked at.
#pragma once

#include "engine/equilibrium/halves.hpp"
#include "engine/equilibrium/mumps.hpp"

#include <array>
#include <vector>

namespace flyball {

class DividedFactors {
 public:
  // Small matrices, and those that do not fall in halves, it leaves alone.
  void begin(const SparsePattern& pattern);
  bool is_open() const { return open_; } // it has one to factor

  // Of an equilibrated matrix that was not left alone. False where it is not clearly regular, or memory runs
  // out. Pivots below `zero` times what its norm may be count as none.
  bool factor(const std::vector<double>& values, double zero);

  void solve(Eigen::VectorXd& x); // in place

  int negative() const; // pivots

 private:
  struct Half {
    explicit Half(int copy) : mumps(copy) {}
    Mumps mumps;
    SparsePattern pattern;
    std::vector<std::size_t> entries; // of the whole, that it takes
    std::vector<int> unknowns;        // of the whole, that are its own; those between come after them
    std::vector<int> order, last;
    std::vector<double> values, left; // left: of those between, the lower triangle by rows
    Eigen::VectorXd x, reduced;
  };
  // An entry of the whole that belongs to the root, and where.
  struct OfRoot {
    std::size_t entry, place;
  };

  bool analyse();
  void close();
  void distribute(const SparsePattern& pattern, const std::vector<Side>& side);
  bool add_up(const std::vector<double>& values, double zero);
  std::size_t place(std::size_t i, std::size_t j) const; // of the root's entries; i >= j

  std::array<Half, 2> halves_{Half(0), Half(1)};
  Mumps root_;
  SparsePattern root_pattern_;
  std::vector<int> between_; // unknowns of the whole
  std::vector<double> root_values_;
  std::vector<OfRoot> of_root_;
  std::vector<int> root_order_; // any
  Eigen::VectorXd root_x_;
  double norm_ = 1; // at most: entries of a row, which are not above one
  bool open_ = false;
};

} // namespace flyball
