// The judge: an answer of the engine carried on by Newton's method in 113 bits, with the engine's own
// balance, its exact Jacobian, and loops closed in the sense of least squares, until nothing moves.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"

#include <memory>
#include <vector>

namespace flyball::stress {

struct ReferenceCoordinate {
  double away = 0;        // rad or m: the engine's value from the reference
  double uncertainty = 0; // rad or m, of the reference itself
  double unit = 1;        // 1 rad, or the mechanism's reach in m
};

struct ReferenceState {
  bool converged = false;
  bool singular = false; // directions without stiffness, in which the reference stays where the answer is
  double distance = 0;   // the largest scaled step of all, summed: radians and reaches
  double imbalance = 0;  // of the engine's answer: forces relative to the terms they are made of, lengths to
                         // the reach; at any multipliers
  double opening = 0;    // of the loops at the reference, relative to the reach: redundant equations disagree
  double softest = 0;    // smallest over largest pivot of the equilibrated stiffness
  std::vector<ReferenceCoordinate> coordinates; // as in Solution::coordinates; driven ones are zero
};

class Reference {
 public:
  explicit Reference(const Mechanism& mechanism);
  ~Reference();
  // From a converged solution of the same mechanism.
  ReferenceState settle(const Solution& solution) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball::stress
