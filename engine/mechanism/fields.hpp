// Every field of every part of a mechanism, listed once: its key in the scene file, what a right value looks
// like, the unit of its numbers and the member that keeps it. The keys of the format, the reader, the writer,
// the addresses and the checks for finite numbers follow from these lists.
//
// `visit_fields(visitor, part)` calls for a part, const or not, in the file's order
//   describe(description)
//   type(field, type)             the word that decides which other keys there are
//   field(field, value)           a value that is written always, or an optional that has no number while
//   absent field(field, value, standard) one that is left out of the file at its standard; of an optional:
//   what it
//                                 stands for while absent
//   pair(field, a, b)             two values in one array
//   coordinates(joint)            of each coordinate the fields listed for one
//   expression(field, text)       always an expression, in the file with "=" before it
//   version(field)                of the format
// The units of forces and joints that depend on other parts, and what absent fields stand for, need the
// mechanism `of` which the part is; without one they are "" and zero.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <concepts>
#include <type_traits>

namespace flyball {

struct Field {
  std::string_view key;
  std::string_view expected; // of a right value, for messages
  std::string_view unit{};   // as shown to a person
  bool required = false;
};

namespace expected {
inline constexpr std::string_view number = "a number", text = "a text", word = "a name",
                                  boolean = "true or false", list = "an array of objects",
                                  object = "an object", point = "three numbers [x, y, z]",
                                  direction = "a direction of three numbers [x, y, z]",
                                  two_bodies = "two names [parent, child]",
                                  named_objects = "an object of objects by name",
                                  named_points = "an object of points by name",
                                  expression = "an expression of results, as \"=x(ball)\"";
inline constexpr std::string_view matrix = "a matrix of two rows of two numbers or of six rows of six";
inline constexpr std::string_view two_points =
    "two points [[x, y, z], [x, y, z]], on the first body and on the second";
} // namespace expected

namespace fields {
inline constexpr bool required = true;
inline constexpr Field name{"name", expected::word, "", required}, type{"type", expected::word, "", required},
    bodies{"bodies", expected::two_bodies, "", required},
    points{"points", expected::two_points, "m", required}, gravity{"gravity", expected::point, "m/s^2"},
    air{"air", expected::object}, simulation{"simulation", expected::object},
    kind{"kind", "gear, belt, rack or screw"}, density{"density", expected::number, "kg/m^3"},
    mass{"mass", expected::number, "kg"}, position{"position", expected::point, "m"},
    inertia{"inertia", "three numbers [xx, yy, zz] or six [xx, yy, zz, xy, xz, yz]", "kg m^2"},
    value{"value", expected::number, "", required}, stiffness{"stiffness", expected::number, "N/m"};

// Of a coordinate's value, of what it takes to move it, and of its rate.
constexpr std::string_view value_unit(bool angle) {
  return angle ? "rad" : "m";
}
constexpr std::string_view stiffness_unit(bool angle) {
  return angle ? "N m/rad" : "N/m";
}
constexpr std::string_view force_unit(bool angle) {
  return angle ? "N m" : "N";
}
constexpr std::string_view damping_unit(bool angle) {
  return angle ? "N m s/rad" : "N s/m";
}
constexpr std::string_view speed_unit(bool angle) {
  return angle ? "rad/s" : "m/s";
}

struct GearUnits {
  std::string_view ratio, offset;
};
GearUnits gear_units(const Mechanism& mechanism, const Joint& gear);
// Of entry (row, column) of a bearing's matrix with `size` rows; `of` is the unit of the first.
std::string_view bearing_unit(std::string_view of, std::size_t size, std::size_t row, std::size_t column);
// Of a body of the mechanism; zero where there is no such body.
Vec3 mass_centre(const Mechanism& mechanism, std::string_view body);
} // namespace fields

// The type of a field's standard beside its value: takes 0, {} and what an optional holds.
template <class Value>
using Standard = std::type_identity_t<std::remove_const_t<Value>>;

template <class Part, class Of>
concept PartOf = std::same_as<std::remove_const_t<Part>, Of>;

template <class Visitor, PartOf<NamedParameter> Part>
void visit_fields(Visitor& v, Part& parameter) {
  v.describe(parameter.description);
  Field value = fields::value;
  value.unit = parameter.unit;
  v.field(value, parameter.value);
  v.field({"unit", "an SI unit, such as m, N/m or rad"}, parameter.unit, {});
  v.field({"range", "two numbers [from, to]"}, parameter.range);
}

template <class Visitor, PartOf<NamedMeasure> Part>
void visit_fields(Visitor& v, Part& measure) {
  v.describe(measure.description);
  v.expression({"value", expected::expression, "", fields::required}, measure.text);
  v.field({"unit", "an SI unit, such as m, N or rad"}, measure.unit, {});
}

template <class Visitor, PartOf<Shape> Part>
void visit_fields(Visitor& v, Part& shape) {
  using fields::required;
  v.type(fields::type, shape.type);
  v.describe(shape.description);
  if (shape.type == ShapeType::box)
    v.field({"size", expected::point, "m", required}, shape.size);
  else
    v.field({"radius", expected::number, "m", required}, shape.radius);
  if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule) {
    v.field({"from", expected::point, "m", required}, shape.from);
    v.field({"to", expected::point, "m", required}, shape.to);
  } else {
    v.field({"at", expected::point, "m"}, shape.at);
  }
  v.field({"color", "three numbers [red, green, blue] from 0 to 1"}, shape.color);
}

