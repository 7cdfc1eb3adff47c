#include "engine/solve/homotopy.hpp"

namespace flyball {

NewtonOutcome homotopy(const Problem& problem, Unknowns& z, Workspace& w, std::vector<double>* history) {
  Parameters slowed = problem.parameters;
  const Problem part{problem.system, slowed, problem.scaling, problem.cancel, problem.form};
  int iterations = 0;
  const auto solve_at = [&](double squared, Unknowns& at, bool damped) {
    slowed.speed_scale = std::sqrt(squared) * problem.parameters.speed_scale;
    const NewtonOutcome o = newton(part, at, w, {damped ? 80 : 12, damped}, history);
    iterations += o.iterations;
    return o;
  };
  NewtonOutcome last = solve_at(0, z, true);
  double reached = 0, step = 0.125;
  while (last.converged && reached < 1 && !problem.cancelled()) {
    const double target = std::min(1., reached + step);
    Unknowns trial = z;
    const NewtonOutcome o = solve_at(target, trial, false);
    // A long step means that the solution was lost and another found.
    if (o.converged && o.largest_step < 0.5) {
      z = trial;
      reached = target;
      last = o;
      step *= 1.5;
    } else if ((step /= 2) < tolerance::least_homotopy_step) {
      last.converged = false;
    }
  }
  last.iterations = iterations;
  last.converged = last.converged && reached >= 1;
  return last;
}

} // namespace flyball
