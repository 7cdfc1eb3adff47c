// A mechanism as a person builds it: bodies, joints, forces and drives, as plain values.
//
// Everything is given in the world frame at the drawn pose (metres, kilograms, radians, newtons,
// seconds; right-handed). What undo keeps and background work takes is shared as const, not copied.
// Names are the links between parts: a joint names its bodies, a gear its joints.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <compare>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

// The name under which joints and forces refer to the fixed world.
inline constexpr std::string_view ground_name = "ground";

enum class ShapeType { sphere, box, cylinder, capsule };

// A number given by an expression (see expression.hpp) of named parameters and points. `key` tells which: its
// address after the part's name ("position.0"), in a shape "radius" or "from.2". The number itself is kept in
// its place, as evaluate_formulas (formulas.hpp) left it.
struct Formula {
  std::string key;
  std::string text;
  bool operator==(const Formula&) const = default;
};
using Formulas = std::vector<Formula>; // each key once

// A number with a name, used by expressions.
struct NamedParameter {
  std::string name;
  std::string description;
  double value = 0;                           // SI units
  std::string unit;                           // an SI unit: "m", "N/m", "rad", "" of a plain number
  std::optional<std::array<double, 2>> range; // SI units; where a slider goes
  Formulas formulas{};                        // of "value": a dependent parameter
  bool operator==(const NamedParameter&) const = default;
};

// A point of the drawn pose with a name, which parts stand at.
struct NamedPoint {
  std::string name;
  Vec3 at = Vec3::Zero(); // m, world
  Formulas formulas{};    // of "0", "1", "2"
  bool operator==(const NamedPoint&) const = default;
};

// A number that is made of results, by an expression that may ask for them: "y(ball1) - 0.2 m" (see
// result_functions.hpp and measure_plan.hpp).
struct NamedMeasure {
  std::string name;
  std::string description;
  std::string text; // the expression, without its "="
  std::string unit; // an SI unit, as of a parameter
  bool operator==(const NamedMeasure&) const = default;
};

// How a body looks, and with a density what it weighs. World coordinates of the drawn pose.
struct Shape {
  ShapeType type = ShapeType::sphere;
  double radius = 0;                           // m; sphere, cylinder, capsule
  Vec3 size = Vec3::Zero();                    // m; box, full edge lengths along the body axes
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(); // m; cylinder, capsule: ends of the centre line
  std::optional<Vec3> at;                      // m; sphere, box: centre, default the mass centre
  std::optional<std::array<double, 3>> color;  // sRGB, 0 to 1; default from the palette
  std::string description{};
  Formulas formulas{};
  bool operator==(const Shape&) const = default;
};

struct Body {
  std::string name;
  std::string description;
  double mass = 0;                  // kg, zero allowed
  Vec3 position = Vec3::Zero();     // m, mass centre
  std::array<double, 6> inertia{};  // kg m^2: xx yy zz xy xz yz of the tensor itself, body
                                    // axes, about the mass centre
  Quat rotation = Quat::Identity(); // body axes in the drawn pose
  std::vector<Shape> shapes;        // empty: derived from the joints
  std::optional<double> density{};  // kg/m^3; given, mass, position and inertia follow from the shapes
  Formulas formulas{};
  bool operator==(const Body& o) const {
    return name == o.name && description == o.description && mass == o.mass && position == o.position &&
           inertia == o.inertia && rotation.coeffs() == o.rotation.coeffs() && shapes == o.shapes &&
           density == o.density && formulas == o.formulas;
  }
};

enum class JointType {
  revolute,    // axis; [angle]
  prismatic,   // axis; [slide]
  cylindrical, // axis; [angle, slide]
  universal,   // axis on the parent, axis2 on the child; [angle, angle]
  spherical,   // rotation vector
  planar,      // axis the normal, axis2 the in-plane x axis; [x, y, angle]
  free,        // [translation, rotation vector]
  fixed,       // none
  distance,    // points, length; always cut
  gear,        // joints, kind, offset: q_b = ratio q_a + offset; always cut
};

