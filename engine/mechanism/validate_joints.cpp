#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>

namespace flyball {
namespace {

bool coincide(const std::array<Vec3, 2>& points) {
  constexpr double round_off = 1e-14;
  return drawn_distance(points) <= round_off * (points[0].norm() + points[1].norm());
}

// Whether the direction survives being scaled to unit length.
bool has_direction(const Vec3& v) {
  return std::isnormal(v.squaredNorm());
}

bool parallel(const Vec3& a, const Vec3& b) {
  constexpr double tolerance = 1e-9;
  return a.normalized().cross(b.normalized()).norm() <= tolerance;
}

void find_axis_mistakes(const Joint& joint, const std::string& path, Mistakes& mistakes) {
  if (!has_axis(joint.type)) return;
  constexpr const char* expected = "expected a direction, not zero";
  const bool universal = joint.type == JointType::universal;
  mistakes.expect(has_direction(joint.axis), path, universal ? ".axes[0]" : ".axis", expected);
  if (!has_axis2(joint.type)) return;
  mistakes.expect(has_direction(joint.axis2), path, universal ? ".axes[1]" : ".x_axis", expected);
  if (!has_direction(joint.axis) || !has_direction(joint.axis2) || !parallel(joint.axis, joint.axis2)) return;
  if (universal)
    mistakes.add(path + ".axes", "expected two directions that are not parallel");
  else
    mistakes.add(path + ".x_axis", "expected a direction that is not parallel to `axis`, the normal");
}

// Of a drive whose speed is to be found.
void find_torque_mistakes(const Mechanism& mechanism, std::size_t j, std::size_t i, Mistakes& mistakes) {
  const Joint& joint = mechanism.joints[j];
  const Drive& drive = *joint.coordinates[i].drive;
  const std::string path = coordinate_path(mechanism, j, "drive", i);
  const bool momentum = drive.keeps == DriveKeeps::momentum;
  if (!drive.torque)
    mistakes.expect(!drive.load, path + ".load",
                    momentum ? "expected none: nothing acts on what is left to itself"
                             : "expected none, or a torque: at a given speed the drive gives what it takes");
  else
    mistakes.expect(!momentum, path + ".keeps", "expected speed: where a torque acts no momentum is kept");
  if (momentum)
    mistakes.expect(joint.coordinates[i].damping == 0 && !joint.coordinates[i].damping_force,
                    coordinate_path(mechanism, j, "damping", i),
                    "expected zero: where a damper resists the drive no momentum is kept");
  if (finds_speed(drive))
    mistakes.expect(drive.speed != 0 || momentum, path + ".speed",
                    "expected a speed other than zero, at which the search for the steady one begins");
}

// Of names and dimensions in the laws of such drives, in which numbers have no part.
void find_drive_law_mistakes(const Mechanism& mechanism, std::size_t j, Mistakes& mistakes) {
  const Joint& joint = mechanism.joints[j];
  const auto count = static_cast<std::size_t>(coordinate_count(joint.type));
  for (std::size_t i = 0; i < std::min(count, joint.coordinates.size()); ++i) {
    if (!joint.coordinates[i].drive || !finds_speed(*joint.coordinates[i].drive)) continue;
    const bool angle = is_angle(joint.type, static_cast<int>(i));
    for (const char* which : {"torque", "load"}) {
      const Formula* law = drive_law(mechanism, joint, static_cast<int>(i), which);
      try {
        if (law)
          check_drive_law(mechanism, *law, angle, coordinate_path(mechanism, j, "drive", i) + "." + which);
      } catch (const SceneError& error) {
        mistakes.add(error.where(), error.expected());
      }
    }
  }
}

// A force in place of a stiffness or damping is a law; of a spring also a number.
template <class Check>
void find_law_mistakes(const Formula* law, const std::string& path, Mistakes& mistakes, const Check& check) {
  try {
    if (law) check(*law);
  } catch (const SceneError& error) {
    mistakes.add(error.where().empty() ? path : error.where(), error.expected());
  }
}

void find_damper_mistakes(const std::optional<double>& force, const Formula* law, double damping,
                          const std::string& path, const std::string& damping_path, Mistakes& mistakes) {
  if (!force) return;
  if (!law) mistakes.add(path, "expected an expression of the rate, as \"=40 N*tanh(rate/(1 m/s))\"");
  if (damping != 0)
    mistakes.add(damping_path, "expected none beside `damping_force`, which stands in its place");
}

void find_force_law_mistakes(const Mechanism& mechanism, const Joint& joint, std::size_t i,
                             const std::string& spring_path, const std::string& damper_path,
                             const std::string& damping_path, Mistakes& mistakes) {
  const Coordinate& coordinate = joint.coordinates[i];
  const int index = static_cast<int>(i);
  const bool angle = is_angle(joint.type, index);
  if (coordinate.spring && coordinate.spring->force)
    find_law_mistakes(spring_law(joint, index), spring_path, mistakes, [&](const Formula& law) {
      check_spring_law(mechanism, law, angle, spring_path + ".force");
    });
  if (!coordinate.damping_force) return;
  const Formula* law = damper_law(joint, index);
  find_damper_mistakes(coordinate.damping_force, law, coordinate.damping, damper_path, damping_path,
                       mistakes);
  if (is_rotation_vector(joint.type, index))
    return mistakes.add(damper_path, "expected `damping`: the components of a rotation vector have no rates "
                                     "of their own; use revolute joints");
  find_law_mistakes(law, damper_path, mistakes, [&](const Formula& formula) {
    check_damper_law(mechanism, formula, angle, damper_path);
  });
}

// Each coordinate holds by itself, so it must be one that slips by itself.
void find_friction_mistakes(const Joint& joint, std::size_t i, const std::string& path, Mistakes& mistakes) {
  const Friction& friction = *joint.coordinates[i].friction;
  const bool angle = is_angle(joint.type, static_cast<int>(i));
  if (is_rotation_vector(joint.type, static_cast<int>(i)) || joint.type == JointType::free)
    return mistakes.add(path, "expected no friction: the components of a " +
                                  std::string(type_name(joint.type)) +
                                  " joint do not slip one by one; use revolute and prismatic joints");
  if (joint.type == JointType::planar && !angle)
    return mistakes.add(path, "expected no friction: in a plane it acts against the direction of slip, not "
                              "along x and y each; use prismatic joints");
  if (friction.limit)
    mistakes.expect(!friction.mu && !friction.preload && !friction.radius, path,
                    "expected `limit` alone, or `mu` and `preload` in its place");
  else if (!friction.mu || !friction.preload)
    mistakes.add(path, "expected `limit`, or `mu` and `preload`");
  else if (angle != friction.radius.has_value())
    mistakes.add(path + ".radius", angle ? "missing; expected the radius at which friction acts, as it is to "
                                           "give a moment"
                                         : "expected none: along a slide mu times the preload is the force");
  const auto not_negative = [&](const std::optional<double>& value, const char* key) {
    if (value && *value < 0)
      mistakes.add(path + "." + key, "expected zero or more, found " + number_text(*value));
  };
  not_negative(friction.limit, "limit");
  not_negative(friction.mu, "mu");
  not_negative(friction.preload, "preload");
  not_negative(friction.radius, "radius");
  if (std::abs(friction.share) > 1)
    mistakes.add(path + ".share",
                 "expected a part of the limit, -1 to 1, found " + number_text(friction.share));
}

void find_coordinate_mistakes(const Mechanism& mechanism, std::size_t j, std::size_t i, Mistakes& mistakes) {
  const Joint& joint = mechanism.joints[j];
  const Coordinate& coordinate = joint.coordinates[i];
  const auto path = [&](std::string_view key) { return coordinate_path(mechanism, j, key, i); };
  if (coordinate.damping < 0)
    mistakes.add(path("damping"), "expected zero or more, found " + number_text(coordinate.damping));
  find_force_law_mistakes(mechanism, joint, i, path("spring"), path("damping_force"), path("damping"),
                          mistakes);
  if (coordinate.stop) {
    const Stop& stop = *coordinate.stop;
    mistakes.expect(stop.lower || stop.upper, path("stop"), "expected lower, upper or both");
    mistakes.expect(!stop.lower || !stop.upper || *stop.lower <= *stop.upper, path("stop"), ".lower",
                    "expected no more than `upper`");
    if (!(stop.stiffness > 0))
      mistakes.add(path("stop") + ".stiffness",
                   "expected a number above zero, found " + number_text(stop.stiffness));
  }
  if (coordinate.friction) find_friction_mistakes(joint, i, path("friction"), mistakes);
  if (!coordinate.drive) return;
  find_torque_mistakes(mechanism, j, i, mistakes);
  if (is_rotation_vector(joint.type, static_cast<int>(i)))
    mistakes.add(path("drive"),
                 "expected no drive: a rotation vector that changes at a constant rate is no constant "
                 "angular velocity; use revolute joints");
  else if (joint.cut == true)
    mistakes.add(path("drive"),
                 "expected no drive, or `cut` left out: a cut joint has no coordinate to drive");
}

void find_cut_mistakes(const Joint& joint, const std::string& path, Mistakes& mistakes) {
  if (!joint.cut) return;
  const bool always_cut = joint.type == JointType::distance || joint.type == JointType::gear;
  if (always_cut && !*joint.cut)
    mistakes.add(path + ".cut", "expected true, or the key left out: a " +
                                    std::string(type_name(joint.type)) + " joint is always cut");
  if (joint.type == JointType::free && *joint.cut)
    mistakes.add(path + ".cut",
                 "expected false, or the key left out: a free joint holds nothing that could be cut");
}

void find_length_mistakes(const Joint& joint, const std::string& path, Mistakes& mistakes) {
  if (joint.length && !(*joint.length > 0))
    mistakes.add(path + ".length", "expected a number above zero, found " + number_text(*joint.length));
  if (!joint.length && coincide(joint.points))
    mistakes.add(path + ".points", "expected two points apart, or `length` given");
}

// Of what its ratio is given by.
void find_ratio_mistakes(const Joint& gear, const std::string& path, Mistakes& mistakes) {
  constexpr const char* not_zero = "expected a number other than zero";
  switch (gear.kind) {
  case GearKind::gear: return mistakes.expect(gear.ratio != 0, path, ".ratio", not_zero);
  case GearKind::rack: return mistakes.expect(gear.radii[0] != 0, path, ".radius", not_zero);
  case GearKind::screw: return mistakes.expect(gear.lead != 0, path, ".lead", not_zero);
  case GearKind::belt: break;
  }
  for (std::size_t end = 0; end < 2; ++end)
    if (!(gear.radii[end] > 0))
      mistakes.add(path + ".radii[" + std::to_string(end) + "]",
                   "expected a number above zero, found " + number_text(gear.radii[end]));
}

// A belt turns both wheels; racks and screws turn the first coordinate into a slide.
void find_kind_mistakes(const Joint& gear, std::size_t end, bool angle, const std::string& where,
                        Mistakes& mistakes) {
  if (gear.kind == GearKind::gear) return;
  const bool expects_angle = gear.kind == GearKind::belt || end == 0;
  if (angle != expects_angle)
    mistakes.add(where,
                 std::string(expects_angle ? "expected a turn" : "expected a slide") + ", found the " +
                     (angle ? "turn " : "slide ") + gear.joints[end] + ": a " +
                     std::string(type_name(gear.kind)) +
                     (gear.kind == GearKind::belt ? " runs over two wheels"
                                                  : " turns at its first joint and slides at its second"));
}

void find_gear_mistakes(const Mechanism& mechanism, const Joint& gear, const std::string& path,
                        Mistakes& mistakes) {
  for (std::size_t end = 0; end < 2; ++end) {
    const std::string& reference = gear.joints[end];
    const std::string where = path + ".joints[" + std::to_string(end) + "]";
    const std::string name = reference.substr(0, reference.find('.'));
    const int index = joint_index(mechanism, name);
    if (index < 0) {
      std::vector<std::string_view> names;
      for (const Joint& joint : mechanism.joints)
        if (coordinate_count(joint.type) > 0) names.push_back(joint.name);
      mistakes.add(where, "no joint is called \"" + name + "\"" + did_you_mean(name, names) +
                              (names.empty() ? "" : "; expected " + word_list(names)));
      continue;
    }
    const Joint& joint = mechanism.joints[static_cast<std::size_t>(index)];
    const std::string kind = "a " + std::string(type_name(joint.type)) + " joint";
    const int count = coordinate_count(joint.type);
    const CoordinateReference coordinate = find_coordinate(mechanism, reference);
    if (&joint == &gear)
      mistakes.add(where, "expected another joint than the gear itself");
    else if (count == 0)
      mistakes.add(where, "expected a joint with a coordinate; " + kind + " has none");
    else if (coordinate.joint < 0 && count == 1)
      mistakes.add(where, "expected \"" + name + "\": " + kind + " has a single coordinate");
    else if (coordinate.joint < 0)
      mistakes.add(where, "expected one coordinate, \"" + coordinate_name(joint, 0) + "\" to \"" +
                              coordinate_name(joint, count - 1) + "\": " + kind + " has " +
                              std::to_string(count));
    else if (is_rotation_vector(joint.type, coordinate.coordinate))
      mistakes.add(
          where,
          "expected no component of a rotation vector, whose rate is no angular velocity; use revolute "
          "joints");
    else if (joint.cut == true)
      mistakes.add(where, "expected a joint that is not cut; a cut joint has no coordinate");
    else
      find_kind_mistakes(gear, end, is_angle(joint.type, coordinate.coordinate), where, mistakes);
  }
  if (gear.joints[0] == gear.joints[1]) mistakes.add(path + ".joints", "expected two different coordinates");
  find_ratio_mistakes(gear, path, mistakes);
}

} // namespace

void find_mistakes_of_joint(const Mechanism& mechanism, std::size_t j, Mistakes& mistakes) {
  const Joint& joint = mechanism.joints[j];
  const std::string path = joint_path(mechanism, j);
  if (joint.type == JointType::distance) find_length_mistakes(joint, path, mistakes);
  find_axis_mistakes(joint, path, mistakes);
  find_cut_mistakes(joint, path, mistakes);
  const auto count = static_cast<std::size_t>(coordinate_count(joint.type));
  if (joint.coordinates.size() != count)
    mistakes.add(path + ".coordinate", "expected " + std::to_string(count) + " coordinates, found " +
                                           std::to_string(joint.coordinates.size()));
  else
    for (std::size_t i = 0; i < count; ++i)
      find_coordinate_mistakes(mechanism, j, i, mistakes);
}

// A ratio is one of coordinates, and their signs need not be those of the turns in space.
void find_belt_warnings(const Mechanism& mechanism, Mistakes& warnings) {
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& belt = mechanism.joints[j];
    if (belt.type != JointType::gear || belt.kind != GearKind::belt || wheels_turn_alike(mechanism, belt))
      continue;
    const std::string& a = belt.joints[0];
    const std::string& b = belt.joints[1];
    warnings.add(joint_path(mechanism, j),
                 (belt.crossed ? "it is crossed by the coordinates of " : "it ties the coordinates of ") + a +
                     " and " + b + (belt.crossed ? "" : " as an open belt") +
                     ", which grow as their wheels turn against each other in space: there it is " +
                     (belt.crossed ? "an open belt" : "a crossed one") + "; turn one of the axes round");
  }
}

