// A mechanism compiled for solving: the spanning tree as links, the joints cut to close loops as constraint
// rows, coordinates split into driven (q_D) and free (q_R, eq. 7). It holds what does not change while
// numbers move; the numbers are in Parameters.
//
// Every joint is a chain of links with one axis each (revolute, prismatic) or with a rotation (spherical);
// the links between are massless frames. A link's rotation R is its displacement from the drawn pose, so R =
// I and all axes and offsets are world vectors there. Where the tree runs against a joint's own order its
// chain is reversed with its axes turned round, so that coordinates keep their sign.
#pragma once

#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/division.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

enum class LinkType { fixed, revolute, prismatic, spherical };

struct Link {
  LinkType type = LinkType::fixed;
  int parent = -1;     // link; -1 is ground
  int body = -1;       // of the mechanism, rigidly on this link; -1: a massless frame
  int tree_joint = -1; // in System::tree_joints
  int coordinate = 0;  // of the joint; the first of three for spherical
  bool reversed = false;
  int axis = 0;   // 0: the joint's axis, 1: its second axis, 2: normal x x_axis; 3, 4, 5: world x, y, z
  int q = -1;     // first entry in the configuration (spherical: a quaternion w x y z, four entries)
  int v = -1;     // first entry in q_R as a tangent vector (spherical: three); -1 where driven or fixed
  int drive = -1; // in System::drives; with entries in q and v it is driven by a torque, and they are its
                  // speed (rad/s or m/s), see drive_torque.hpp
  int frame = -1; // link: the nearest driven one from here to the root, itself included; -1: none
  int depth = 0;  // links from here to the root, itself included
  bool mobile = false; // some coordinate of q_R moves it
};

// A joint of the mechanism in the tree, or one made to hold a body on strings and springs.
struct TreeJoint {
  int joint = -1;   // in the mechanism; -1 for an implicit free joint
  std::string name; // "ball.free" for an implicit one
  JointType type = JointType::free;
  int parent_body = -1, child_body = -1; // in the joint's own order; -1 is ground
  int first_link = 0, link_count = 0;    // its chain, from the tree's root outwards
  bool reversed = false;
  bool closes_loop = false; // its child is a massless twin, welded to the real child by constraints
};

// A coordinate at constant speed, by its own motor or through gears from one.
struct DrivenCoordinate {
  int link = 0;
  int motor = 0;          // index in System::drives of the coordinate that has the motor; its own for a motor
  std::vector<int> gears; // gear joints from the motor to here, in order
};

// The torque (or force) or load of a drive: a number, or an expression of the state.
struct DriveLaw {
  struct Input {
    ResultQuantity quantity; // of places and velocities alone
    int coordinate = -1;     // in System::coordinates: whose value or rate it is; -1: it is one of points
    int spring = -1;         // in System::springs: whose points they are
    int bearing = -1;        // in System::bearings: what exerts it
    bool rate() const { return quantity.result == Result::rate; }
    bool operator==(const Input&) const = default;
  };
  std::optional<Expression> expression;
  std::vector<Input> inputs; // by Expression::results()
};

// A drive that gives a torque rather than a speed, or that is left to itself with the momentum it has.
struct DriveTorqueElement {
  int link = 0; // whose coordinate it drives
  DriveLaw torque, load;
  bool keeps_momentum = false; // torque and load are nothing
  bool implied = false;        // no drive: loops or gears make it turn with others (CutChoice::turning)
};

// One coordinate of q_R that takes part in an element, with the end of the element that it moves.
struct SupportColumn {
  int v = 0;
  int link = 0;
  bool second = false; // moves the element's second end
};
using Support = std::vector<SupportColumn>;

// Acts between two bodies, so only coordinates on the tree path between them feel it.
struct PairEnds {
  int a = -1, b = -1; // links; -1 is ground
  Support support;
};

struct PointSpringElement {
  int force = 0; // in the mechanism
  PairEnds ends;
};

// Laws in place of a stiffness and a damping (force_law.hpp); null where a number is the force.
struct ForceLawElement {
  int at = 0;        // link, or entry of System::springs or cut_dampers
  int component = 0; // of a spherical link
  bool has_spring = false, has_damper = false;
  std::shared_ptr<const ForceLaw> spring, damper;
};

// A bearing's matrices, of two rows or six.
struct BearingElement {
  int force = 0; // in the mechanism
  PairEnds ends;
  int size = 2;
  int turning = -1; // link: a drive turns one end against the other there; -1: none does
};

// Of a vane (force_law.hpp); null where a number is the coefficient, or the vane has no polar.
struct PolarElement {
  std::shared_ptr<const ForceLaw> lift, drag;
};

// A force, torque or force of the air on one body.
struct BodyForceElement {
  int force = 0;
  int link = -1;
  PolarElement polar{};
  // Each coordinate of q_R that moves the body feels the same force or torque Q of it wherever they are, so
  // that its potential is -Q q: a torque on what turns about one axis alone, for instance.
  bool constant = false;
};

// A force of the air on a body, in air that turns with another: the first end.
struct TurningAirElement {
  int force = 0;
  PairEnds ends;
  PolarElement polar{};
};

// Damping in a cut joint that slides or turns about `axis` (prismatic, revolute, cylindrical).
struct CutDamperElement {
  int joint = 0;
  int coordinate = 0;
  bool angular = true;
  PairEnds ends;
};

enum class RowType {
  point,     // u_A . (p_B - p_A) = 0
  direction, // u_A . w_B - constant = 0
  distance,  // |p_B - p_A| - length = 0
  gear,      // q_b - ratio q_a - offset = 0
};

