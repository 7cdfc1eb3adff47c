// f_z against derivatives of the extended residual that owe nothing to its formulas, for each type of
// joint and force by itself and for random mechanisms; the matrices of the motion against the reference.
#include "engine/mechanism/address.hpp"
#include "engine/system/air_force.hpp"
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/parts.hpp"

#include <algorithm>
#include <functional>

using namespace flyball;
using namespace flyball::testing;
using reference::Evaluation;
using reference::RandomDrives;
using reference::RandomOptions;

namespace {

// d/dh of f at zero by central differences, extrapolated three times (Richardson): the error is of order h^6.
template <class S, class Function>
Configuration<S> slope(const Function& f) {
  const auto central = [&](S h) -> Configuration<S> { return (f(h) - f(-h)) / (2 * h); };
  const S h = 2e-3;
  const Configuration<S> d1 = central(h), d2 = central(h / 2), d4 = central(h / 4);
  return (16 * (4 * d4 - d2) / 3 - (4 * d2 - d1) / 3) / 15;
}

void check_jacobian(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda, double t) {
  const Linearization l = linearize_at(model, q, lambda, t);
  MatrixR stiffness(model.system.nv, model.system.nv), constraint(model.system.rows, model.system.nv);
  for (int j = 0; j < model.system.nv; ++j) {
    using VectorE = Configuration<Extended>;
    const VectorE column = slope<Extended>([&](Extended h) {
      VectorE moved = q.cast<Extended>();
      retract<Extended>(model.system, h * VectorE::Unit(model.system.nv, j), moved);
      const Point<Extended> p = evaluate_at<Extended>(model, moved, lambda.cast<Extended>(), t);
      VectorE both(model.system.nv + model.system.rows);
      both << p.residual.f, p.residual.phi;
      return both;
    });
    stiffness.col(j) = column.head(model.system.nv).cast<double>().cast<Real>();
    constraint.col(j) = column.tail(model.system.rows).cast<double>().cast<Real>();
  }
  CHECK(largest(MatrixR(l.stiffness.cast<Real>() - stiffness)) < 1e-11 * (1 + largest(stiffness)));
  CHECK(largest(MatrixR(l.constraint.cast<Real>() - constraint)) < 1e-12 * (1 + largest(constraint)));
}

void check_jacobian(Model& model, Dice& dice, double size) {
  for (int pose = 0; pose < 2; ++pose) {
    CAPTURE(pose);
    const Eigen::VectorXd q = model.displaced(dice, size);
    Eigen::VectorXd lambda(model.system.rows);
    for (double& x : lambda)
      x = dice.between(-10, 10);
    model.parameters.speed_scale = pose == 0 ? 1 : 0.7; // as on the way from rest
    check_jacobian(model, q, lambda, dice.between(-2, 2));
  }
  model.parameters.speed_scale = 1;
}

// Every coordinate of the tree driven at the speed it has, `more` of it added: what the reference needs to
// evaluate motions with q_R' != 0.
VectorR balance_in_motion(const Model& model, const Evaluation& still, const ReferenceState& s,
                          const VectorR& more) {
  Mechanism m = model.mechanism;
  for (std::size_t i = 0; i < still.tree.coordinates.size(); ++i) {
    const reference::TreeCoordinate& c = still.tree.coordinates[i];
    m.joints[static_cast<std::size_t>(c.joint)].coordinates[static_cast<std::size_t>(c.index)].drive =
        Drive{static_cast<double>(c.speed + more[static_cast<Eigen::Index>(i)])};
  }
  return reference::evaluate(m, model.cuts, s).balance;
}

struct Motion {
  MatrixR mass, velocity; // by the engine's q_R, twins left out
};

Motion motion_of(const Model& model, const Eigen::VectorXd& q, double t) {
  const ReferenceState s = model.state(q, t);
  const Evaluation e = reference::evaluate(model.mechanism, model.cuts, s);
  const MatrixR map = model.tangents(q, e.tree);
  MatrixR absolute = MatrixR::Zero(e.B.rows(), e.B.rows());
  for (std::size_t b = 0; b < model.mechanism.bodies.size(); ++b) {
    const Body& body = model.mechanism.bodies[b];
    const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
    reference::Mat3R i;
    i << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    const auto row = static_cast<Eigen::Index>(6 * b);
    absolute.block<3, 3>(row, row).diagonal().setConstant(body.mass);
    absolute.block<3, 3>(row + 3, row + 3) = e.bodies[b].rotation * i * e.bodies[b].rotation.transpose();
  }
  const MatrixR b = e.B * map;
  Motion out{b.transpose() * absolute * b, MatrixR(model.system.nv, model.system.nv)};
  for (int j = 0; j < model.system.nv; ++j)
    out.velocity.col(j) = slope<Real>([&](Real h) -> VectorR {
      // The speeds are read as double: take the difference that they really make.
      const VectorR step = map.col(j) * h;
      return map.transpose() * balance_in_motion(model, e, s, step);
    });
  return out;
}

// Quadratic drag has a corner at rest that finite steps see from afar.
Mechanism without_slow_drag(Mechanism m, const Eigen::VectorXd& q, double t) {
  const Model model(m);
  const Point<double> p = evaluate_at<double>(model, q, Eigen::VectorXd::Zero(model.system.rows), t);
  for (std::size_t i = 0; i < model.system.body_forces.size(); ++i) {
    const BodyForceElement& e = model.system.body_forces[i];
    const Vec3 at = p.kinematics.point(e.link, model.parameters.body_forces[i].at);
    if ((p.kinematics.velocity(e.link, at) - m.air.wind).norm() < 0.5)
      m.forces[static_cast<std::size_t>(e.force)].quadratic =
          m.forces[static_cast<std::size_t>(e.force)].area = 0;
  }
  for (std::size_t i = 0; i < model.system.turning_air.size(); ++i) {
    const TurningAirElement& e = model.system.turning_air[i];
    Force& force = m.forces[static_cast<std::size_t>(e.force)];
    if (turning_air_force<double>(e, model.parameters.turning_air[i], p.kinematics).flow.norm() < 0.5)
      force.quadratic = force.area = 0;
  }
  return m;
}

// The part of a joint in the rig below.
enum class Use { tree, reversed, cut };

// Every part in general position: axes and products of inertia that are nothing special, coordinates
// labelled.
Joint slanted(const std::string& name, JointType type, const std::string& a, const std::string& b,
              const Vec3& at) {
  Joint j = test::joint(type, name, a, b, at, {0.3, 1.1, -0.4});
  j.axis2 = {0.8, -0.2, 0.3};
  for (std::size_t i = 0; i < j.coordinates.size(); ++i)
    j.coordinates[i].drawn = 0.2 - 0.15 * static_cast<double>(i);
  return j;
}

Body slanted(const std::string& name, double mass, const Vec3& position) {
  Body b = test::body(name, mass, position);
  b.inertia = {0.05, 0.07, 0.04, 0.01, -0.005, 0.008};
  b.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
  return b;
}

// A table and a sled that move against each other, an arm on a ball joint on the table and a tool on a free
// joint from the sled, or hung on the arm by the joint looked at.
Mechanism rig(JointType type, Use use) {
  Mechanism m;
  m.gravity = {1, -9, 3};
  m.bodies = {slanted("table", 3, {0.1, 0, 0.2}), slanted("sled", 2, {1, 0.3, -0.2}),
              slanted("arm", 1.5, {0.4, 0.5, 0.1}), slanted("tool", 0.8, {0.7, 0.9, 0.2})};
  m.joints = {slanted("turn", JointType::revolute, "ground", "table", {0, 0, 0}),
              slanted("drift", JointType::cylindrical, "ground", "sled", {0.9, 0.2, 0}),
              slanted("shoulder", JointType::spherical, "table", "arm", {0.3, 0.2, 0.1})};
  m.joints[0].coordinates[0].drive = Drive{3};
  m.joints[1].axis = {-1, 0.2, 0.5};
  m.joints[1].coordinates[0].drive = Drive{-2};
  m.joints[1].coordinates[1].drive = Drive{0.4};
  Joint joint = slanted("joint", type, "arm", "tool", {0.5, 0.7, 0.15});
  if (use == Use::reversed) std::swap(joint.bodies[0], joint.bodies[1]);
  if (use == Use::cut) {
    m.joints.push_back(slanted("hold", JointType::free, "sled", "tool", {0.8, 0.6, 0}));
    if (type != JointType::distance && type != JointType::gear) joint.cut = true;
  }
  if (type == JointType::distance) joint.points = {Vec3(0.45, 0.6, 0.1), Vec3(0.7, 0.8, 0.3)};
  m.joints.push_back(joint);
  return m;
}

using Dress = std::function<void(Mechanism&)>;

struct Dressing {
  std::string name;
  Dress dress;
};

// Dampers by laws where coordinates have rates, beside springs by laws or alone.
Dress with_laws(const std::string& name, bool springs) {
  return [name, springs](Mechanism& m) {
    Joint& joint = m.joints[static_cast<std::size_t>(joint_index(m, name))];
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      Coordinate& c = joint.coordinates[i];
      if (springs) {
        c.spring = CoordinateSpring{0, 0.1, "", 0};
        joint.formulas.push_back(
            {coordinate_key(joint, i, "spring") + ".force", "20*sinh(2*deflection) + 9*deflection^3 + 1"});
      }
      if (is_rotation_vector(joint.type, static_cast<int>(i))) continue;
      c.damping_force = 0;
      joint.formulas.push_back({coordinate_key(joint, i, "damping_force"), "2*rate + tanh(3*rate)"});
    }
  };
}