void find_joint_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  const BodyNumbers numbers(mechanism);
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    const std::string path = joint_path(mechanism, j);
    if (joint.type == JointType::gear)
      find_gear_mistakes(mechanism, joint, path, mistakes);
    else
      find_two_body_mistakes(mechanism, numbers, joint.bodies, path, mistakes);
    find_mistakes_of_joint(mechanism, j, mistakes);
    find_drive_law_mistakes(mechanism, j, mistakes);
  }
}

namespace {

void find_bearing_mistakes(const Force& bearing, const std::string& path, Mistakes& mistakes) {
  constexpr const char* direction = "expected a direction, not zero";
  mistakes.expect(has_direction(bearing.axis), path, ".axis", direction);
  if (bearing.x_axis) {
    mistakes.expect(has_direction(*bearing.x_axis), path, ".x_axis", direction);
    if (has_direction(bearing.axis) && has_direction(*bearing.x_axis))
      mistakes.expect(!parallel(bearing.axis, *bearing.x_axis), path, ".x_axis",
                      "expected a direction that is not parallel to `axis`");
  }
  const std::size_t k = bearing.bearing_stiffness.size(), d = bearing.bearing_damping.size();
  if (k == 0 && d == 0) mistakes.add(path, "expected `stiffness`, `damping` or both");
  if (k != 0 && d != 0 && k != d) mistakes.add(path + ".damping", "expected as many rows as `stiffness` has");
}

void find_vane_mistakes(const Mechanism& mechanism, const Force& vane, const std::string& path,
                        Mistakes& mistakes) {
  const auto not_negative = [&](double value, const char* key) {
    if (value < 0) mistakes.add(path + "." + key, "expected zero or more, found " + number_text(value));
  };
  not_negative(vane.area, "area");
  not_negative(vane.cn, "cn");
  not_negative(vane.cd, "cd");
  constexpr const char* expected = "expected a direction, not zero";
  const bool normal = has_direction(vane.normal), chord = !vane.chord || has_direction(*vane.chord);
  mistakes.expect(normal, path, ".normal", expected);
  mistakes.expect(chord, path, ".chord", expected);
  if (vane.chord && normal && chord && parallel(vane.normal, *vane.chord))
    mistakes.add(path + ".chord", "expected a direction that is not parallel to `normal`");
  if (!has_polar(vane)) return;
  mistakes.expect(
      vane.chord.has_value(), path, ".chord",
      "missing; `lift` and `drag` need it, a direction: the incidence is the angle from it to the "
      "flow");
  not_negative(vane.drag.value_or(0), "drag");
  find_law_mistakes(lift_law(vane), path, mistakes,
                    [&](const Formula& law) { check_lift_law(mechanism, law, path + ".lift"); });
  find_law_mistakes(drag_law(vane), path, mistakes,
                    [&](const Formula& law) { check_drag_law(mechanism, law, path + ".drag"); });
}

} // namespace

