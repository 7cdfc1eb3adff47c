// A state with what was computed at it: the balance evaluated at the drawn phase, and its KKT matrix
// factored. Stability, modes, sensitivities and the condition number are all found from this one
// factorization.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

// It holds as long as its workspace is used for no other state: who is given one leaves it as it is, and
// looks at states beside it in Workspace::elsewhere().
class FactoredState {
 public:
  const Problem problem;
  const Unknowns& z;
  Workspace& w;

  KktSystem& kkt() const { return w.kkt(problem); }

 private:
  FactoredState(const Problem& p, const Unknowns& state, Workspace& workspace)
      : problem(p), z(state), w(workspace) {}
  friend FactoredState factor_at(const Problem&, const Unknowns&, Workspace&, double);
  friend class SteadyState;
};

// Evaluates and factors the balance at z, which must outlive what is returned. `shift` (1/s^2) as
// KktSystem::factor has it: for states with many neutral directions, which it keeps still.
FactoredState factor_at(const Problem& problem, const Unknowns& z, Workspace& w, double shift = 0);

} // namespace flyball