// What acts on the coordinates of a joint.
std::vector<Dressing> dressings(const std::string& name) {
  const auto each = [name](auto act) -> Dress {
    return [name, act](Mechanism& m) {
      Joint& joint = m.joints[static_cast<std::size_t>(joint_index(m, name))];
      for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
        act(joint.coordinates[i], 1 + 0.4 * static_cast<double>(i));
    };
  };
  const auto stop = [](Coordinate& c, double k, double lower, double upper) {
    Stop s;
    s.lower = lower;
    s.upper = upper;
    s.stiffness = 60 * k;
    c.stop = s;
  };
  return {{"bare", [](Mechanism&) {}},
          {"spring", each([](Coordinate& c, double k) {
             c.spring = CoordinateSpring{30 * k, 0.1 * k, ""};
           })},
          {"lower stop", each([stop](Coordinate& c, double k) { stop(c, k, 2, 4); })},
          {"upper stop", each([stop](Coordinate& c, double k) { stop(c, k, -4, -2); })},
          {"idle stop", each([stop](Coordinate& c, double k) { stop(c, k, -4, 4); })},
          {"damper", each([](Coordinate& c, double k) { c.damping = 2 * k; })},
          {"damper's law", with_laws(name, false)},
          {"laws of both", with_laws(name, true)}};
}

