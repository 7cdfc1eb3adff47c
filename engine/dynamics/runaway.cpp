#include "engine/dynamics/runaway.hpp"

#include "engine/system/bearing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

std::string runaway_coordinate(const MotionModel& model, const Eigen::VectorXd& state, double rate_scale) {
  // Radians or reaches away, or as many times too fast.
  constexpr double far_away = 1e8, far_too_fast = 1e10;
  double worst = 1;
  std::string out;
  for (const Link& link : model.system.links) {
    if (link.v < 0) continue;
    const bool rotation = link.type == LinkType::spherical;
    for (int k = 0; k < (rotation ? 3 : 1); ++k) {
      const double scale = model.scaling.column[link.v + k];
      const double place = rotation ? 0 : std::abs(state[link.q]) / (far_away * scale);
      const double speed =
          std::abs(state[model.system.nq + link.v + k]) / (far_too_fast * scale * rate_scale);
      if (!(std::max(place, speed) > worst)) continue;
      worst = std::max(place, speed);
      out = name_of_coordinate(model, link.v + k) + " runs away";
    }
  }
  return out;
}

std::string BearingTurns::turned_over(const MotionModel& model, const Kinematics<double>& now) {
  const System& system = model.system;
  turns_.resize(system.bearings.size(), Vec3::Zero());
  for (std::size_t i = 0; i < system.bearings.size(); ++i) {
    const BearingElement& e = system.bearings[i];
    if (!model.parameters.bearings[i].resists_turns()) continue;
    const Vec3 before = turns_[i];
    turns_[i] = bearing_state<double>(e, model.parameters.bearings[i], now).x.tail<3>();
    constexpr double quarter = std::numbers::pi / 2;
    if (turns_[i].dot(before) < -quarter * quarter)
      return "the bodies of the bearing " + model.mechanism.forces[static_cast<std::size_t>(e.force)].name +
             " turned by more than half a turn against each other, where its moments jump";
  }
  return {};
}

} // namespace flyball
