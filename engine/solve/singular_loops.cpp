#include "engine/solve/singular_loops.hpp"

#include <algorithm>

namespace flyball {

bool at_singular_loops(const Problem& problem, const Unknowns& z, Workspace& w) {
  constexpr double near =
      1e-8; // least pivot: half the digits, to which a pose beside a singular one is known
  constexpr double aside = 1e-4, grows = 10;
  const DenseKkt* dense = w.matrices(problem);
  if (!dense || problem.system.rows == 0 || problem.system.nv == 0) return false;
  const ConstraintSpace& here = dense->constraints();
  const int rank = here.rank();
  const double least = here.least_pivot();
  if (rank == std::min(problem.system.rows, problem.system.nv) && least > near) return false;
  Workspace& beside = w.elsewhere();
  beside.trial = z;
  beside.step = aside * here.basis().rowwise().sum().cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, beside.step, beside.trial.q);
  evaluate(problem, beside.trial, 0, beside);
  factor_constraints(problem, beside);
  const ConstraintSpace& there = beside.dense.constraints();
  return there.rank() > rank || (there.rank() == rank && least < near && there.least_pivot() > grows * least);
}

} // namespace flyball