struct ConstraintRow {
  RowType type = RowType::point;
  int u = 0,
      w = 0; // of the cut joint's frame vectors: 0 x, 1 y, 2 z (the axis), 3 a universal joint's second axis
};

struct CutJoint {
  int joint = -1;      // in the mechanism
  int tree_joint = -1; // where a twin is welded: its joint in the tree
  JointType type = JointType::fixed;
  PairEnds ends; // empty support for gears
  int first_row = 0;
  std::vector<ConstraintRow> rows;
  int gear_a = -1, gear_b = -1; // entries in the configuration
  int gear_va = -1, gear_vb = -1;
  bool turns = false;    // with the drives, in a steady state (compile_for_drives)
  bool by_rates = false; // all that moves its ends turns at constant rates: closed as drawn, its equations
                         // are those of the rates
};

struct CoordinateInfo {
  int tree_joint = 0;
  int index = 0;
  bool angle = true;
  int link = 0;
};

// A coordinate as results list it: of a joint in the tree, or measured on one that closes a loop, whose
// value follows from the others.
struct ReportedCoordinate {
  std::string joint;
  int index = 0, count = 1; // which of the joint's coordinates
  bool angle = true;
  int coordinate = -1; // in System::coordinates, or
  int cut = -1;        // in System::cuts
};

// How to choose joints to cut where the mechanism does not say.
struct CutChoice {
  std::vector<int> cut; // joints of the mechanism to cut, beyond those marked; empty: by preference
  std::vector<CoordinateReference> turning{}; // turn at constant rates that are found, without a drive
};

// The form of the KKT matrix (kkt/kkt_system.hpp).
enum class KktForm {
  dense,  // as a matrix of all coordinates: the fastest for few of them
  tree,   // along the tree, in proportion to the bodies
  sparse, // as the sparse equations of all bodies and loops
};

struct System {
  std::vector<Link> links; // parents before children
  std::vector<TreeJoint> tree_joints;
  std::vector<int> body_link; // by body of the mechanism
  std::vector<DrivenCoordinate> drives;
  std::vector<CoordinateInfo> coordinates;  // of the tree, in the scene's order, implicit joints last
  std::vector<ReportedCoordinate> reported; // of all joints, in the same order
  std::vector<PointSpringElement> springs;
  std::vector<ForceLawElement> coordinate_laws, spring_laws, cut_damper_laws;
  std::vector<BearingElement> bearings; // which the matrices of all coordinates alone know
  std::vector<BodyForceElement> body_forces;
  std::vector<TurningAirElement> turning_air;
  std::vector<CutDamperElement> cut_dampers;
  std::vector<DriveTorqueElement> torques;
  std::vector<CutJoint> cuts;
  std::vector<int> dropped_gears; // gears between driven coordinates: no equation left
  int nq = 0;                     // entries of a configuration
  int nv = 0;                     // dimension of q_R
  int rows = 0;                   // constraint equations

  // All forces have a potential. Damping where parts do not turn against each other does no harm.
  bool conservative = true;
  // No drive rides on another or on a free coordinate: the inertia forces then have a potential, too (see
  // potential.hpp).
  bool single_drives = true;
  // All forces but what torques of drives do: at given speeds it is conservative.
  bool conservative_at_speeds = true;
  // The same but for drives that keep their momentum, for which Routh's potential takes its place.
  bool conserves = true;
  KktForm kkt_form = KktForm::dense;
  Division division;
};

// What is driven by a torque.
enum class TorqueDriven {
  turns_steadily, // at a constant speed, which is among the unknowns
  moves_freely,   // a coordinate like others, which the torque acts on: for the motion
};

// Compiles. Throws SceneError where a mechanism has no meaning (validate() finds the same and more).
System compile(const Mechanism& mechanism, const CutChoice& choice = {},
               TorqueDriven torque_driven = TorqueDriven::turns_steadily);

// Which coordinate a link's first is.
inline CoordinateReference reference_to(const System& system, const Link& link) {
  return {system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint, link.coordinate};
}
// What it is called (mechanism/text.hpp).
inline std::string coordinate_label(const TreeJoint& joint, int index) {
  return coordinate_label(joint.name, index, coordinate_count(joint.type));
}
inline std::string coordinate_label(const System& system, const Link& link) {
  return coordinate_label(system.tree_joints[static_cast<std::size_t>(link.tree_joint)], link.coordinate);
}

// Whether the link's coordinate turns at a constant speed that is among the unknowns.
inline bool finds_speed(const Link& link) {
  return link.drive >= 0 && link.v >= 0;
}

// Whether a link is `from` or hangs from it.
inline bool hangs_from(const System& system, int link, int from) {
  while (link > from)
    link = system.links[static_cast<std::size_t>(link)].parent;
  return link == from;
}

// No drive rides on a free coordinate: what eliminations take for granted. And there are neither loops nor
// anything between two bodies but tree joints: what that along the tree does.
bool no_drive_rides(const System& system);
bool is_plain_tree(const System& system);
// Speeds that are found can stand as a border of the balance at given speeds (kkt/speeds_kkt.hpp): of plain
// trees with a potential at these, whose torques keep no momentum.
bool speeds_can_border(const System& system);

// The other ways to cut the loops: each joint cut by choice exchanged for a joint of its loop that may be cut
// instead, one at a time.
std::vector<CutChoice> neighbouring_cuts(const Mechanism& mechanism, const System& system);

} // namespace flyball
