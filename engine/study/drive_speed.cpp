#include "engine/study/drive_speed.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"

#include <algorithm>
#include <limits>

namespace flyball {

DriveSpeed::DriveSpeed(const Mechanism& mechanism, std::string address) : address_(std::move(address)) {
  const std::vector<PrescribedSpeed> speeds = prescribed_speeds(mechanism);
  for (const PrescribedSpeed& speed : speeds)
    if (speed.angle && (speed.address == address_ || number_alone(mechanism, speed.address) == address_)) {
      joint_ = speed.joint;
      return;
    }
  for (const PrescribedSpeed& speed : speeds) {
    const std::optional<std::string> formula = formula_at(mechanism, speed.address);
    if (!speed.angle || !formula) continue;
    const std::vector<std::string> sources = sources_of(mechanism, *formula);
    if (std::ranges::find(sources, address_) == sources.end()) continue;
    joint_ = speed.joint;
    speed_ = speed.address;
    formula_ = *formula;
    varied_ = mechanism;
    return;
  }
}

bool DriveSpeed::set(double value) {
  try {
    set_parameter(*varied_, address_, value);
  } catch (const SceneError&) {
    return false;
  }
  return true;
}

double DriveSpeed::at(double value) {
  if (!varied_) return value;
  return set(value) ? get_parameter(*varied_, speed_) : std::numeric_limits<double>::quiet_NaN();
}

double DriveSpeed::rate(double value) {
  if (!varied_) return 1;
  return set(value) ? expression_gradient(*varied_, formula_, {address_}).front()
                    : std::numeric_limits<double>::quiet_NaN();
}

} // namespace flyball
