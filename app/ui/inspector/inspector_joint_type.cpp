// What stays of a joint when it becomes one of another type.
#include "app/ui/inspector/inspector_parts.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace flyball {

namespace {

// Coordinate of the old type that each of the new one continues, or -1.
std::vector<int> continued(JointType from, JointType to) {
  std::vector<int> origin;
  for (int i = 0; i < coordinate_count(to); ++i) {
    int found = -1;
    for (int k = 0; k < coordinate_count(from) && found < 0; ++k)
      if (is_angle(from, k) == is_angle(to, i) && is_rotation_vector(from, k) == is_rotation_vector(to, i) &&
          std::ranges::find(origin, k) == origin.end())
        found = k;
    origin.push_back(found);
  }
  return origin;
}

// "joints.x.drive.0.speed" to "joints.x.drive.speed" and the like; empty where the number is no more.
std::string renumbered(const std::string& address, const std::string& joint, const std::vector<int>& origin,
                       std::size_t old_count) {
  const std::string prefix = "joints." + joint + ".";
  if (!address.starts_with(prefix)) return address;
  std::string rest = address.substr(prefix.size());
  constexpr std::array<std::string_view, 6> keys{"coordinate", "spring",   "damping",
                                                 "stop",       "friction", "drive"};
  const auto* key = std::ranges::find(keys, std::string_view(rest).substr(0, rest.find('.')));
  if (key == keys.end()) return address;
  rest.erase(0, key->size());
  int old = 0;
  if (old_count > 1) {
    old = rest.size() > 1 ? rest[1] - '0' : -1;
    rest.erase(0, 2);
  }
  const auto now = std::ranges::find(origin, old);
  if (now == origin.end()) return {};
  const std::string index = origin.size() > 1 ? "." + std::to_string(now - origin.begin()) : "";
  return prefix + std::string(*key) + index + rest;
}

bool is_number(const Mechanism& mechanism, const std::string& address) {
  try {
    get_parameter(mechanism, address);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

void place_points(const Mechanism& mechanism, Joint& joint) {
  for (std::size_t end = 0; end < 2; ++end) {
    const int body = body_index(mechanism, joint.bodies[end]);
    joint.points[end] = body < 0 ? joint.at : mechanism.bodies[static_cast<std::size_t>(body)].position;
  }
}

} // namespace

void change_joint_type(Mechanism& mechanism, const std::string& name, JointType type) {
  const int index = joint_index(mechanism, name);
  if (index < 0 || type == JointType::gear) return;
  Joint& joint = mechanism.joints[static_cast<std::size_t>(index)];
  if (joint.type == type || joint.type == JointType::gear) return;
  const Joint before = joint;
  std::set<std::string> known;
  for (const Slider& slider : mechanism.sliders)
    if (is_number(mechanism, slider.parameter)) known.insert(slider.parameter);
  const std::vector<int> origin = continued(before.type, type);
  joint.type = type;
  joint.coordinates.assign(origin.size(), {});
  for (std::size_t i = 0; i < origin.size(); ++i)
    if (origin[i] >= 0 && static_cast<std::size_t>(origin[i]) < before.coordinates.size())
      joint.coordinates[i] = before.coordinates[static_cast<std::size_t>(origin[i])];
  for (std::size_t i = 0; i < joint.coordinates.size(); ++i) // where coordinates do not slip one by one
    if (type == JointType::free || (type == JointType::planar && !is_angle(type, static_cast<int>(i))))
      joint.coordinates[i].friction.reset();
  if (type == JointType::distance) place_points(mechanism, joint);
  if (before.type == JointType::distance) {
    joint.at = before.points[0];
    joint.length.reset();
  }
  if (type == JointType::distance || type == JointType::free) joint.cut.reset();
  // The second axis must not be along the first.
  if (has_axis2(type) &&
      joint.axis.cross(joint.axis2).norm() <= 1e-9 * joint.axis.norm() * joint.axis2.norm())
    joint.axis2 = joint.axis.unitOrthogonal();

  for (Joint& gear : mechanism.joints)
    for (std::string& end : gear.joints) {
      if (gear.type != JointType::gear || end.substr(0, end.find('.')) != name) continue;
      const std::size_t dot = end.find('.');
      const int old = dot == std::string::npos ? 0 : end[dot + 1] - '0';
      const auto now = std::ranges::find(origin, old);
      if (now != origin.end()) end = coordinate_name(joint, static_cast<int>(now - origin.begin()));
    }
  std::erase_if(mechanism.sliders, [&](Slider& slider) {
    if (!known.contains(slider.parameter)) return false; // a mistake, to be told and not to be hidden
    slider.parameter = renumbered(slider.parameter, name, origin, before.coordinates.size());
    return !is_number(mechanism, slider.parameter);
  });
}

const char* coordinate_title(JointType type, int i) {
  const auto at = static_cast<std::size_t>(i);
  constexpr std::array<const char*, 3> rotation{"Rotation x", "Rotation y", "Rotation z"};
  constexpr std::array<const char*, 3> shift{"Shift x", "Shift y", "Shift z"};
  switch (type) {
  case JointType::revolute: return "Angle";
  case JointType::prismatic: return "Slide";
  case JointType::cylindrical: return i == 0 ? "Angle" : "Slide";
  case JointType::universal: return i == 0 ? "Angle at the parent" : "Angle at the child";
  case JointType::spherical: return rotation.at(at);
  case JointType::planar: return i == 2 ? "Angle" : shift.at(at);
  case JointType::free: return i < 3 ? shift.at(at) : rotation.at(at - 3);
  case JointType::fixed:
  case JointType::distance:
  case JointType::gear: break;
  }
  return "";
}

} // namespace flyball
