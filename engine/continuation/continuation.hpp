// A branch of equilibria followed through folds as one parameter of the mechanism moves: pseudo-arclength
// continuation (Keller 1977; Allgower and Georg, Introduction to Numerical Continuation Methods, chapters 6
// and 7) on the null space of the constraints, so that redundant loops do no harm.
#pragma once

#include "engine/solve/newton.hpp"

#include <string>

namespace flyball {

// The mechanism with one number free.
class Family {
 public:
  Family(const System& system, const Mechanism& mechanism, std::string address, double scale);

  void set(double value);
  double value() const { return value_; }
  double scale() const { return scale_; } // the range of interest, in the parameter's unit
  const Mechanism& mechanism() const { return mechanism_; }
  Problem problem() const { return {system_, parameters_, scaling_}; }

 private:
  const System& system_;
  Mechanism mechanism_;
  std::string address_;
  double scale_, value_ = 0;
  Parameters parameters_;
  Scaling scaling_;
};

// A point on a branch and the direction it goes on in.
struct BranchState {
  Unknowns z;
  double parameter = 0;
  Eigen::VectorXd tangent; // scaled step of q_R, then of the parameter over Family::scale(); unit length
  double turning = 0;      // the tangent's last entry: changes sign at a fold
  double determinant = 0;  // of the bordered balance, scaled: changes sign at a branch point
};

class Continuation {
 public:
  explicit Continuation(Family& family) : family_(family) {}

  // Completes a state whose z solves the balance at its parameter: tangent with the parameter growing, or
  // falling for direction < 0. False at a singular state that has no single tangent.
  bool start(BranchState& state, double direction);

  // The point `length` further along (scaled arclength). False where the corrector fails. `iterations` tells
  // how hard it was.
  bool step(const BranchState& from, double length, BranchState& to, int& iterations);

  // Solves at exactly the state's parameter, from its z.
  bool land(BranchState& state);

  // A state near `at`, off along another direction of the null space of the bordered balance: where a second
  // branch crosses.
  bool switch_branch(const BranchState& at, double length, BranchState& to);

 private:
  struct Bordered;
  void assemble(const Unknowns& z, double parameter, Bordered& out);
  bool correct(const Unknowns& from, double parameter, const Eigen::VectorXd& tangent, double length,
               BranchState& to, int& iterations);
  bool find_tangent(BranchState& state, const Eigen::VectorXd& previous);

  Family& family_;
  Workspace w_;
};

} // namespace flyball