Force spring_between(const std::string& a, const std::string& b, const Vec3& on_a, const Vec3& on_b) {
  return test::point_spring("force", a, b, on_a, on_b, 120);
}

Force on_tool(ForceType type, ForceFrame frame) {
  Force f;
  f.name = "force";
  f.type = type;
  f.body = "tool";
  f.at = Vec3(0.9, 1, 0.1);
  f.vector = {4, -3, 2};
  f.frame = frame;
  return f;
}

std::vector<std::pair<std::string, Force>> forces() {
  Force spring = spring_between("arm", "tool", {0.3, 0.6, 0}, {0.8, 0.8, 0.4});
  Force across = spring_between("sled", "arm", {1.1, 0.2, 0}, {0.3, 0.6, 0});
  across.free_length = 0.5;
  Force free_of_length = spring_between("table", "tool", {0, 0.1, 0.3}, {0.8, 0.8, 0.4});
  free_of_length.free_length = 0;
  Force damped = spring_between("sled", "arm", {1.1, 0.2, 0}, {0.3, 0.6, 0});
  damped.damping = 7;
  Force damper = spring_between("tool", "ground", {0.9, 0.8, 0.4}, {0.5, 2, 0});
  damper.stiffness = 0;
  damper.damping = 5;
  Force damped_free = damped;
  damped_free.free_length = 0;
  Force to_ground = spring_between("ground", "tool", {2, 0.3, 0}, {0.8, 0.8, 0.4});
  Force between_drives = spring_between("table", "sled", {0.1, 0.4, 0}, {1.1, 0.2, 0});
  between_drives.damping = 3;
  Force law = across, damper_law = between_drives, both_laws = between_drives;
  for (Force* each : {&law, &both_laws}) {
    each->force = 0;
    each->formulas.push_back({"force", "table(deflection, [-1, -90], [0, 0], [0.4, 20], [1, 90])"});
  }
  both_laws.damping = damper_law.damping = 0;
  for (Force* each : {&damper_law, &both_laws}) {
    each->damping_force = 0;
    each->formulas.push_back({"damping_force", "3*rate + 2*rate^3"});
  }
  Force bearing, full;
  bearing.name = full.name = "force";
  bearing.type = full.type = ForceType::bearing;
  bearing.bodies = {"table", "sled"};
  full.bodies = {"arm", "tool"};
  bearing.at = Vec3(0.6, 0.2, 0.1);
  full.at = Vec3(0.5, 0.8, 0.2);
  bearing.axis = full.axis = Vec3(0.3, 1, -0.4);
  full.x_axis = Vec3(1, 0.2, 0);
  bearing.bearing_stiffness = {200, 90, -70, 120};
  bearing.bearing_damping = {5, 2, -3, 7};
  for (int i = 0; i < 36; ++i) {
    full.bearing_stiffness.push_back(60 * std::sin(1.0 + 2.3 * i) + (i % 7 == 0 ? 150 : 0));
    full.bearing_damping.push_back(3 * std::cos(0.7 * i) + (i % 7 == 0 ? 5 : 0));
  }
  Force full_across = full; // which may resist shifts alone
  full_across.bodies = {"sled", "arm"};
  for (BearingMatrix* each : {&full_across.bearing_stiffness, &full_across.bearing_damping})
    for (std::size_t i = 0; i < 36; ++i)
      if (i % 6 >= 3 || i / 6 >= 3) (*each)[i] = 0;
  Force constant = spring_between("ground", "tool", {2, 0.3, 0}, {0.8, 0.8, 0.4});
  constant.force = 30;
  Force drag = on_tool(ForceType::drag, ForceFrame::world), quadratic = drag, both = drag;
  drag.linear = both.linear = 2;
  quadratic.quadratic = both.quadratic = 1.5;
  return {{"spring", spring},
          {"spring across drives", across},
          {"spring without free length", free_of_length},
          {"spring to ground", to_ground},
          {"spring between drives", between_drives},
          {"damped spring across drives", damped},
          {"damped spring without free length", damped_free},
          {"damper to ground", damper},
          {"spring by a law across drives", law},
          {"damper by a law between drives", damper_law},
          {"spring and damper by laws between drives", both_laws},
          {"spring of constant force", constant},
          {"bearing of two rows between drives", bearing},
          {"bearing of six rows", full},
          {"bearing of six rows between drives", full_across},
          {"world force", on_tool(ForceType::force, ForceFrame::world)},
          {"body force", on_tool(ForceType::force, ForceFrame::body)},
          {"world torque", on_tool(ForceType::torque, ForceFrame::world)},
          {"body torque", on_tool(ForceType::torque, ForceFrame::body)},
          {"linear drag", drag},
          {"quadratic drag", quadratic},
          {"drag", both}};
}

