// From what the solvers found to what a person reads.
#pragma once

#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/stability.hpp"

namespace flyball {

struct ReportInput {
  const Mechanism& mechanism;
  const Problem& problem;
  const Found& found;
  const Existence& existence;
  const Stability& stability;
  std::span<const BodyPoint> points{};
  MeasureSet* measures = nullptr; // bound to the numbers; null: none
};

// Whether every number in it is one: forces can overflow where coordinates do not.
bool is_finite(const Solution& solution);

// Names a coordinate whose error is far beyond all turns or reaches of the mechanism, and beyond the value
// itself, or a speed that was found of which not a digit is known. A sentence; empty where all are known.
std::string unknown_coordinate_message(const std::vector<CoordinateSolution>& coordinates);

// Fills the parts of a converged solution; `error` by coordinate of q_R.
void report(const ReportInput& input, const Eigen::VectorXd& error, bool details, Workspace& w,
            Solution& out);

// A configuration as its joints label it; `error` by coordinate of q_R (rad, m), `kinematics` at the drawn
// phase.
std::vector<CoordinateSolution> coordinate_solutions(const System& system, const Parameters& parameters,
                                                     const Eigen::VectorXd& q, const Eigen::VectorXd& error,
                                                     const Kinematics<double>& kinematics);

// Rates of q_R by the names of its coordinates.
Sensitivity name_rates(const System& system, const std::string& address, const Eigen::VectorXd& rate);

SystemSummary summarize(const Mechanism& mechanism, const System& system, const Parameters& parameters);

// Sets coordinates named "joint" or "joint.index" in a configuration; components of a rotation vector that
// are not named stay. Throws SceneError where there is no such free coordinate.
void set_start(const System& system, const Parameters& parameters,
               const std::vector<std::pair<std::string, double>>& start, Eigen::VectorXd& q);

} // namespace flyball