// What a gear is made of, and so what its ratio is given by (see gear_ratio.hpp).
enum class GearKind {
  gear,  // ratio
  belt,  // radii of the wheels a and b, crossed or not
  rack,  // radius of the pinion: a turns, b slides
  screw, // lead: a turns, b slides
};

// Pulls its coordinate back by stiffness times deflection, or by a force (N m or N, against the deflection)
// that is given in its place, mostly as an expression of the deflection, see force_law.hpp.
struct CoordinateSpring {
  double stiffness = 0; // N/m or N m/rad
  double free = 0;      // m or rad, value of the coordinate from which the deflection is counted
  std::string description{};
  std::optional<double> force{};
  bool operator==(const CoordinateSpring&) const = default;
};

// A one-sided spring that acts beyond its limit.
struct Stop {
  std::optional<double> lower, upper; // m or rad
  double stiffness = 0;               // N/m or N m/rad
  std::string description{};
  bool operator==(const Stop&) const = default;
};

// What a drive without a torque keeps, whatever the rest does: its speed, or as a shaft left to itself its
// momentum.
enum class DriveKeeps { speed, momentum };

// Turns or moves at constant speed: a given one, or where a torque is given the one at which this, less the
// load, is what turning takes. Torque and load (N m, or N along a slide; positive along the coordinate, the
// load against it) may be expressions of the state, see drive_law.hpp. Left to itself it has the momentum
// along its coordinate, of all that it carries, that the given speed makes in the drawn pose, and the speed
// is found.
struct Drive {
  double speed = 0; // rad/s or m/s; with a torque where the search for it begins
  std::string description{};
  std::optional<double> torque{}, load{};
  DriveKeeps keeps = DriveKeeps::speed;
  bool operator==(const Drive&) const = default;
};

// Dry friction of one coordinate (Coulomb's): what holds it at rest, up to a limit, and opposes its rate with
// this limit where it slips. The limit is given, or that of a preload: mu times preload, along an angle times
// the radius at which it acts. At rest any force up to it holds, so steady states are many: `share` says at
// which of them the solution stands.
struct Friction {
  std::optional<double> limit{};         // N m or N
  std::optional<double> mu{}, preload{}; // a number; N
  std::optional<double> radius{};        // m
  double share = 0;                      // of the limit, -1 to 1, positive along the coordinate
  std::string description{};
  bool operator==(const Friction&) const = default;
};

// What is known of one coordinate of a joint.
struct Coordinate {
  double drawn = 0; // rad or m: the label of the drawn pose; moves nothing
  std::optional<CoordinateSpring> spring;
  double damping = 0; // N m s/rad or N s/m
  std::optional<Stop> stop;
  std::optional<Friction> friction{};
  std::optional<double> damping_force{}; // N m or N, an expression of the rate in place of `damping`
  std::optional<Drive> drive;
  bool operator==(const Coordinate&) const = default;
};

struct Joint {
  std::string name;
  std::string description;
  JointType type = JointType::revolute;
  std::array<std::string, 2> bodies;   // parent, child; not for gears
  Vec3 at = Vec3::Zero();              // m; not for distance and gear
  Vec3 axis = Vec3::UnitZ();           // any length; by type, see JointType
  Vec3 axis2 = Vec3::UnitX();          // any length; universal and planar
  std::vector<Coordinate> coordinates; // coordinate_count(type) of them
  std::optional<bool> cut;             // true: close a loop here; absent: the program chooses
  std::array<Vec3, 2> points{Vec3::Zero(), Vec3::Zero()}; // m; distance: on the first body, on the second
  std::optional<double> length;                           // m; distance; default the drawn distance
  std::array<std::string, 2> joints; // gear: a, b ("name", or "name.index" where a joint has several)
  std::optional<double> offset;      // gear; default from the drawn values
  GearKind kind = GearKind::gear;
  double ratio = 1;                  // gear of its own kind: q_b = ratio q_a + offset
  std::array<double, 2> radii{1, 1}; // m; belt: of the wheels a and b; rack: the first, below zero on the
                                     // pinion's other side
  bool crossed = false;              // belt: the coordinates turn against each other
  double lead = 0;                   // m a turn; screw, left-handed below zero
  Formulas formulas{};
  bool operator==(const Joint&) const = default;
};

