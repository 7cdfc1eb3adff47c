#include "engine/study/friction_report.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {

FrictionReport report_friction(const Mechanism& mechanism,
                               const std::optional<std::vector<std::pair<std::string, double>>>& steady,
                               const std::atomic<bool>* cancel) {
  const auto begin = std::chrono::steady_clock::now();
  FrictionReport out;
  out.drawn = find_holding(mechanism, {}, cancel);
  if (steady) {
    out.band = find_friction_band(mechanism, {.start = *steady, .cancel = cancel});
    out.speeds = find_held_speeds(mechanism, *steady, cancel);
  } else {
    out.band.message = "There is no steady state without friction in it for a band to hang together with.";
  }
  out.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

FrictionReport report_friction(const Mechanism& mechanism, const Solution& solution,
                               const std::atomic<bool>* cancel) {
  std::optional<std::vector<std::pair<std::string, double>>> steady;
  if (solution.status == Status::converged && solution.frictions.empty())
    steady = start_values(solution.coordinates);
  FrictionReport out = report_friction(mechanism, steady, cancel);
  if (!solution.frictions.empty() && std::ranges::none_of(solution.frictions, &FrictionForce::slips))
    out.speeds = find_held_speeds(mechanism, {}, cancel);
  return out;
}

} // namespace flyball