RandomOptions several(std::uint32_t seed) {
  RandomOptions options;
  options.bodies = 1 + static_cast<int>(seed % 6);
  options.loops = static_cast<int>(seed % 3);
  options.drives = seed % 8 == 7 ? RandomDrives::none : RandomDrives::several;
  options.steady = false;
  options.skew_universals = seed % 2 == 0;
  return options;
}

} // namespace

TEST_CASE("the Jacobian is exact for each type of joint") {
  const std::vector<JointType> types{JointType::revolute,  JointType::prismatic, JointType::cylindrical,
                                     JointType::universal, JointType::spherical, JointType::planar,
                                     JointType::free,      JointType::fixed,     JointType::distance};
  for (const JointType type : types)
    for (const Use use : {Use::tree, Use::reversed, Use::cut}) {
      if (type == JointType::distance && use != Use::cut) continue; // always cut
      if (type == JointType::free && use == Use::cut) continue;     // holds nothing
      for (const Dressing& d : dressings("joint")) {
        INFO(type_name(type) << (use == Use::tree       ? ""
                                 : use == Use::reversed ? ", reversed"
                                                        : ", cut")
                             << ", " << d.name);
        Mechanism m = rig(type, use);
        d.dress(m);
        Model model(m);
        REQUIRE(model.system.cuts.empty() == (use != Use::cut));
        const auto joint = std::ranges::find(model.system.tree_joints, "joint", &TreeJoint::name);
        if (use != Use::cut) REQUIRE(joint->reversed == (use == Use::reversed));
        Dice dice(7);
        check_jacobian(model, dice, 0.6);
      }
    }
}

