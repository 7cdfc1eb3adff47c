#include "engine/study/friction_report.hpp"

namespace flyball {

FrictionReport report_friction(const Mechanism& mechanism,
                               const std::optional<std::vector<std::pair<std::string, double>>>& steady,
                               const std::atomic<bool>* cancel) {
  FrictionReport out;
  out.drawn = find_holding(mechanism, {}, cancel);
  if (!steady) {
    out.band.message = "There is no steady state for a band to hang together with.";
    return out;
  }
  FrictionBandOptions options;
  options.start = *steady;
  options.cancel = cancel;
  out.band = find_friction_band(mechanism, options);
  out.speeds = find_held_speeds(mechanism, options.start, cancel);
  return out;
}

FrictionReport report_friction(const Mechanism& mechanism, const Solution& solution) {
  std::optional<std::vector<std::pair<std::string, double>>> steady;
  if (solution.status == Status::converged) steady = start_values(solution.coordinates);
  return report_friction(mechanism, steady);
}

} // namespace flyball
