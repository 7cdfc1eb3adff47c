#include "engine/study/friction_report.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/frictions.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

bool torques_drive(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.joints, [](const Joint& joint) {
    return std::ranges::any_of(joint.coordinates,
                               [](const Coordinate& c) { return c.drive && finds_speed(*c.drive); });
  });
}

// Where nothing is steady without friction: about a state in which the only joint with friction gives all it
// can, either way. Where torques drive it might slip in that.
FrictionBand band_by_friction_alone(const Mechanism& mechanism, const std::atomic<bool>* cancel) {
  FrictionBand none;
  none.message = "There is no steady state without friction in it for a band to hang together with.";
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  if (frictions.size() != 1 || torques_drive(mechanism)) return none;
  if (formula_at(mechanism, share_address(mechanism, frictions.front()))) return none;
  Mechanism pushed = mechanism;
  for (const double share : {-1., 1.}) {
    set_parameter(pushed, share_address(mechanism, frictions.front()), share);
    FrictionBand band = find_friction_band(pushed, {.cancel = cancel});
    if (!band.found) continue;
    band.message = "Nothing is steady without friction: the band is about a state in which it gives all it "
                   "can. " +
                   band.message;
    return band;
  }
  return none;
}

} // namespace

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
    out.band = band_by_friction_alone(mechanism, cancel);
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