TEST_CASE("the Jacobian is exact for gears between any two axes") {
  for (const std::string a : {"shoulder.0", "joint", "hold.1"})
    for (const auto& [type, b] :
         {std::pair{JointType::revolute, "second"}, {JointType::cylindrical, "second.1"}}) {
      if (a == "shoulder.0") continue; // a rotation vector has no axis
      INFO(a << " to " << b);
      Mechanism m = rig(JointType::revolute, a == "hold.1" ? Use::cut : Use::reversed);
      m.bodies.push_back(slanted("wheel", 0.5, {0.2, 1, 0}));
      m.joints.push_back(slanted("second", type, "wheel", "arm", {0.3, 0.8, 0}));
      Joint gear;
      gear.name = "gear";
      gear.type = JointType::gear;
      gear.joints = {a, b};
      gear.ratio = -1.7;
      m.joints.push_back(gear);
      Model model(m);
      REQUIRE(std::ranges::any_of(model.system.cuts,
                                  [](const CutJoint& c) { return c.type == JointType::gear; }));
      Dice dice(8);
      check_jacobian(model, dice, 0.6);
    }
}

TEST_CASE("the Jacobian is exact for each type of force") {
  for (const JointType type : {JointType::universal, JointType::planar, JointType::free})
    for (const Use use : {Use::tree, Use::reversed, Use::cut})
      for (const auto& [name, force] : forces()) {
        if (type == JointType::free && use == Use::cut) continue;
        if (name == "bearing of six rows" && use == Use::cut) continue; // drives turn its ends then
        INFO(name << ", " << type_name(type) << " " << static_cast<int>(use));
        Mechanism m = rig(type, use);
        m.forces.push_back(force);
        Model model(m);
        Dice dice(9);
        check_jacobian(model, dice, 0.5);
      }
}

TEST_CASE("the Jacobian is exact for drag, plates and blades in all air") {
  Force drag = on_tool(ForceType::drag, ForceFrame::world),
        plate = on_tool(ForceType::vane, ForceFrame::world);
  drag.linear = 2;
  drag.quadratic = 1.5;
  plate.area = 0.8;
  plate.normal = {0.4, -1, 0.3};
  plate.cd = 0.3;
  Force blade = plate;
  blade.chord = Vec3(1, 0.2, -0.5);
  Force airfoil = blade;
  airfoil.lift = airfoil.drag = 0;
  airfoil.formulas = {{"drag", "0.2 + 0.7*sin(incidence)^2 + 0.1*cos(incidence)"},
                      {"lift", "1.4*sin(2*incidence + 0.3) - 0.2*cos(incidence)"}};
  for (const JointType type : {JointType::universal, JointType::planar, JointType::free})
    for (const Use use : {Use::tree, Use::reversed, Use::cut})
      for (const Force& force : {drag, plate, blade, airfoil})
        for (const std::string air : {"at rest", "wind", "table", "sled", "arm", "tool"}) {
          if (type == JointType::free && use == Use::cut) continue;
          INFO((force.chord ? "blade" : type_name(force.type))
               << ", " << air << ", " << type_name(type) << " " << static_cast<int>(use));
          Mechanism m = rig(type, use);
          m.forces.push_back(force);
          if (air == "wind") m.air.wind = {2, -1, 3};
          if (body_index(m, air) >= 0) m.air.turns_with = air;
          Model model(m);
          CHECK(model.system.turning_air.empty() == (air == "at rest" || air == "wind" || air == "tool"));
          Dice dice(9);
          check_jacobian(model, dice, 0.5);
        }
}

TEST_CASE("the Jacobian is exact for random mechanisms with several drives") {
  int drives = 0, twins = 0, dampers = 0, laws = 0;
  for (std::uint32_t seed = 0; seed < 240; ++seed) {
    INFO("seed " << seed);
    RandomOptions options = several(seed);
    options.air = seed % 5 == 4;
    const Mechanism mechanism = reference::random_mechanism(seed, options);
    Model model(seed % 2 == 0 ? mechanism : reference::with_damper_laws(mechanism));
    Dice dice(seed);
    check_jacobian(model, dice, 0.5);
    laws += static_cast<int>(model.system.cut_damper_laws.size());
    drives += model.system.drives.size() > 1;
    twins += model.has_twins();
    dampers += model.has_cut_dampers();
  }
  CHECK(drives > 60);
  CHECK(twins > 40);
  CHECK(dampers > 5);
  CHECK(laws > 5);
}

