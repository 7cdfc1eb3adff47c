// The balance with numbers of the mechanism among the unknowns, and as many conditions beside it: "this
// coordinate has that value", "the balance is singular". Newton-Raphson on all of it together, on the null
// space of the constraints, so that redundant loops do no harm.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/newton.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flyball {

struct ExtendedState {
  Unknowns z;
  Eigen::VectorXd parameters; // in their units
  double unfolding = 0;       // see ExtendedBalance; zero in an equilibrium
};

class ExtendedBalance;

// What has to vanish, at a state whose parameters are set and which is factored with its best multipliers in
// the workspace.
using Condition = std::function<double(const ExtendedBalance&, const ExtendedState&, Workspace&)>;

// A coordinate has a value (rad or m).
Condition coordinate_is(const CoordinateInfo& coordinate, double value);
// The balance is singular: ExtendedBalance::singularity.
Condition balance_is_singular();
// The balance does not leave its range as a parameter moves: ExtendedBalance::transversality.
Condition branches_cross(std::size_t parameter);

struct ExtendedOutcome {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  // scaled, of balance, loops and conditions; forces in extended precision
  Eigen::VectorXd step; // the last correction: scaled coordinates, then parameters over their scales
};

class ExtendedBalance {
 public:
  // `scales` are the parameters' ranges of interest. `unfolded` adds an unknown force along the left border:
  // at a branch point the equations are regular only with it.
  ExtendedBalance(const System& system, const Mechanism& mechanism, std::vector<std::string> addresses,
                  Eigen::VectorXd scales, std::vector<Condition> conditions, bool unfolded = false);

  void set(const Eigen::VectorXd& parameters);
  Problem problem() const { return {system_, parameters_, scaling_}; }
  const Mechanism& mechanism() const { return mechanism_; }
  const Eigen::VectorXd& scales() const { return scales_; }
  int unknowns() const { return system_.nv + static_cast<int>(scales_.size()); }
  Workspace& workspace() { return w_; }

  // From `state`, in place. `row` (by scaled coordinates, then scaled parameters) closes the equations where
  // there is one unknown more than conditions: the solution is in the plane through the start across it.
  // Empty where there is none. False where Newton-Raphson fails.
  ExtendedOutcome correct(ExtendedState& state, const Eigen::VectorXd& row);

  // Unit tangent of the solutions' curve at a solution, turned as `previous`; empty at a singular state.
  Eigen::VectorXd tangent(const ExtendedState& state, const Eigen::VectorXd& previous);

  // Moves a state by a scaled step as `correct` makes them.
  void move(ExtendedState& state, const Eigen::VectorXd& step) const;

  // Borders that make the balance regular where it is singular: its left and right singular vectors of least
  // singular value at this state. To be set before the conditions below are used, and kept during `correct`.
  void set_borders(const ExtendedState& state);

  // Vanishes where the balance is singular: the last unknown of the balance bordered (Govaerts 2000, 4.2).
  double singularity(Workspace& w) const;
  // At a singular state: by how much the balance leaves its range as parameter `index` moves; vanishes at a
  // branch point.
  double transversality(const ExtendedState& state, std::size_t index, Workspace& w) const;

 private:
  struct Assembled;
  void assemble(const ExtendedState& state, Assembled& out);
  void rates(const ExtendedState& state, std::size_t index, Eigen::VectorXd& force,
             Eigen::VectorXd& phi) const;
  double force_size(const Workspace& w) const;
  Eigen::MatrixXd bordered(const Workspace& w) const;

  const System& system_;
  Mechanism mechanism_;
  std::vector<std::string> addresses_;
  Eigen::VectorXd scales_;
  std::vector<Condition> conditions_;
  bool unfolded_;
  Parameters parameters_;
  Scaling scaling_;
  Eigen::VectorXd left_, right_; // borders, scaled, in all coordinates
  double size_ = 1;              // of the forces, when the borders were set
  Workspace w_, probe_;
};

} // namespace flyball
