// The balance with numbers of the mechanism among the unknowns, and as many conditions beside it: "this
// coordinate has that value", "the balance is singular". Newton-Raphson on all of it together: with the
// system's own form of the KKT matrix and block elimination (bordered_kkt.hpp) where there is a potential and
// every condition has a gradient; else by matrices on the null space of the constraints, so that redundant
// loops do no harm; and of states that stand turned with the angles of what turns among the unknowns
// (search/turned_balance.hpp).
#pragma once

#include "engine/continuation/bordered_kkt.hpp"
#include "engine/continuation/singularity.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/search/phase_search.hpp"
#include "engine/solve/newton.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct ExtendedState {
  Unknowns z;
  Eigen::VectorXd parameters; // in their units
  double unfolding = 0;       // see ExtendedBalance; zero in an equilibrium
  double pair = 0;            // 1/s^2: see crossing_pair.hpp
  Eigen::VectorXd starts{};   // by link, of one that stands turned (TurnedState)
};

class ExtendedBalance;

// What has to vanish.
struct Condition {
  // At a state whose parameters are set and which is evaluated in the workspace; by matrices it is factored,
  // too, with its best multipliers.
  std::function<double(const ExtendedBalance&, const ExtendedState&, Workspace&)> value;
  // By scaled coordinates and multipliers, where that takes no matrices but maybe a potential. The workspace
  // may be used.
  std::function<SingularityTest::Gradient(const ExtendedBalance&, const ExtendedState&, Workspace&)>
      gradient{};
  bool of_matrix = false; // it looks at the KKT matrix, so that states beside one have to be factored, too
};

// A coordinate has a value (rad or m), or a speed that is found (rad/s or m/s).
Condition coordinate_is(const CoordinateInfo& coordinate, double value);
// A measure of the mechanism has a value, in its unit; `scale` is how large it is.
Condition measure_is(std::size_t measure, double value, double scale);
// The balance is singular: ExtendedBalance::singularity or, where it has ties, turned_singularity.
Condition balance_is_singular();
// The balance does not leave its range as a parameter moves: ExtendedBalance::transversality.
Condition branches_cross(std::size_t parameter);

struct ExtendedOutcome {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  // scaled, of balance, loops and conditions; forces in extended precision
  Eigen::VectorXd step; // the last correction, see unknowns()
};

class ExtendedBalance {
 public:
  // `scales` are the parameters' ranges of interest. `unfolded` adds an unknown force along the left border:
  // at a branch point the equations are regular only with it. `ties`: of states that stand turned, which none
  // of the parameters changes; not with branches_cross.
  ExtendedBalance(const System& system, const Mechanism& mechanism, std::vector<std::string> addresses,
                  Eigen::VectorXd scales, std::vector<Condition> conditions, bool unfolded = false,
                  std::optional<AngleTies> ties = {});
  ExtendedBalance(const ExtendedBalance&) = delete;
  ExtendedBalance& operator=(const ExtendedBalance&) = delete;

  // To the parameters of a state, and its angles.
  void set(const ExtendedState& state);
  // In the form that is solved.
  Problem problem() const { return {system_, parameters_, scaling_, nullptr, form_}; }
  // By matrices as far as eigenvalues are found without being asked for: what judges the stability.
  Problem judged() const;
  const Mechanism& mechanism() const { return mechanism_; }
  const Eigen::VectorXd& scales() const { return scales_; }
  // Entries of a step: scaled coordinates, angles that are tied, parameters over their scales.
  int unknowns() const { return system_.nv + tied() + static_cast<int>(scales_.size()); }
  const std::optional<AngleTies>& ties() const { return ties_; }
  Workspace& workspace() { return w_; }

  // From `state`, in place. `row` (as a step) closes the equations where
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

  // Vanishes where the balance is singular.
  const SingularityTest& singularity() const { return singularity_; }
  // The same of a balance with ties, with the angles among the unknowns: g of a bordered TurnedBalance (see
  // singularity.hpp). Not a number where that cannot be solved. The workspace is used.
  double turned_singularity(const ExtendedState& state, Workspace& w) const;
  // At a singular state: by how much the balance leaves its range as parameter `index` moves; vanishes at a
  // branch point.
  double transversality(const ExtendedState& state, std::size_t index, Workspace& w) const;

 private:
  bool is_possible() const; // what expressions make of the parameters set
  // Unknowns y, m (and the unfolding) of the matrices: the scaled step is r0 + N y + R m, and m for the
  // parameters.
  struct Assembled {
    Eigen::MatrixXd columns; // [N R; 0 I]: (unknowns, k + parameters); with angles see assemble_turned()
    Eigen::VectorXd r0;
    Eigen::MatrixXd matrix; // without the last row
    Eigen::VectorXd rhs;
    double residual = 0;
  };
  // Of block elimination.
  struct Bordered {
    BorderedKkt matrix;
    BorderedKkt::Rows rows; // of the conditions
    BorderedKkt::Vector rhs;
  };
  struct Step {
    Eigen::VectorXd scaled; // coordinates, parameters
    double unfolding = 0;
  };
  enum class Rhs { balance, none }; // of the balance and the conditions

  // Returns the residual; not finite where nothing can be solved.
  double linearize(const ExtendedState& state);
  void assemble(const ExtendedState& state, Assembled& out);
  // With angles: the unknowns are those of TurnedBalance, then the parameters.
  void assemble_turned(const ExtendedState& state, Assembled& out);
  // The conditions after the k equations of `out`, at a state whose matrices are in the workspace, and their
  // rates along its columns.
  void assemble_conditions(const ExtendedState& state, Eigen::Index k, Assembled& out);
  bool any_of_matrix() const { return std::ranges::any_of(conditions_, &Condition::of_matrix); }
  int tied() const { return ties_ ? static_cast<int>(ties_->along.cols()) : 0; }
  double border(const ExtendedState& state);
  // Of what was linearised, with the product `along` of the step and `row`, where that is not empty.
  std::optional<Step> solve(Rhs rhs, const Eigen::VectorXd& row, double along);
  std::optional<Step> solve_assembled(Rhs rhs, const Eigen::VectorXd& row, double along) const;
  std::optional<Step> solve_bordered(Rhs rhs, const Eigen::VectorXd& row, double along);
  // Forces with these multipliers (N m, N) and loops in extended precision, scaled: the last digits of the
  // answer come from here.
  void evaluate_extended(const Unknowns& z, Eigen::VectorXd& force, Eigen::VectorXd& phi);
  // Of the balance and the loops in one parameter over its scale, scaled; at the parameters that are set.
  void rates(const ExtendedState& state, std::size_t index, Eigen::VectorXd& force,
             Eigen::VectorXd& phi) const;

  const System& system_;
  Mechanism mechanism_;
  std::vector<std::string> addresses_;
  VariedNumbers numbers_; // of mechanism_
  Eigen::VectorXd scales_;
  std::vector<Condition> conditions_;
  bool unfolded_;
  std::optional<AngleTies> ties_;
  KktForm form_;
  Assembled assembled_;
  Bordered bordered_;
  Parameters parameters_;
  Scaling scaling_;
  SingularityTest singularity_;
  // Borders of TurnedBalance: they leave out loops and multipliers, whose basis is another at each state.
  Eigen::VectorXd turned_column_, turned_row_;
  Workspace w_, probe_;
};

} // namespace flyball