TEST_CASE("mass and velocity matrices are the reference's") {
  int compared = 0;
  const std::uint32_t seeds = test::few_or_all(75u, 150u);
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    INFO("seed " << seed);
    RandomOptions options = several(seed);
    options.bodies = 1 + static_cast<int>(seed % 5);
    options.air = seed % 5 == 4;
    Mechanism mechanism = reference::random_mechanism(seed, options);
    // A damper in a loop joint acts at the joint, or at its twin: only for closed loops the same (see below).
    for (Joint& joint : mechanism.joints)
      if (joint.name.starts_with("loop"))
        for (Coordinate& c : joint.coordinates)
          c.damping = 0;
    Model model(mechanism);
    if (model.has_twins() && std::ranges::any_of(model.system.tree_joints, [&](const TreeJoint& t) {
          return t.closes_loop &&
                 std::ranges::any_of(mechanism.joints[static_cast<std::size_t>(t.joint)].coordinates,
                                     [](const Coordinate& c) { return c.damping != 0; });
        }))
      continue;
    if (model.has_cut_dampers()) continue;
    Dice dice(seed);
    const Eigen::VectorXd q = model.displaced(dice, 0.6);
    const double t = dice.between(-2, 2);
    model = Model(without_slow_drag(mechanism, q, t));
    const Linearization l = linearize_at(model, q, Eigen::VectorXd::Zero(model.system.rows), t);
    const Motion theirs = motion_of(model, q, t);
    CHECK(largest(MatrixR(l.mass.cast<Real>() - theirs.mass)) < 1e-13 * (1 + largest(theirs.mass)));
    CHECK(largest(MatrixR(l.velocity.cast<Real>() - theirs.velocity)) <
          1e-11 * (1 + largest(theirs.velocity)));
    ++compared;
  }
  CHECK(compared > static_cast<int>(seeds * 100 / 150));
}

TEST_CASE("dampers in loop joints resist the motions that the loops allow") {
  int compared = 0, resisted = 0;
  const std::uint32_t seeds = test::few_or_all(60u, 120u);
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    INFO("seed " << seed);
    RandomOptions options;
    options.bodies = 3 + static_cast<int>(seed % 3);
    options.loops = 1;
    options.parallel_axes = seed % 2 == 0;
    options.loop_types = {JointType::revolute,  JointType::prismatic, JointType::cylindrical,
                          JointType::universal, JointType::spherical, JointType::planar};
    Mechanism mechanism = reference::random_mechanism(seed, options);
    Joint& loop = mechanism.joints.back();
    for (Coordinate& c : loop.coordinates)
      c.damping = 3;
    Model model(mechanism);
    if (model.system.cuts.empty()) continue;
    Dice dice(seed);
    Eigen::VectorXd q = model.displaced(dice, 0.1);
    if (!model.close(q, 0)) q = model.drawn;
    model = Model(without_slow_drag(mechanism, q, 0));
    const Linearization l = linearize_at(model, q, Eigen::VectorXd::Zero(model.system.rows), 0);
    const MatrixR n = null_space(l.constraint.cast<Real>());
    const MatrixR ours = n.transpose() * l.velocity.cast<Real>() * n;
    const MatrixR theirs = n.transpose() * motion_of(model, q, 0).velocity * n;
    CHECK(largest(MatrixR(ours - theirs)) < 1e-10 * (1 + largest(theirs)));
    compared += n.cols() > 0;
    resisted += largest(MatrixR(ours)) > 1e-6;
  }
  CHECK(compared > static_cast<int>(seeds / 3));
  CHECK(resisted > static_cast<int>(seeds / 6));
}

TEST_CASE("without dampers and drag the velocity matrix is gyroscopic") {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    INFO("seed " << seed);
    // About a relative equilibrium of one turning frame inertia forces do no work on small motions.
    RandomOptions options;
    options.conservative = true;
    const Model model(reference::random_mechanism(seed, options));
    Dice dice(seed);
    const Eigen::VectorXd q = model.displaced(dice, 0.6);
    const Linearization l = linearize_at(model, q, Eigen::VectorXd::Zero(model.system.rows), 0);
    const Eigen::MatrixXd symmetric = l.velocity + l.velocity.transpose();
    CHECK(largest(MatrixR(symmetric.cast<Real>())) < 1e-12 * (1 + largest(MatrixR(l.velocity.cast<Real>()))));
  }
}
