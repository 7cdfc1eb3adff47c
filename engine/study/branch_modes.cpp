#include "engine/study/branch_modes.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/report/solve_with_parts.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Floquet's exponents and what large mechanisms tell: eigenvalues alone.
std::vector<VibrationMode> without_shapes(const std::vector<std::complex<double>>& eigenvalues) {
  std::vector<VibrationMode> out;
  for (const std::complex<double> s : eigenvalues) {
    if (s.imag() < 0) continue;
    VibrationMode mode;
    mode.eigenvalue = s;
    mode.frequency = damped_frequency(s);
    mode.natural_frequency = natural_frequency(s);
    mode.damping_ratio = damping_ratio(s);
    out.push_back(std::move(mode));
  }
  sort_modes(out);
  return out;
}

// The coordinates between those of two points, as starts.
std::vector<std::pair<std::string, double>> start_between(const ResponsePoint& a, const ResponsePoint& b,
                                                          double part) {
  std::vector<std::pair<std::string, double>> start = start_values(a.coordinates);
  const std::vector<std::pair<std::string, double>> there = start_values(b.coordinates);
  for (std::size_t i = 0; i < start.size() && i < there.size(); ++i)
    start[i].second += part * (there[i].second - start[i].second);
  return start;
}

} // namespace

BranchModes::BranchModes(const Mechanism& mechanism, const std::string& address,
                         const std::atomic<bool>* cancel)
    : mechanism_(mechanism), address_(address), drive_(mechanism, address), analysis_(mechanism),
      cancel_(cancel) {
  analysis_.vary(std::vector{address});
}

CampbellPoint BranchModes::at(const ResponsePoint& point) {
  CampbellPoint out;
  if (point.singular_loops) return out;
  if (solve(point.parameter, start_values(point.coordinates), point.frictions) && same_as(point))
    out.modes = solved().modes();
  if (out.modes.empty()) out.modes = without_shapes(point.eigenvalues);
  for (const VibrationMode& mode : out.modes)
    out.whirls.push_back(whirl(mode));
  return out;
}

std::vector<VibrationMode> BranchModes::between(const ResponsePoint& a, const ResponsePoint& b,
                                                double value) {
  const double part = (value - a.parameter) / (b.parameter - a.parameter);
  if (!solve(value, start_between(a, b, part), a.frictions)) return {};
  return solved().modes();
}

std::optional<Whirl> BranchModes::whirl(const VibrationMode& mode) {
  return turns() ? solved().whirl(mode, drive_.joint()) : std::nullopt;
}

// `frictions`: of a state that rests on them.
bool BranchModes::solve(double value, std::vector<std::pair<std::string, double>> start,
                        const std::vector<FrictionForce>& frictions) {
  interruption_point();
  on_friction_.reset();
  try {
    SolveOptions options;
    options.nearest = true;
    options.details = false;
    options.start = std::move(start);
    options.cancel = cancel_;
    if (!frictions.empty()) {
      const Mechanism there = with_parameter(mechanism_, address_, value);
      on_friction_ = solve_with_parts(there, parts_of(there, frictions), options);
      if (!on_friction_) return false;
      solution_ = on_friction_->solution;
      return true;
    }
    analysis_.set({&value, 1});
    solution_ = analysis_.solve(options);
  } catch (const SceneError&) {
    return false;
  }
  return solution_.status == Status::converged;
}

// Beside a fold the nearest state may be of the other side.
bool BranchModes::same_as(const ResponsePoint& point) const {
  return scaled_distance(point.coordinates, solution_.coordinates) <= 1e-5;
}

double unlikeness(const VibrationMode& mode, const VibrationMode& a, const VibrationMode& b, double part) {
  const std::complex<double> expected = a.eigenvalue + part * (b.eigenvalue - a.eigenvalue);
  const double size = 0.2 * std::abs(expected) + std::abs(b.eigenvalue - a.eigenvalue) + 1e-300;
  return std::abs(mode.eigenvalue - expected) / size + 1 -
         std::max(modal_assurance(mode, a), modal_assurance(mode, b));
}

} // namespace flyball