// A vane is a plate or blade in the air, on which the force depends on the direction of the flow (see
// air_force.hpp).
enum class ForceType { spring, force, torque, drag, vane, bearing };
enum class ForceFrame { world, body };

// Stiffness or damping of a bearing by rows, entries of its own axes: 2 x 2 of the shifts along x and y (N/m,
// N s/m), or 6 x 6 of the shifts along x, y and z (the axis) and the components of the rotation vector about
// them (N/m, N, N m/m, N m/rad, each times s for damping); empty: zero. See bearing.hpp.
using BearingMatrix = std::vector<double>;

// A force beside the joints; which fields count depends on the type.
struct Force {
  std::string name;
  std::string description;
  ForceType type = ForceType::spring;
  std::array<std::string, 2> bodies;                      // spring, bearing
  std::array<Vec3, 2> points{Vec3::Zero(), Vec3::Zero()}; // m; spring: on the first body, on the second
  double stiffness = 0;                                   // N/m; spring
  std::optional<double> free_length;                      // m; spring; default the drawn distance
  double damping = 0;                                     // N s/m; spring, along its line
  std::optional<double> force{}, damping_force{}; // N; spring: in place of these, see CoordinateSpring
  std::string body;                               // force, torque, drag, vane
  std::optional<Vec3> at;     // m; force, torque, drag, vane; default the mass centre; bearing, required
  Vec3 vector = Vec3::Zero(); // N or N m; force, torque
  ForceFrame frame = ForceFrame::world; // whether `vector` is in world or in body axes
  double linear = 0;                    // N s/m; drag
  double quadratic = 0;                 // N s^2/m^2; drag
  Vec3 axis = Vec3::UnitZ();            // bearing, any length: of what turns in it
  std::optional<Vec3> x_axis{};         // bearing, any length: x in the plane across, see bearing_axes.hpp
  BearingMatrix bearing_stiffness{}, bearing_damping{};
  double area = 0;             // m^2; vane
  Vec3 normal = Vec3::UnitZ(); // any length, fixed in the body; vane
  std::optional<Vec3> chord;   // any length; vane: a blade along the flow, across which flow does nothing
  double cn = 1.2, cd = 0;     // vane: coefficients of the force along the normal and along the flow
  std::optional<double> lift{}, drag{}; // vane: in place of these its coefficients across and along the flow,
                                        // mostly expressions of the incidence, see force_law.hpp
  Formulas formulas{};
  bool operator==(const Force&) const = default;
};

// The air that drag and vanes are in: at rest in the world, a wind, or turning with a body as if solid.
struct Air {
  double density = 1.225;   // kg/m^3; of vanes
  Vec3 wind = Vec3::Zero(); // m/s, the same everywhere
  std::string turns_with;   // a body; empty: none
  std::string description{};
  bool operator==(const Air&) const = default;
};

enum class SliderScale { linear, log };

struct Slider {
  std::string parameter; // an address, see address.hpp
  double from = 0, to = 1;
  SliderScale scale = SliderScale::linear;
  std::string description;
  bool operator==(const Slider&) const = default;
};

struct Simulation {
  double duration = 10; // s
  bool damped = true;
  std::string description;
  bool operator==(const Simulation&) const = default;
};

