#include "engine/study/friction_report.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/friction_parts.hpp"
#include "engine/study/brake_band.hpp"

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
                               const std::optional<std::vector<std::pair<std::string, double>>>& state,
                               const FrictionParts& parts, const std::atomic<bool>* cancel) {
  const auto begin = std::chrono::steady_clock::now();
  FrictionReport out;
  out.drawn = find_holding(mechanism, {}, cancel);
  const bool rests_on_friction =
      std::ranges::any_of(parts, [](FrictionPart part) { return part != FrictionPart::none; });
  if (state && !rests_on_friction) {
    out.band = find_friction_band(mechanism, {.start = *state, .cancel = cancel});
    out.speeds = find_held_speeds(mechanism, *state, cancel);
  } else {
    std::optional<FrictionBand> beside;
    if (state) beside = find_band_beside_brakes(mechanism, parts, *state, cancel);
    out.band = beside ? std::move(*beside) : band_by_friction_alone(mechanism, cancel);
    if (rests_on_friction && std::ranges::none_of(parts, is_slipping))
      out.speeds = find_held_speeds(mechanism, {}, cancel);
  }
  out.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

FrictionReport report_friction(const Mechanism& mechanism, const Solution& solution,
                               const std::atomic<bool>* cancel) {
  std::optional<std::vector<std::pair<std::string, double>>> state;
  if (solution.status == Status::converged) state = start_values(solution.coordinates);
  return report_friction(mechanism, state, parts_of(mechanism, solution.frictions), cancel);
}

} // namespace flyball
