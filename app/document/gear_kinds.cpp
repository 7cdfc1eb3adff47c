#include "app/document/gear_kinds.hpp"

#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/gear_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flyball {
namespace {

bool is_turn(const Mechanism& mechanism, const std::string& coordinate) {
  const auto [joint, i] = find_coordinate(mechanism, coordinate);
  return joint >= 0 && is_angle(mechanism.joints[static_cast<std::size_t>(joint)].type, i);
}

// With nothing left of another kind's numbers.
void set_ratio(Joint& gear, double ratio) {
  constexpr double wheel = 0.05; // m, where the ratio leaves it open
  const Joint none;
  gear.ratio = none.ratio;
  gear.radii = none.radii;
  gear.crossed = none.crossed;
  gear.lead = none.lead;
  switch (gear.kind) {
  case GearKind::gear: gear.ratio = ratio; return;
  case GearKind::belt:
    gear.radii = {wheel * std::abs(ratio), wheel};
    gear.crossed = ratio < 0;
    return;
  case GearKind::rack: gear.radii[0] = ratio; return;
  case GearKind::screw: gear.lead = 2 * std::numbers::pi * ratio; return;
  }
}

} // namespace

std::string joint_noun(const Joint& joint) {
  if (joint.type == JointType::gear && joint.kind != GearKind::gear)
    return std::string(type_name(joint.kind));
  return std::string(type_name(joint.type)) + " joint";
}

std::string force_noun(const Force& force) {
  return force.type == ForceType::spring && is_damper_alone(force) ? "damper"
                                                                   : std::string(type_name(force.type));
}

std::vector<GearKind> gear_kinds(const Mechanism& mechanism, const std::array<std::string, 2>& coordinates) {
  for (const std::string& coordinate : coordinates) {
    const auto [joint, i] = find_coordinate(mechanism, coordinate);
    if (joint < 0 || is_rotation_vector(mechanism.joints[static_cast<std::size_t>(joint)].type, i)) return {};
  }
  const bool a = is_turn(mechanism, coordinates[0]), b = is_turn(mechanism, coordinates[1]);
  if (a != b) return {GearKind::gear, GearKind::rack, GearKind::screw};
  if (a) return {GearKind::gear, GearKind::belt};
  return {GearKind::gear};
}

std::optional<std::array<std::string, 2>> gear_ends(const Mechanism& mechanism,
                                                    const std::vector<std::string>& joints, GearKind kind) {
  if (joints.empty() || joints.size() > 2) return {};
  const auto coordinates_of = [&](const std::string& name) {
    std::vector<std::string> all;
    if (const int j = joint_index(mechanism, name); j >= 0) {
      const Joint& joint = mechanism.joints[static_cast<std::size_t>(j)];
      for (int i = 0; i < coordinate_count(joint.type); ++i)
        all.push_back(coordinate_name(joint, i));
    }
    return all;
  };
  for (const std::string& a : coordinates_of(joints.front()))
    for (const std::string& b : coordinates_of(joints.back()))
      if (a != b && std::ranges::count(gear_kinds(mechanism, {a, b}), kind) > 0) return {{a, b}};
  return {};
}

void change_gear_kind(const Mechanism& mechanism, Joint& gear, GearKind kind) {
  double ratio = gear_ratio(gear);
  gear.kind = kind;
  if (turns_into_slide(kind) && !is_turn(mechanism, gear.joints[0])) { // q_a = (q_b - offset) / ratio
    std::swap(gear.joints[0], gear.joints[1]);
    if (gear.offset) gear.offset = 0.0 - *gear.offset / ratio;
    ratio = 1 / ratio;
  }
  set_ratio(gear, ratio);
}

void reverse_ratio(Joint& gear) {
  switch (gear.kind) {
  case GearKind::gear: gear.ratio = -gear.ratio; return;
  case GearKind::belt: gear.crossed = !gear.crossed; return;
  case GearKind::rack: gear.radii[0] = -gear.radii[0]; return;
  case GearKind::screw: gear.lead = -gear.lead; return;
  }
}

} // namespace flyball
