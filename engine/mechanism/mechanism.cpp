#include "engine/mechanism/gear_ratio.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace flyball {
namespace {

struct JointTraits {
  std::string_view name;
  std::string_view coordinates; // one letter each: a angle, l length, r component of a rotation vector
  bool at, axis, axis2;
};

// In the order of JointType.
constexpr std::array<JointTraits, 10> joint_traits{{
    {"revolute", "a", true, true, false},
    {"prismatic", "l", true, true, false},
    {"cylindrical", "al", true, true, false},
    {"universal", "aa", true, true, true},
    {"spherical", "rrr", true, false, false},
    {"planar", "lla", true, true, true},
    {"free", "lllrrr", true, false, false},
    {"fixed", "", true, false, false},
    {"distance", "", false, false, false},
    {"gear", "", false, false, false},
}};

const JointTraits& traits(JointType type) {
  return joint_traits[static_cast<std::size_t>(type)];
}

template <class List>
int index_by_name(const List& list, std::string_view name) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return static_cast<int>(i);
  return -1;
}

} // namespace

int coordinate_count(JointType type) {
  return static_cast<int>(traits(type).coordinates.size());
}

bool is_angle(JointType type, int i) {
  return traits(type).coordinates.at(static_cast<std::size_t>(i)) != 'l';
}

bool is_rotation_vector(JointType type, int i) {
  return traits(type).coordinates.at(static_cast<std::size_t>(i)) == 'r';
}

bool has_at(JointType type) {
  return traits(type).at;
}
bool has_axis(JointType type) {
  return traits(type).axis;
}
bool has_axis2(JointType type) {
  return traits(type).axis2;
}

std::string_view type_name(JointType type) {
  return traits(type).name;
}

std::string_view type_name(GearKind kind) {
  constexpr std::array<std::string_view, 4> names{"gear", "belt", "rack", "screw"};
  return names[static_cast<std::size_t>(kind)];
}

bool turns_into_slide(GearKind kind) {
  return kind == GearKind::rack || kind == GearKind::screw;
}

std::string_view type_name(ForceType type) {
  constexpr std::array<std::string_view, 6> names{"spring", "force", "torque", "drag", "vane", "bearing"};
  return names[static_cast<std::size_t>(type)];
}

bool is_of_air(ForceType type) {
  return type == ForceType::drag || type == ForceType::vane;
}

std::string_view type_name(ShapeType type) {
  constexpr std::array<std::string_view, 4> names{"sphere", "box", "cylinder", "capsule"};
  return names[static_cast<std::size_t>(type)];
}

std::string_view type_name(ForceFrame frame) {
  return frame == ForceFrame::world ? "world" : "body";
}

std::string_view type_name(DriveKeeps keeps) {
  return keeps == DriveKeeps::speed ? "speed" : "momentum";
}

bool acts_between(ForceType type) {
  return type == ForceType::spring || type == ForceType::bearing;
}

Vec3 bearing_x_towards(const Force& bearing) {
  Eigen::Index nearest = 0;
  bearing.axis.cwiseAbs().minCoeff(&nearest);
  return bearing.x_axis.value_or(Vec3(Vec3::Unit(nearest)));
}

int bearing_size(const Force& bearing) {
  constexpr std::size_t full = 36;
  return bearing.bearing_stiffness.size() == full || bearing.bearing_damping.size() == full ? 6 : 2;
}

bool has_polar(const Force& vane) {
  return vane.lift || vane.drag;
}

bool finds_speed(const Drive& drive) {
  return drive.torque || drive.keeps == DriveKeeps::momentum;
}

std::string_view type_name(SliderScale scale) {
  return scale == SliderScale::linear ? "linear" : "log";
}

bool is_usable_name(std::string_view name) {
  const auto bad = [](char c) { return c == '.' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  return !name.empty() && name != ground_name && std::none_of(name.begin(), name.end(), bad);
}

int body_index(const Mechanism& mechanism, std::string_view name) {
  return name == ground_name ? -1 : index_by_name(mechanism.bodies, name);
}

int joint_index(const Mechanism& mechanism, std::string_view name) {
  return index_by_name(mechanism.joints, name);
}

int force_index(const Mechanism& mechanism, std::string_view name) {
  return index_by_name(mechanism.forces, name);
}

CoordinateReference find_coordinate(const Mechanism& mechanism, std::string_view name) {
  const std::size_t dot = name.find('.');
  const int joint = joint_index(mechanism, name.substr(0, dot));
  if (joint < 0) return {};
  const int count = coordinate_count(mechanism.joints[static_cast<std::size_t>(joint)].type);
  if (dot == std::string_view::npos)
    return count == 1 ? CoordinateReference{joint, 0} : CoordinateReference{};
  const std::string_view digits = name.substr(dot + 1);
  int index = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const bool whole = error == std::errc{} && end == digits.data() + digits.size();
  if (!whole || count < 2 || index < 0 || index >= count) return {};
  return {joint, index};
}

std::string coordinate_name(const Joint& joint, int i) {
  return coordinate_count(joint.type) > 1 ? joint.name + "." + std::to_string(i) : joint.name;
}

double friction_limit(const Friction& friction) {
  if (friction.limit) return *friction.limit;
  return friction.mu.value_or(0) * friction.preload.value_or(0) * friction.radius.value_or(1);
}

double drawn_distance(const std::array<Vec3, 2>& points) {
  return (points[1] - points[0]).norm();
}

double drawn_offset(const Mechanism& mechanism, const Joint& gear) {
  std::array<double, 2> drawn{};
  for (std::size_t end = 0; end < 2; ++end) {
    const auto [joint, i] = find_coordinate(mechanism, gear.joints[end]);
    if (joint < 0) continue;
    const std::vector<Coordinate>& all = mechanism.joints[static_cast<std::size_t>(joint)].coordinates;
    if (static_cast<std::size_t>(i) < all.size()) drawn[end] = all[static_cast<std::size_t>(i)].drawn;
  }
  const double ratio = gear_ratio(gear);
  return std::isfinite(ratio) ? drawn[1] - ratio * drawn[0] : drawn[1]; // a mistake of the radii alone
}

} // namespace flyball
