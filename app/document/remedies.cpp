#include "app/document/remedies.hpp"

#include "app/document/drawn_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

Coordinate* find(Mechanism& mechanism, const RunawayCoordinate& c) {
  const int j = joint_index(mechanism, c.joint);
  if (j < 0 || c.index < 0) return nullptr;
  Joint& joint = mechanism.joints[static_cast<std::size_t>(j)];
  const auto i = static_cast<std::size_t>(c.index);
  return i < joint.coordinates.size() ? &joint.coordinates[i] : nullptr;
}

// The nearest of 1, 2 and 5 times a power of ten.
double rounded(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const std::array steps{1., 2., 5., 10.};
  return power * *std::ranges::min_element(steps, {},
                                           [&](double s) { return std::abs(std::log(s * power / value)); });
}

struct Hold {
  double give = 0, stiffness = 0; // rad or m, N m/rad or N/m
};
Hold hold_for(const Mechanism& mechanism, const RunawayCoordinate& c) {
  const Joint& joint = mechanism.joints[static_cast<std::size_t>(joint_index(mechanism, c.joint))];
  Hold hold{is_angle(joint.type, c.index) ? 0.3 : 0.2 * drawn_size(mechanism), 1000};
  const double wanted = std::abs(c.force) / hold.give;
  if (std::isfinite(wanted) && wanted > 0) hold.stiffness = rounded(wanted);
  return hold;
}

} // namespace

bool can_hold(const Mechanism& mechanism, const RunawayCoordinate& c) {
  const Coordinate* found = find(const_cast<Mechanism&>(mechanism), c);
  return found && !found->drive && !found->spring && !found->stop;
}

void add_holding_spring(Mechanism& mechanism, const RunawayCoordinate& c) {
  if (!can_hold(mechanism, c)) return;
  const Hold hold = hold_for(mechanism, c);
  Coordinate& coordinate = *find(mechanism, c);
  coordinate.spring.emplace();
  coordinate.spring->stiffness = hold.stiffness;
  coordinate.spring->free = coordinate.drawn;
}

void add_holding_stop(Mechanism& mechanism, const RunawayCoordinate& c) {
  if (!can_hold(mechanism, c)) return;
  const Hold hold = hold_for(mechanism, c);
  Coordinate& coordinate = *find(mechanism, c);
  const double give = rounded(hold.give);
  coordinate.stop.emplace();
  coordinate.stop->stiffness = 100 * hold.stiffness;
  if (c.force < 0)
    coordinate.stop->lower = coordinate.drawn - give;
  else
    coordinate.stop->upper = coordinate.drawn + give;
}

std::optional<Vec3> gravity_along_drives(const Mechanism& mechanism) {
  const double size = mechanism.gravity.norm();
  std::optional<Vec3> axis;
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      if (!joint.coordinates[i].drive || !is_angle(joint.type, static_cast<int>(i))) continue;
      if (joint.type != JointType::revolute && joint.type != JointType::cylindrical) return std::nullopt;
      const Vec3 its = joint.axis.stableNormalized();
      if (axis && axis->cross(its).norm() > 1e-9) return std::nullopt;
      axis = its;
    }
  if (!axis || !(size > 0) || axis->cross(mechanism.gravity).norm() <= 1e-9 * size) return std::nullopt;
  Vec3 down = *axis;
  Eigen::Index largest = 0;
  down.cwiseAbs().maxCoeff(&largest);
  const double along = down.dot(mechanism.gravity);
  if (std::abs(along) > 1e-9 * size ? along < 0 : down[largest] > 0) down = -down;
  return Vec3(size * down + Vec3::Zero()); // no negative zeros
}

} // namespace flyball
