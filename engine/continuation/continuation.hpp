// A branch of equilibria followed through folds as one parameter of the mechanism moves: pseudo-arclength
// continuation (Keller 1977; Allgower and Georg, Introduction to Numerical Continuation Methods, chapters 6
// and 7) by the bordered balance.
#pragma once

#include "engine/continuation/bordered_balance.hpp"

#include <memory>

namespace flyball {

// A point on a branch and the direction it goes on in.
struct BranchState {
  Unknowns z;
  double parameter = 0;
  Eigen::VectorXd tangent;  // scaled step of q_R, of the angles that are tied (none, but of states that stand
                            // turned), then of the parameter over Family::scale(); unit length
  double turning = 0;       // the tangent's last entry: changes sign at a fold
  double determinant = 0;   // of the bordered balance, scaled: changes sign at a branch point
  Eigen::VectorXd starts{}; // by link, of one that stands turned: Family::turn()
  // Directions that nothing resists (n, d; scaled, orthonormal columns): the state is one of a family, and
  // the curve goes on orthogonally to it.
  Eigen::MatrixXd still{};
  // The same where they are not kept still, or something hardly resists them: the determinant is rounding.
  bool drifts = false;
  int falling = 0; // eigenvalues of K across the family that have a negative real part; 0 where not counted
  bool twofold = false; // a crossing at which two eigenvalues of K are zero
  bool one_of_many() const { return still.cols() > 0 || drifts; }
};

// Farther than any mechanism goes: a hundred times its reach, or at a found speed that is followed no
// further.
bool out_of_reach(const Problem& problem, const Eigen::VectorXd& q);

class Continuation {
 public:
  explicit Continuation(Family& family);

  // After the family's angles were tied.
  void tied();

  // Completes a state whose z solves the balance at its parameter: tangent with the parameter growing, or
  // falling for direction < 0. False at a singular state that has no single tangent.
  bool start(BranchState& state, double direction);
  // The same with a tangent along this step.
  bool start(BranchState& state, const Eigen::VectorXd& along) { return find_tangent(state, along); }

  // The point `length` further along (scaled arclength). False where the corrector fails. `iterations` tells
  // how hard it was.
  bool step(const BranchState& from, double length, BranchState& to, int& iterations);

  // Moves a state along its family, by so much (scaled) along each of its directions. False where the
  // corrector fails.
  bool slide(BranchState& state, const Eigen::VectorXd& by);

  // Solves at exactly the state's parameter, from its z.
  bool land(BranchState& state);

  // A state near `at`, off along another direction of the null space of the bordered balance: where a second
  // branch crosses.
  bool switch_branch(const BranchState& at, double length, BranchState& to);

 private:
  // Entries of a tangent.
  Eigen::Index unknowns() const;
  // By a step as tangents are.
  void move(const Eigen::VectorXd& step, BranchState& state) const;
  double linearize(const BranchState& state); // the scaled residual
  bool correct(const BranchState& from, const Eigen::VectorXd& tangent, double length, BranchState& to,
               int& iterations);
  bool find_tangent(BranchState& state, const Eigen::VectorXd& previous);

  Family& family_;
  Workspace w_;
  std::unique_ptr<BorderedBalance> balance_;
};

} // namespace flyball
