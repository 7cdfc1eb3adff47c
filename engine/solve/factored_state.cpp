#include "engine/solve/factored_state.hpp"

namespace flyball {

FactoredState factor_at(const Problem& problem, const Unknowns& z, Workspace& w, double shift) {
  evaluate(problem, z, 0, w);
  factor(problem, z, w);
  if (shift > 0) w.kkt(problem).factor(shift);
  return {problem, z, w};
}

} // namespace flyball