template <class Visitor, PartOf<Body> Part>
void visit_fields(Visitor& v, Part& body) {
  v.field(fields::name, body.name);
  v.describe(body.description);
  v.field(fields::density, body.density);
  if (!body.density) { // else they follow from it
    v.field(fields::mass, body.mass);
    v.field(fields::position, body.position);
    v.field(fields::inertia, body.inertia, {});
  }
  v.field({"rotation", "a unit quaternion of four numbers [w, x, y, z]"}, body.rotation, Quat::Identity());
  v.field({"shapes", expected::list}, body.shapes, {});
}

template <class Visitor, PartOf<CoordinateSpring> Part>
void visit_fields(Visitor& v, Part& spring, bool angle = true) {
  v.describe(spring.description);
  v.field({"force", expected::number, fields::force_unit(angle)}, spring.force);
  if (!spring.force) // else it stands for it
    v.field({fields::stiffness.key, expected::number, fields::stiffness_unit(angle)}, spring.stiffness);
  v.field({"free", expected::number, fields::value_unit(angle)}, spring.free, 0);
}

template <class Visitor, PartOf<Stop> Part>
void visit_fields(Visitor& v, Part& stop, bool angle = true) {
  v.describe(stop.description);
  v.field({"lower", expected::number, fields::value_unit(angle)}, stop.lower);
  v.field({"upper", expected::number, fields::value_unit(angle)}, stop.upper);
  v.field({"stiffness", expected::number, fields::stiffness_unit(angle), fields::required}, stop.stiffness);
}

template <class Visitor, PartOf<Friction> Part>
void visit_fields(Visitor& v, Part& friction, bool angle = true) {
  v.describe(friction.description);
  v.field({"limit", expected::number, fields::force_unit(angle)}, friction.limit);
  v.field({"mu", expected::number}, friction.mu);
  v.field({"preload", expected::number, "N"}, friction.preload);
  v.field({"radius", expected::number, "m"}, friction.radius);
  v.field({"share", expected::number}, friction.share, 0);
}

template <class Visitor, PartOf<Drive> Part>
void visit_fields(Visitor& v, Part& drive, bool angle = true) {
  v.describe(drive.description);
  v.field({"torque", expected::number, fields::force_unit(angle)}, drive.torque);
  v.field({"load", expected::number, fields::force_unit(angle)}, drive.load);
  v.field({"keeps", "speed or momentum"}, drive.keeps, DriveKeeps::speed);
  v.field({"speed", expected::number, fields::speed_unit(angle), fields::required}, drive.speed);
}

