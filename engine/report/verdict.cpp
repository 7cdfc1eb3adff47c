#include "engine/report/verdict.hpp"

#include "engine/linear/largest.hpp"
#include "engine/report/report.hpp"
#include "engine/stability/lowest_modes.hpp"
#include "engine/stability/sign_is_open.hpp"

#include <algorithm>

namespace flyball {

bool is_large(const Problem& problem) {
  return problem.system.nv > largest_for_eigenvalues && problem.form != KktForm::dense;
}

bool pivots_decide(const Problem& problem) {
  return is_large(problem) && problem.system.torques.empty();
}

Problem by_matrices(const Problem& problem) {
  return {problem.system, problem.parameters, problem.scaling, problem.cancel};
}

Stability stability_of(const Problem& problem, SteadyState& steady, bool with_eigenvalues, int modes) {
  if (pivots_decide(problem)) return find_stability(steady.factored(problem), false);
  const bool many = problem.system.nv > largest_for_eigenvalues && modes == 0;
  Stability out = find_stability(steady.factored(by_matrices(problem)), with_eigenvalues && !many);
  if (many && !out.floquet) out.eigenvalues.reset();
  return out;
}

bool stands_on_kink(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  if (!may_have_kinks(problem.system, problem.parameters)) return false; // of a minimum
  forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
  return !find_kinks(problem, q, w.kinematics).empty();
}

bool sign_may_change(const Problem& problem, SteadyState& steady, const Stability& stability) {
  return sign_is_open(problem, steady.found.z, steady.error.solution, stability, steady.elsewhere());
}

void leave_verdict_open(SteadyState& steady, Stability& stability) {
  leave_open(stability);
  steady.error.solution = steady.error.solution.cwiseMax(steady.error.undetermined);
}

std::string add_lowest_eigenvalues(const Problem& problem, const Unknowns& z, int count, Workspace& w,
                                   Stability& out) {
  std::vector<std::complex<double>> eigenvalues;
  // As a rule in pairs.
  for (const int modes : {(count + 1) / 2, count}) {
    const LowestModes lowest = find_lowest_modes(problem, z, modes, w);
    if (!lowest.failure.empty()) return lowest.failure;
    eigenvalues.clear();
    for (const VibrationMode& mode : lowest.modes) {
      eigenvalues.push_back(mode.eigenvalue);
      if (mode.oscillates()) eigenvalues.push_back(std::conj(mode.eigenvalue));
    }
    if (eigenvalues.size() >= static_cast<std::size_t>(count)) break;
  }
  const bool grows =
      std::ranges::any_of(eigenvalues, [](std::complex<double> s) { return s.real() > 1e-6 * std::abs(s); });
  if (!out.reason && grows) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  }
  out.eigenvalues = std::move(eigenvalues);
  return {};
}

void keep_asked_for(const Problem& problem, int modes, Stability& stability) {
  if (problem.system.nv > largest_for_eigenvalues && modes > 0 && stability.eigenvalues)
    keep_nearest(*stability.eigenvalues, static_cast<std::size_t>(modes));
}

void add_condition(const Problem& problem, SteadyState& steady, Solution& out) {
  if (problem.system.nv == 0 || problem.system.nv > largest_for_eigenvalues) return;
  out.condition = steady.factored(by_matrices(problem)).w.dense.hessian().condition();
}

} // namespace flyball
