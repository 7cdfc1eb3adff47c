#include "engine/mechanism/scene_keys.hpp"

#include <array>

namespace flyball::scene_keys {
namespace {

constexpr bool required = true;

constexpr std::string_view number = "a number";
constexpr std::string_view text = "a text";
constexpr std::string_view word = "a name";
constexpr std::string_view list = "an array of objects";
constexpr std::string_view object = "an object";
constexpr std::string_view point = "three numbers [x, y, z]";
constexpr std::string_view direction = "a direction of three numbers [x, y, z]";
constexpr std::string_view two_bodies = "two names [parent, child]";
constexpr std::string_view two_points =
    "two points [[x, y, z], [x, y, z]], on the first body and on the second";
constexpr std::string_view per_coordinate =
    "one value, or an array with null where nothing acts if the joint has several coordinates";

constexpr Key name_key{"name", word, required};
constexpr Key type_key{"type", word, required};
constexpr Key bodies_key{"bodies", two_bodies, required};
constexpr Key at_key{"at", point, required};
constexpr Key axis_key{"axis", direction, required};
constexpr Key coordinate_key{"coordinate", per_coordinate};
constexpr Key spring_key{"spring", per_coordinate};
constexpr Key damping_key{"damping", per_coordinate};
constexpr Key stop_key{"stop", per_coordinate};
constexpr Key drive_key{"drive", per_coordinate};
constexpr Key cut_key{"cut", "true or false"};
constexpr Key points_key{"points", two_points, required};
constexpr Key stiffness_key{"stiffness", number, required};
constexpr Key body_key{"body", word, required};
constexpr Key vector_key{"vector", point, required};
constexpr Key free_at_key{"at", point};
constexpr Key frame_key{"frame", "world or body"};
constexpr Key color_key{"color", "three numbers [red, green, blue] from 0 to 1"};
constexpr Key radius_key{"radius", number, required};

constexpr std::array scene_table{
    Key{"flyball", "the version of the format, 1", required},
    Key{"name", text, required},
    Key{"gravity", point},
    Key{"bodies", list, required},
    Key{"joints", list, required},
    Key{"forces", list},
    Key{"sliders", list},
    Key{"simulation", object},
    Key{"view", object},
};
constexpr std::array body_table{
    name_key,
    Key{"mass", number, required},
    Key{"position", point, required},
    Key{"inertia", "three numbers [xx, yy, zz] or six [xx, yy, zz, xy, xz, yz]"},
    Key{"rotation", "a unit quaternion of four numbers [w, x, y, z]"},
    Key{"shapes", list},
};
constexpr std::array sphere_table{type_key, radius_key, free_at_key, color_key};
constexpr std::array box_table{type_key, Key{"size", point, required}, free_at_key, color_key};
constexpr std::array rod_table{type_key, radius_key, Key{"from", point, required}, Key{"to", point, required},
                               color_key};

constexpr std::array axis_joint_table{name_key, type_key,       bodies_key, at_key,
                                      axis_key, coordinate_key, spring_key, damping_key,
                                      stop_key, drive_key,      cut_key};
constexpr std::array universal_table{
    name_key,
    type_key,
    bodies_key,
    at_key,
    Key{"axes", "two directions [[x, y, z], [x, y, z]], on the parent and on the child", required},
    coordinate_key,
    spring_key,
    damping_key,
    stop_key,
    drive_key,
    cut_key};
constexpr std::array planar_table{
    name_key,       type_key,   bodies_key,  at_key,   axis_key,  Key{"x_axis", direction, required},
    coordinate_key, spring_key, damping_key, stop_key, drive_key, cut_key};
constexpr std::array axisless_table{name_key,   type_key,    bodies_key, at_key,    coordinate_key,
                                    spring_key, damping_key, stop_key,   drive_key, cut_key};
constexpr std::array fixed_table{name_key, type_key, bodies_key, at_key, cut_key};
constexpr std::array distance_table{name_key, type_key, bodies_key, points_key, Key{"length", number},
                                    cut_key};
constexpr std::array gear_table{name_key,
                                type_key,
                                Key{"joints", "two names [a, b]", required},
                                Key{"ratio", number, required},
                                Key{"offset", number},
                                cut_key};
constexpr std::array spring_table{stiffness_key, Key{"free", number}};
constexpr std::array stop_table{Key{"lower", number}, Key{"upper", number}, stiffness_key};
constexpr std::array drive_table{Key{"speed", number, required}};

constexpr std::array spring_force_table{name_key,
                                        type_key,
                                        bodies_key,
                                        points_key,
                                        stiffness_key,
                                        Key{"free_length", number},
                                        Key{"damping", number}};
constexpr std::array vector_force_table{name_key, type_key, body_key, free_at_key, vector_key, frame_key};
constexpr std::array drag_table{
    name_key, type_key, body_key, free_at_key, Key{"linear", number}, Key{"quadratic", number}};

constexpr std::array slider_table{Key{"parameter", "the address of a number", required},
                                  Key{"range", "two numbers [from, to]", required},
                                  Key{"scale", "linear or log"}};
constexpr std::array simulation_table{Key{"duration", number}, Key{"damped", "true or false"}};
constexpr std::array view_table{Key{"camera", object}};
constexpr std::array camera_table{Key{"target", point}, Key{"distance", number, required},
                                  Key{"azimuth", number}, Key{"elevation", number}};

// The names of all N values of an enumeration.
template <class Type, std::size_t N>
std::span<const std::string_view> words() {
  static const std::array<std::string_view, N> names = [] {
    std::array<std::string_view, N> all{};
    for (std::size_t i = 0; i < N; ++i)
      all[i] = type_name(static_cast<Type>(i));
    return all;
  }();
  return names;
}

} // namespace

Keys scene() {
  return scene_table;
}
Keys body() {
  return body_table;
}
Keys spring() {
  return spring_table;
}
Keys stop() {
  return stop_table;
}
Keys drive() {
  return drive_table;
}
Keys slider() {
  return slider_table;
}
Keys simulation() {
  return simulation_table;
}
Keys view() {
  return view_table;
}
Keys camera() {
  return camera_table;
}

Keys shape(ShapeType type) {
  switch (type) {
  case ShapeType::sphere: return sphere_table;
  case ShapeType::box: return box_table;
  case ShapeType::cylinder:
  case ShapeType::capsule: return rod_table;
  }
  return {};
}

Keys joint(JointType type) {
  switch (type) {
  case JointType::revolute:
  case JointType::prismatic:
  case JointType::cylindrical: return axis_joint_table;
  case JointType::universal: return universal_table;
  case JointType::planar: return planar_table;
  case JointType::spherical:
  case JointType::free: return axisless_table;
  case JointType::fixed: return fixed_table;
  case JointType::distance: return distance_table;
  case JointType::gear: return gear_table;
  }
  return {};
}

Keys force(ForceType type) {
  switch (type) {
  case ForceType::spring: return spring_force_table;
  case ForceType::force:
  case ForceType::torque: return vector_force_table;
  case ForceType::drag: return drag_table;
  }
  return {};
}

std::span<const std::string_view> joint_types() {
  return words<JointType, 10>();
}
std::span<const std::string_view> force_types() {
  return words<ForceType, 4>();
}
std::span<const std::string_view> shape_types() {
  return words<ShapeType, 4>();
}
std::span<const std::string_view> force_frames() {
  return words<ForceFrame, 2>();
}
std::span<const std::string_view> slider_scales() {
  return words<SliderScale, 2>();
}

} // namespace flyball::scene_keys