void find_mistakes_of(const Mechanism& mechanism, const Force& force, const std::string& path,
                      Mistakes& mistakes) {
  if (force.type == ForceType::bearing) return find_bearing_mistakes(force, path, mistakes);
  const auto not_negative = [&](double value, const char* key) {
    if (value < 0) mistakes.add(path + "." + key, "expected zero or more, found " + number_text(value));
  };
  if (force.type == ForceType::spring) {
    if (coincide(force.points) && force.free_length != 0.0)
      mistakes.add(path + ".points",
                   "expected two points apart, or a `free_length` of 0: the spring has no direction");
    not_negative(force.free_length.value_or(0), "free_length");
    not_negative(force.damping, "damping");
    if (force.force && coincide(force.points))
      mistakes.add(path + ".points", "expected two points apart: the force has no direction");
    find_law_mistakes(spring_law(force), path, mistakes,
                      [&](const Formula& law) { check_spring_law(mechanism, law, false, path + ".force"); });
    const Formula* law = damper_law(force);
    find_damper_mistakes(force.damping_force, law, force.damping, path + ".damping_force", path + ".damping",
                         mistakes);
    find_law_mistakes(law, path, mistakes, [&](const Formula& formula) {
      check_damper_law(mechanism, formula, false, path + ".damping_force");
    });
    return;
  }
  if (force.type == ForceType::drag) {
    not_negative(force.linear, "linear");
    not_negative(force.quadratic, "quadratic");
  }
  if (force.type == ForceType::vane) find_vane_mistakes(mechanism, force, path, mistakes);
}

