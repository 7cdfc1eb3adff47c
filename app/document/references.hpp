// The names by which parts refer to one another.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <span>
#include <string>
#include <string_view>

namespace flyball {

// The bodies a joint or force is between or on; none for a gear.
inline std::span<std::string> bodies_of(Joint& joint) {
  if (joint.type == JointType::gear) return {};
  return joint.bodies;
}
inline std::span<const std::string> bodies_of(const Joint& joint) {
  if (joint.type == JointType::gear) return {};
  return joint.bodies;
}
inline std::span<std::string> bodies_of(Force& force) {
  if (acts_between(force.type)) return force.bodies;
  return {&force.body, 1};
}
inline std::span<const std::string> bodies_of(const Force& force) {
  if (acts_between(force.type)) return force.bodies;
  return {&force.body, 1};
}

// The joint of a gear's end, "name" or "name.index".
inline std::string joint_of_end(std::string_view end) {
  return std::string(end.substr(0, end.find('.')));
}
// The same end of another joint.
inline std::string end_at(std::string_view end, const std::string& joint) {
  const std::size_t dot = end.find('.');
  return dot == std::string_view::npos ? joint : joint + std::string(end.substr(dot));
}

} // namespace flyball
