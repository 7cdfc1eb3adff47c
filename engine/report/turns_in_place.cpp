#include "engine/report/turns_in_place.hpp"

#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/referred_to.hpp"

#include <algorithm>
#include <array>

namespace flyball {
namespace {

constexpr double on_line = 1e-12; // of the distances

// Whether a point lies on the axis of a joint.
bool is_on_axis(const Joint& joint, const Vec3& point) {
  const Vec3 away = point - joint.at;
  return away.cross(joint.axis).norm() <= on_line * joint.axis.norm() * (away.norm() + point.norm());
}

bool acts_in_place(const Mechanism& mechanism, const Joint& joint) {
  if (joint.type == JointType::gear) return true;
  const Coordinate* c = joint.type == JointType::revolute ? &joint.coordinates[0] : nullptr;
  return c && !c->spring && !c->stop &&
         !(c->drive && finds_speed(*c->drive) && asks_for_place(mechanism, joint, 0));
}

} // namespace

bool asks_for_place(const Mechanism& mechanism, const Joint& joint, int i) {
  return std::ranges::any_of(std::array<std::string_view, 2>{"torque", "load"}, [&](std::string_view which) {
    const Formula* law = drive_law(mechanism, joint, i, which);
    if (!law) return false;
    const Expression read = read_drive_law(mechanism, law->text);
    return std::ranges::any_of(read.results(),
                               [](const ResultCall& call) { return call.result != Result::rate; });
  });
}

bool turns_in_place(const Mechanism& mechanism) {
  if (mechanism.air.wind != Vec3::Zero() || !mechanism.air.turns_with.empty()) return false;
  if (std::ranges::any_of(mechanism.forces, [](const Force& force) { return force.type != ForceType::drag; }))
    return false;
  std::vector<const Joint*> of_body(mechanism.bodies.size(), nullptr); // one of its joints
  const Joint* first = nullptr;
  for (const Joint& joint : mechanism.joints) {
    if (!acts_in_place(mechanism, joint)) return false;
    if (joint.type == JointType::gear) continue;
    if (!first) first = &joint;
    if (first->axis.normalized().cross(joint.axis.normalized()).norm() > on_line) return false;
    for (const std::string& name : joint.bodies) {
      const int b = body_index(mechanism, name);
      if (b < 0) continue;
      const Body& body = mechanism.bodies[static_cast<std::size_t>(b)];
      const Joint*& other = of_body[static_cast<std::size_t>(b)];
      if (!other) other = &joint;
      if (!is_on_axis(*other, joint.at) || (body.mass > 0 && !is_on_axis(joint, body.position))) return false;
    }
  }
  return std::ranges::find(of_body, nullptr) == of_body.end();
}

bool is_tied(const Mechanism& mechanism, std::span<const CoordinateReference> held,
             CoordinateReference other) {
  if (gear_train(mechanism, other).size() > 1) return true;
  const BodyNumbers numbers(mechanism);
  BodyGroups together(numbers);
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    if (joint.type == JointType::gear || j == static_cast<std::size_t>(other.joint)) continue;
    const bool stands = std::ranges::any_of(
        held, [&](CoordinateReference at) { return static_cast<std::size_t>(at.joint) == j; });
    const bool driven = std::ranges::any_of(
        joint.coordinates, [](const Coordinate& c) { return c.drive && !finds_speed(*c.drive); });
    if (stands || driven) together.join(joint.bodies);
  }
  return !together.join(joint_of(mechanism, other).bodies);
}

} // namespace flyball