void find_mistakes_of(const Air& air, Mistakes& mistakes) {
  if (air.density < 0)
    mistakes.add("air.density", "expected zero or more, found " + number_text(air.density));
  mistakes.expect(air.turns_with.empty() || air.wind.isZero(0), "air.wind",
                  "expected none: air that turns with a body turns at rest with it");
}

void find_air_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  find_mistakes_of(mechanism.air, mistakes);
  const std::string& body = mechanism.air.turns_with;
  if (body == ground_name)
    mistakes.add("air.turns_with", "expected a body, or the key left out: the air is at rest then");
  else if (!body.empty() && body_index(mechanism, body) < 0)
    add_unknown_body(mechanism, body, false, "air.turns_with", mistakes);
}

void find_force_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  const BodyNumbers numbers(mechanism);
  for (std::size_t i = 0; i < mechanism.forces.size(); ++i) {
    const Force& force = mechanism.forces[i];
    const std::string path = part_path("forces", i, force.name);
    if (acts_between(force.type))
      find_two_body_mistakes(mechanism, numbers, force.bodies, path, mistakes);
    else if (force.body == ground_name)
      mistakes.add(path + ".body", "expected a body; the ground does not move");
    else if (!numbers.has(force.body))
      add_unknown_body(mechanism, force.body, false, path + ".body", mistakes);
    find_mistakes_of(mechanism, force, path, mistakes);
  }
}

} // namespace flyball