template <class Visitor, PartOf<Coordinate> Part>
void visit_fields(Visitor& v, Part& coordinate, bool angle = true) {
  v.field({"coordinate", expected::number, fields::value_unit(angle)}, coordinate.drawn, 0);
  v.field({"spring", expected::object}, coordinate.spring);
  v.field({"damping", expected::number, fields::damping_unit(angle)}, coordinate.damping, 0);
  v.field({"damping_force", expected::number, fields::force_unit(angle)}, coordinate.damping_force);
  v.field({"stop", expected::object}, coordinate.stop);
  v.field({"friction", expected::object}, coordinate.friction);
  v.field({"drive", expected::object}, coordinate.drive);
}

template <class Visitor, PartOf<Joint> Part>
void visit_fields(Visitor& v, Part& joint, const Mechanism* of = nullptr) {
  using fields::required;
  v.field(fields::name, joint.name);
  v.describe(joint.description);
  v.type(fields::type, joint.type);
  if (joint.type == JointType::gear) {
    const fields::GearUnits unit = of ? fields::gear_units(*of, joint) : fields::GearUnits{};
    v.field({"joints", "two names [a, b]", "", required}, joint.joints);
    v.field(fields::kind, joint.kind, GearKind::gear);
    switch (joint.kind) {
    case GearKind::gear: v.field({"ratio", expected::number, unit.ratio, required}, joint.ratio); break;
    case GearKind::belt:
      v.pair({"radii", "two numbers, the radii of the wheels a and b", "m", required}, joint.radii[0],
             joint.radii[1]);
      v.field({"crossed", expected::boolean}, joint.crossed, false);
      break;
    case GearKind::rack: v.field({"radius", expected::number, "m", required}, joint.radii[0]); break;
    case GearKind::screw: v.field({"lead", expected::number, "m", required}, joint.lead); break;
    }
    v.field({"offset", expected::number, unit.offset}, joint.offset, of ? drawn_offset(*of, joint) : 0);
  } else {
    v.field(fields::bodies, joint.bodies);
  }
  if (joint.type == JointType::distance) {
    v.field(fields::points, joint.points);
    v.field({"length", expected::number, "m"}, joint.length, drawn_distance(joint.points));
  }
  if (has_at(joint.type)) v.field({"at", expected::point, "m", required}, joint.at);
  if (joint.type == JointType::universal) {
    v.pair({"axes", "two directions [[x, y, z], [x, y, z]], on the parent and on the child", "", required},
           joint.axis, joint.axis2);
  } else {
    if (has_axis(joint.type)) v.field({"axis", expected::direction, "", required}, joint.axis);
    if (has_axis2(joint.type)) v.field({"x_axis", expected::direction, "", required}, joint.axis2);
  }
  if (coordinate_count(joint.type) > 0) v.coordinates(joint);
  v.field({"cut", expected::boolean}, joint.cut);
}

template <class Visitor, PartOf<Force> Part>
void visit_fields(Visitor& v, Part& force, const Mechanism* of = nullptr) {
  using fields::required;
  v.field(fields::name, force.name);
  v.describe(force.description);
  v.type(fields::type, force.type);
  if (force.type == ForceType::spring) {
    v.field(fields::bodies, force.bodies);
    v.field(fields::points, force.points);
    v.field({"force", expected::number, "N"}, force.force);
    if (!force.force) v.field(fields::stiffness, force.stiffness);
    v.field({"free_length", expected::number, "m"}, force.free_length, drawn_distance(force.points));
    v.field({"damping", expected::number, "N s/m"}, force.damping, 0);
    v.field({"damping_force", expected::number, "N"}, force.damping_force);
    return;
  }
  if (force.type == ForceType::bearing) {
    v.field(fields::bodies, force.bodies);
    v.field({"at", expected::point, "m", required}, force.at);
    v.field({"axis", expected::direction, "", required}, force.axis);
    v.field({"x_axis", expected::direction}, force.x_axis, bearing_x_towards(force));
    v.field({"stiffness", expected::matrix, "N/m"}, force.bearing_stiffness, {});
    v.field({"damping", expected::matrix, "N s/m"}, force.bearing_damping, {});
    return;
  }
  v.field({"body", expected::word, "", required}, force.body);
  v.field({"at", expected::point, "m"}, force.at,
          of ? fields::mass_centre(*of, force.body) : Vec3(Vec3::Zero()));
  if (force.type == ForceType::drag) {
    v.field({"linear", expected::number, "N s/m"}, force.linear, 0);
    v.field({"quadratic", expected::number, "N s^2/m^2"}, force.quadratic, 0);
  } else if (force.type == ForceType::vane) {
    v.field({"area", expected::number, "m^2", required}, force.area);
    v.field({"normal", expected::direction, "", required}, force.normal);
    v.field({"chord", expected::direction}, force.chord);
    v.field({"lift", expected::number}, force.lift);
    v.field({"drag", expected::number}, force.drag);
    if (has_polar(force)) return; // it stands for them
    v.field({"cn", expected::number}, force.cn, Force().cn);
    v.field({"cd", expected::number}, force.cd, 0);
  } else {
    v.field({"vector", expected::point, force.type == ForceType::torque ? "N m" : "N", required},
            force.vector);
    v.field({"frame", "world or body"}, force.frame, ForceFrame::world);
  }
}

