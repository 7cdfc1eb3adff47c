// The response of a mechanism to one parameter: branches of equilibria, their stability, and the points where
// they fold, cross or begin to flutter.
#pragma once

#include "engine/equilibrium/solution.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <atomic>
#include <functional>

namespace flyball {

struct ResponsePoint {
  double parameter = 0;
  std::vector<CoordinateSolution> coordinates;
  std::optional<bool> stable;
  std::optional<StabilityReason> stability_reason;
  std::vector<std::complex<double>> eigenvalues; // 1/s
};

enum class SpecialPointType {
  fold,         // the branch turns back
  branch_point, // another branch crosses
  hopf,         // a pair of eigenvalues crosses the imaginary axis where there is damping
  flutter,      // two imaginary pairs collide where there is none
};
std::string_view word(SpecialPointType type);

struct SpecialPoint {
  SpecialPointType type = SpecialPointType::fold;
  ResponsePoint at;
  int branch = 0;
};

struct ResponseBranch {
  std::vector<ResponsePoint> points;
  std::string end; // why it stops, in words
};

struct ResponseDiagram {
  Status status = Status::not_converged; // of the start
  std::string message;
  std::vector<ResponseBranch> branches;
  std::vector<SpecialPoint> special;
  double run_time_s = 0;
};

struct BranchOptions {
  double largest_step = 0.02; // scaled: radians, reaches, and parts of the parameter's range
  int max_points = 2000;      // a branch
  int max_branches = 32;
  bool switch_branches = true;
  bool eigenvalues = true;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(double part)> progress; // of the range, along the first branch
};

// Starts at `from`, solved nearest to the drawn pose, and follows that branch towards `to` (which may be
// smaller), then whatever branches off it. Throws SceneError for an address that does not exist.
ResponseDiagram follow_branches(const Mechanism& mechanism, const std::string& address, double from,
                                double to, const BranchOptions& options = {});

} // namespace flyball