// Orbit camera: looks at `target` from `distance`, azimuth about the world's up axis, elevation above
// the horizon. Absent: the whole mechanism in view.
struct Camera {
  Vec3 target = Vec3::Zero(); // m
  double distance = 1;        // m
  double azimuth = 0;         // rad
  double elevation = 0;       // rad
  std::string description{};
  bool operator==(const Camera&) const = default;
};

// How the mechanism is looked at.
struct View {
  std::optional<Camera> camera;
  std::string description;
  bool operator==(const View&) const = default;
};

struct Mechanism {
  std::string name;
  std::string description;
  std::vector<NamedParameter> parameters;
  std::vector<NamedPoint> points;
  Vec3 gravity = Vec3::Zero(); // m/s^2
  Air air;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Force> forces;
  std::vector<NamedMeasure> measures;
  std::vector<Slider> sliders;
  Simulation simulation;
  View view;
  Formulas formulas{}; // of gravity, of the air and of the simulation, by whole addresses
  bool operator==(const Mechanism&) const = default;
};

// Number of coordinates of a joint of this type; zero for fixed, distance and gear.
int coordinate_count(JointType type);
// Whether coordinate `i` of a joint of this type is an angle (rad) rather than a length (m).
bool is_angle(JointType type, int i);
// The word used for a type in scene files and messages.
std::string_view type_name(JointType type);
std::string_view type_name(GearKind kind);
std::string_view type_name(ForceType type);
std::string_view type_name(ShapeType type);
std::string_view type_name(ForceFrame frame);
std::string_view type_name(DriveKeeps keeps);
std::string_view type_name(SliderScale scale);

// Whether what acts does so between two bodies, at `bodies`, rather than on one, at `body`.
bool acts_between(ForceType type);
// Where a bearing's x is, in the plane across its axis: the x_axis, or without one the world axis nearest to
// that plane, the first of several.
Vec3 bearing_x_towards(const Force& bearing);
// 2 or 6: the larger of its matrices.
int bearing_size(const Force& bearing);
// Whether a vane's coefficients are those of lift and drag by its incidence.
bool has_polar(const Force& vane);

// Whether a rack or screw, whose first coordinate is a turn and whose second a slide.
bool turns_into_slide(GearKind kind);
// Whether the air exerts it: drag or a vane.
bool is_of_air(ForceType type);
// Whether the speed is found rather than given: by a torque, or where momentum is kept.
bool finds_speed(const Drive& drive);
// Whether coordinate `i` is a component of a rotation vector, whose rate is no angular velocity and so can
// be neither driven nor geared.
bool is_rotation_vector(JointType type, int i);
// Whether joints of this type have the field `at`, `axis` or `axis2`.
bool has_at(JointType type);
bool has_axis(JointType type);
bool has_axis2(JointType type);

// The most that friction holds, N m or N.
double friction_limit(const Friction& friction);

// Whether a body, joint or force may be called so: not empty, not "ground", without dots (addresses) and
// control characters.
bool is_usable_name(std::string_view name);

// Index in the mechanism's list, or -1; body_index also returns -1 for "ground".
int body_index(const Mechanism& mechanism, std::string_view name);
int joint_index(const Mechanism& mechanism, std::string_view name);
int force_index(const Mechanism& mechanism, std::string_view name);

// The gear's end "name" or "name.index", as a joint's index in the list and a coordinate's index in the
// joint; joint -1 where there is no such coordinate.
struct CoordinateReference {
  int joint = -1;
  int coordinate = 0;

  bool operator==(const CoordinateReference&) const = default;
};
CoordinateReference find_coordinate(const Mechanism& mechanism, std::string_view name);
// "name", or "name.index" where the joint has several coordinates: the inverse of find_coordinate.
std::string coordinate_name(const Joint& joint, int i);

// What an optional field stands for while it is absent: the drawn distance of the points, and for a gear's
// offset q_b - ratio q_a of the drawn values.
double drawn_distance(const std::array<Vec3, 2>& points);
double drawn_offset(const Mechanism& mechanism, const Joint& gear);

} // namespace flyball