template <class Visitor, PartOf<Air> Part>
void visit_fields(Visitor& v, Part& air) {
  v.describe(air.description);
  v.field({"density", expected::number, "kg/m^3"}, air.density, Air().density);
  v.field({"wind", expected::point, "m/s"}, air.wind, Vec3::Zero());
  v.field({"turns_with", expected::word}, air.turns_with, {});
}

template <class Visitor, PartOf<Slider> Part>
void visit_fields(Visitor& v, Part& slider) {
  v.field({"parameter", "the address of a number", "", fields::required}, slider.parameter);
  v.describe(slider.description);
  v.pair({"range", "two numbers [from, to]", "", fields::required}, slider.from, slider.to);
  v.field({"scale", "linear or log"}, slider.scale, SliderScale::linear);
}

template <class Visitor, PartOf<Simulation> Part>
void visit_fields(Visitor& v, Part& simulation) {
  v.describe(simulation.description);
  v.field({"duration", expected::number, "s"}, simulation.duration, Simulation().duration);
  v.field({"damped", expected::boolean}, simulation.damped, Simulation().damped);
}

template <class Visitor, PartOf<Camera> Part>
void visit_fields(Visitor& v, Part& camera) {
  v.describe(camera.description);
  v.field({"target", expected::point, "m"}, camera.target, Vec3::Zero());
  v.field({"distance", expected::number, "m", fields::required}, camera.distance);
  v.field({"azimuth", expected::number, "rad"}, camera.azimuth, 0);
  v.field({"elevation", expected::number, "rad"}, camera.elevation, 0);
}

template <class Visitor, PartOf<View> Part>
void visit_fields(Visitor& v, Part& view) {
  v.describe(view.description);
  v.field({"camera", expected::object}, view.camera);
}

template <class Visitor, PartOf<Mechanism> Part>
void visit_fields(Visitor& v, Part& mechanism) {
  using fields::required;
  v.version({"flyball", "the version of the format, 1 or 2", "", required});
  v.field({"name", expected::text, "", required}, mechanism.name);
  v.describe(mechanism.description);
  v.field({"parameters", expected::named_objects}, mechanism.parameters, {});
  v.field({"points", expected::named_points}, mechanism.points, {});
  v.field(fields::gravity, mechanism.gravity, Vec3::Zero());
  v.field(fields::air, mechanism.air, {});
  v.field({"bodies", expected::list, "", required}, mechanism.bodies);
  v.field({"joints", expected::list, "", required}, mechanism.joints);
  v.field({"forces", expected::list}, mechanism.forces, {});
  v.field({"measures", expected::named_objects}, mechanism.measures, {});
  v.field({"sliders", expected::list}, mechanism.sliders, {});
  v.field(fields::simulation, mechanism.simulation, {});
  v.field({"view", expected::object}, mechanism.view, {});
}

} // namespace flyball
