// What a solution tells beside its unknowns: coordinates of joints that close loops, points, what drives and
// gears bear, and which reactions are the only ones possible.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/sweep.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// A block on springs between points, held by one joint as well: alone, or closing a loop with a free joint.
Mechanism block_on(Joint j, bool closes_loop) {
  Mechanism m;
  m.name = "block";
  m.gravity = {0.3, -0.2, -9.81};
  m.bodies = {body("block", 2, {0.1, 0.05, 0}, {0.02, 0.03, 0.04})};
  if (closes_loop) {
    m.joints.push_back(joint(JointType::free, "float", "ground", "block", {0, 0, 0}));
    j.cut = true;
  }
  m.joints.push_back(j);
  const Vec3 corners[] = {
      {0.2, 0.1, 0.1}, {-0.2, 0.1, 0}, {0, -0.2, 0.1}, {0.05, 0.1, -0.2}, {-0.1, -0.1, 0}};
  for (std::size_t i = 0; i < std::size(corners); ++i) {
    Force f;
    f.name = "spring" + std::to_string(i);
    f.type = ForceType::spring;
    f.bodies = {"ground", "block"};
    f.points = {Vec3(3 * corners[i] + Vec3(0, 0.1, 0.05)), corners[i]};
    f.stiffness = 150 + 40 * static_cast<double>(i);
    m.forces.push_back(f);
  }
  return m;
}

Joint labelled(JointType type, const std::string& parent, const std::string& child) {
  Joint j = joint(type, "j", parent, child, {0.02, -0.03, 0.01}, {0.2, 0.3, 1});
  j.axis2 = {1, 0.1, -0.2};
  for (std::size_t i = 0; i < j.coordinates.size(); ++i)
    j.coordinates[i].drawn = 0.1 * static_cast<double>(i + 1);
  return j;
}

Mechanism slider_crank() {
  Mechanism m;
  m.name = "slider-crank";
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("crank", 1, {0.1, 0.1, 0}, {0.01, 0.01, 0.01}),
              body("rod", 1, {0.4, 0.1, 0}, {0.02, 0.02, 0.02}), body("piston", 2, {0.6, 0, 0})};
  m.joints = {revolute("turn", "ground", "crank", {0, 0, 0}, Vec3::UnitZ()),
              revolute("elbow", "crank", "rod", {0.2, 0.2, 0}, Vec3::UnitZ()),
              revolute("wrist", "rod", "piston", {0.6, 0, 0}, Vec3::UnitZ()),
              prismatic("stroke", "ground", "piston", {0.6, 0, 0}, Vec3::UnitX())};
  m.joints[0] = sprung(m.joints[0], 20);
  m.joints[3].coordinates[0].drawn = 1.5;
  m.joints[3].cut = true;
  return m;
}

// A hub that turns with arms that turn on it, each with drag at its end.
Mechanism dragged_arms(const std::vector<double>& speeds) {
  Mechanism m;
  m.name = "arms";
  m.bodies = {body("hub", 1, {0, 0, 0}, {0.02, 0.03, 0.04})};
  m.joints = {driven(revolute("spin", "ground", "hub", {0, 0, 0}, Vec3::UnitZ()), 2)};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const std::string name = "arm" + std::to_string(i);
    m.bodies.push_back(body(name, 0.5, {0.3, 0, 0}, {0.01, 0.01, 0.02}));
    m.joints.push_back(
        driven(revolute("turn" + std::to_string(i), "hub", name, {0.3, 0, 0}, Vec3::UnitZ()), speeds[i]));
    Force drag;
    drag.name = "drag" + std::to_string(i);
    drag.type = ForceType::drag;
    drag.body = name;
    drag.at = Vec3(0.4, 0, 0);
    drag.linear = 0.3;
    m.forces.push_back(drag);
  }
  return m;
}

// Torques of such an arm's drag on the hub's drive: mean and amplitude, N m.
struct Share {
  double mean, amplitude;
};
Share on_hub(double speed) {
  return {0.3 * (0.09 * 2 + 0.01 * (2 + speed)), std::abs(0.3 * 0.03 * (2 + (2 + speed)))};
}

const DriveTorque& torque(const Solution& s, std::string_view joint) {
  const auto found = std::ranges::find(s.drive_torques, joint, &DriveTorque::joint);
  REQUIRE(found != s.drive_torques.end());
  return *found;
}

const Reaction& reaction(const Solution& s, const std::string& joint) {
  const auto found = std::ranges::find(s.reactions, joint, &Reaction::joint);
  REQUIRE(found != s.reactions.end());
  return *found;
}

} // namespace

TEST_CASE("a joint that closes a loop has the coordinates that it has in the tree") {
  for (JointType type : {JointType::revolute, JointType::prismatic, JointType::cylindrical,
                         JointType::universal, JointType::spherical, JointType::planar})
    for (bool child : {true, false}) {
      INFO(type_name(type) << ", block is child " << child);
      const Joint j = labelled(type, child ? "ground" : "block", child ? "block" : "ground");
      const Solution tree = solve(block_on(j, false)), loop = solve(block_on(j, true));
      REQUIRE(tree.status == Status::converged);
      REQUIRE(loop.status == Status::converged);
      for (int i = 0; i < coordinate_count(type); ++i) {
        const CoordinateSolution &a = coordinate(tree, "j", i), &b = coordinate(loop, "j", i);
        CAPTURE(i, a.value, b.value, a.error, b.error);
        CHECK_FALSE(a.dependent);
        CHECK(b.dependent);
        CHECK(b.angle == is_angle(type, i));
        CHECK(std::abs(a.value - b.value) <= 4 * a.error + b.error);
        CHECK(std::abs(a.value - b.value) < 1e-13);
        CHECK(b.error < 1e-12);
        CHECK(std::abs(b.value - j.coordinates[static_cast<std::size_t>(i)].drawn) > 1e-3);
      }
    }
}

TEST_CASE("the piston of a slider-crank has a stroke, in branches and sweeps as well, that starts nothing") {
  const Mechanism m = slider_crank();
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  const double turn = value(s, "turn");
  const Eigen::Vector2d elbow = Eigen::Rotation2Dd(turn) * Eigen::Vector2d(0.2, 0.2);
  const double length = std::sqrt(0.16 + 0.04);
  const double x = elbow.x() + std::sqrt(length * length - elbow.y() * elbow.y());
  CHECK(std::abs(value(s, "stroke") - (1.5 + x - 0.6)) < 1e-14);
  CHECK(s.coordinates.back().joint == "stroke");
  for (const auto& [name, value] : start_values(s.coordinates))
    CHECK(name != "stroke");
  CHECK_THROWS_AS(solve(m, from("stroke", 1.4)), SceneError);
  CHECK(Analysis(m).summary().coordinates.back().value == 1.5);

  const ResponseDiagram d = follow_branches(m, "joints.turn.spring.stiffness", 20, 40);
  REQUIRE_FALSE(d.branches.empty());
  for (const ResponsePoint& p : d.branches.front().points) {
    REQUIRE(p.coordinates.size() == 4);
    CHECK(p.coordinates.back().joint == "stroke");
  }
  CHECK(d.branches.front().points.back().coordinates.back().value !=
        d.branches.front().points.front().coordinates.back().value);
  const Variation stiffness{"joints.turn.spring.stiffness", 20, 40, 3};
  for (const SweepPoint& p : sweep(m, std::span(&stiffness, 1)))
    CHECK(p.solution.coordinates.size() == 4);
}

TEST_CASE("what is driven does not depend on the speed") {
  for (const double speed : {0., 1e-9, 20.}) {
    Mechanism m = shipped("governor_bearing");
    set_parameter(m, "joints.spin.drive.speed", speed);
    std::vector<std::string> driven;
    for (const CoordinateSolution& c : solve(m).coordinates)
      if (c.driven) driven.push_back(coordinate_label(c.joint, c.index, c.count));
    CAPTURE(speed);
    CHECK(driven == std::vector<std::string>{"spin", "bearing"});
  }
}

TEST_CASE("points move as the drives carry them") {
  Mechanism m = dragged_arms({5});
  SolveOptions options;
  options.points = {{"hub"}, {"hub", Vec3(0.5, 0.1, 0.2)}, {"arm0", Vec3(0.4, 0, 0)}};
  const Solution s = solve(m, options);
  REQUIRE(s.points.size() == 3);
  CHECK(s.points[0].motion.velocity.norm() < 1e-15);
  const PointMotion& rim = s.points[1].motion;
  CHECK((rim.position - Vec3(0.5, 0.1, 0.2)).norm() < 1e-15);
  CHECK((rim.velocity - Vec3(-0.2, 1, 0)).norm() < 1e-14);
  CHECK((rim.acceleration - Vec3(-2, -0.4, 0)).norm() < 1e-14);
  const PointMotion& end = s.points[2].motion; // 2 rad/s about the origin, 7 rad/s about (0.3, 0, 0)
  CHECK((end.velocity - Vec3(0, 0.6 + 0.7, 0)).norm() < 1e-14);
  CHECK((end.acceleration - Vec3(-4 * 0.3 - 49 * 0.1, 0, 0)).norm() < 1e-13);
  REQUIRE(s.centres.size() == 2);
  CHECK((s.centres[1].velocity - Vec3(0, 0.6, 0)).norm() < 1e-14);
  options.points = {{"nobody"}};
  CHECK_THROWS_AS(solve(m, options), SceneError);
  // A weight at rest is not accelerated.
  Mechanism still = slider_crank();
  options.points = {{"piston"}};
  CHECK(solve(still, options).points[0].motion.acceleration.norm() == 0);
}

TEST_CASE("drive torques that vary have their mean and range over all phases") {
  SECTION("speeds with a common period") {
    const Solution s = solve(dragged_arms({5}));
    const DriveTorque& t = torque(s, "spin");
    const Share share = on_hub(5);
    CHECK(t.varying);
    REQUIRE(t.range);
    CHECK(std::abs(t.range->mean - share.mean) < 1e-14);
    CHECK(std::abs(t.range->most - share.mean - share.amplitude) < 1e-13);
    CHECK(std::abs(t.range->least - share.mean + share.amplitude) < 1e-13);
    CHECK(std::abs(t.value - share.mean - share.amplitude) < 1e-14);
  }
  SECTION("speeds without one: the extremes of both arms come together sooner or later") {
    const double fast = 3 * std::numbers::sqrt2;
    const Solution s = solve(dragged_arms({5, fast}));
    const DriveTorque& t = torque(s, "spin");
    const Share a = on_hub(5), b = on_hub(fast);
    REQUIRE(t.range);
    CHECK(std::abs(t.range->mean - a.mean - b.mean) < 1e-13);
    CHECK(std::abs(t.range->most - a.mean - b.mean - a.amplitude - b.amplitude) < 1e-12);
    CHECK(std::abs(t.range->least - a.mean - b.mean + a.amplitude + b.amplitude) < 1e-12);
  }
  SECTION("of 123 peaks nearly alike the highest") {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("a", 1, {0.1, 0, 0}), body("b", 1, {0.3, 0, 0})};
    m.joints = {driven(revolute("p", "ground", "a", Vec3::Zero()), 5),
                driven(revolute("q", "a", "b", {0.2, 0, 0}), 7.3)};
    const auto closed = [](double t) { // of p
      return standard_gravity * (0.3 * std::cos(5 * t) + 0.1 * std::cos(12.3 * t)) -
             0.02 * std::sin(7.3 * t) * (7.3 * 7.3 + 2 * 5 * 7.3);
    };
    double least = 0, most = 0;
    for (double t = 0; t < 20 * std::numbers::pi; t += 2e-4) {
      least = std::min(least, closed(t));
      most = std::max(most, closed(t));
    }
    const Solution s = solve(m);
    const DriveTorque& t = torque(s, "p");
    REQUIRE(t.range);
    CHECK(std::abs(t.range->least - least) < 1e-5);
    CHECK(std::abs(t.range->most - most) < 1e-5);
  }
  SECTION("a slide that never returns has none") {
    Mechanism m = dragged_arms({});
    m.bodies.push_back(body("slider", 1, {0.5, 0, 0}));
    m.joints.push_back(driven(prismatic("out", "hub", "slider", {0.5, 0, 0}, Vec3::UnitX()), 0.1));
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    CHECK(torque(s, "out").varying);
    CHECK_FALSE(torque(s, "out").range);
  }
  SECTION("rounding does not count") {
    Mechanism m;
    m.name = "wheel";
    m.gravity.setZero();
    m.bodies = {body("wheel", 3, {0.1, 0.2, 0}, {0.1, 0.1, 0.2}),
                body("mate", 3, {-0.1, -0.2, 0}, {0.1, 0.1, 0.2})};
    m.joints = {driven(revolute("axle", "ground", "wheel", Vec3::Zero(), Vec3::UnitZ()), 30),
                joint(JointType::fixed, "weld", "wheel", "mate", Vec3::Zero())};
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    CHECK_FALSE(torque(s, "axle").varying);
  }
  SECTION("one that does not vary has none") {
    const Solution s = solve(shipped("governor"));
    REQUIRE_FALSE(s.drive_torques.empty());
    CHECK_FALSE(s.drive_torques[0].varying);
    CHECK_FALSE(s.drive_torques[0].range);
  }
}

TEST_CASE("a gear's share is told, and is part of the reactions of its joints") {
  Mechanism m;
  m.name = "gears";
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {1, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {revolute("ja", "ground", "a", {0, 0, 0}, Vec3::UnitZ()),
              revolute("jb", "ground", "b", {1, 0, 0}, -Vec3::UnitZ()), gear("mesh", "ja", "jb", 3)};
  Force load;
  load.name = "load";
  load.type = ForceType::torque;
  load.body = "b";
  load.vector = {0, 0, -2}; // 2 N m along jb's axis
  m.forces = {load};
  SECTION("between free coordinates") {
    m.joints[0] = sprung(m.joints[0], 50);
    const Solution s = solve(m);
    REQUIRE(s.gears.size() == 1);
    const GearReaction& g = s.gears[0];
    CHECK(g.joint == "mesh");
    CHECK(std::abs(g.b + 2) < 1e-13);
    CHECK(std::abs(g.a - 6) < 1e-13);
    CHECK((g.torque - Vec3(0, 0, 2)).norm() < 1e-13);
    CHECK((reaction(s, "jb").torque - g.torque).norm() < 1e-13);
    CHECK(reaction(s, "ja").torque.norm() < 1e-12); // of the spring and the gear together
    CHECK(std::abs(value(s, "ja") - 6. / 50) < 1e-14);
  }
  SECTION("from a motor, joints turned round in the tree as well") {
    m.joints[0] = driven(m.joints[0], 4);
    m.joints[1].bodies = {"b", "ground"};
    m.joints[1].axis = Vec3::UnitZ();
    const Solution s = solve(m);
    REQUIRE(s.gears.size() == 1);
    CHECK(std::abs(s.gears[0].b + 2) < 1e-13);
    CHECK(std::abs(s.gears[0].a - 6) < 1e-13);
    CHECK(std::abs(torque(s, "ja").value + 6) < 1e-13);
    CHECK((s.gears[0].torque - reaction(s, "jb").torque).norm() < 1e-13);
  }
}

TEST_CASE("only reactions that redundant loops leave open are not unique") {
  Mechanism m;
  m.name = "door";
  m.gravity = {0, 0, -9.81};
  m.bodies = {body("hub", 1, {0, 0, 0}, {0.02, 0.03, 0.04}),
              body("door", 0.5, {0.4, 0, -0.2}, {0.011, 0.012, 0.02}),
              body("arm", 0.5, {-0.4, 0, -0.2}, {0.011, 0.012, 0.02})};
  m.joints = {driven(revolute("spin", "ground", "hub", {0, 0, 0}, Vec3::UnitZ()), 6),
              revolute("upper", "hub", "door", {0.2, -0.1, 0}, Vec3::UnitY()),
              revolute("lower", "hub", "door", {0.2, 0.1, 0}, Vec3::UnitY()),
              revolute("pend", "hub", "arm", {-0.2, 0, 0}, Vec3::UnitY())};
  m.joints[2].cut = true;
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  CHECK(s.reactions_nonunique);
  CHECK(reaction(s, "upper").nonunique());
  CHECK(reaction(s, "lower").nonunique());
  CHECK_FALSE(reaction(s, "spin").nonunique());
  CHECK_FALSE(reaction(s, "pend").nonunique());
  CHECK_FALSE(torque(s, "spin").nonunique);
  // Both hinges turn alike.
  CHECK(std::abs(value(s, "upper") - value(s, "lower")) < 1e-14);
  for (const Reaction& r : solve(shipped("governor")).reactions)
    CHECK_FALSE(r.nonunique());
}

TEST_CASE("a joint that is there twice holds nothing more", "[loops]") {
  // Oblique hinges and slides, whose rows of the second are zero but for rounding.
  std::mt19937 random(22);
  const auto number = [&] { return uniform(random, -1, 1); };
  for (int i = 0; i < 40; ++i) {
    const Vec3 axis = Vec3(number(), number(), number()).normalized(),
               at = 0.3 * Vec3(number(), number(), number());
    const bool slide = i % 2 == 0;
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("hub", 1, {0, 0, 0}, {0.05, 0.05, 0.05}),
                body("m", 0.6, 0.4 * Vec3(number(), number(), number()), {0.03, 0.05, 0.03})};
    m.joints = {
        driven(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0}), 3.6),
        dampened(joint(slide ? JointType::prismatic : JointType::revolute, "s", "hub", "m", at, axis), 2)};
    m.joints[1].coordinates[0].spring = CoordinateSpring{slide ? 200. : 20., 0.1};
    validate(m);
    const Solution one = Analysis(m).solve();
    m.joints.push_back(joint(m.joints[1].type, "again", "hub", "m", at + 0.1 * axis, axis));
    validate(m);
    const Solution two = Analysis(m).solve();
    INFO(i << ": " << two.message);
    REQUIRE(one.status == Status::converged);
    REQUIRE(two.status == Status::converged);
    CHECK(two.stable == one.stable);
    CHECK(std::abs(value(two, "s") - value(one, "s")) < 1e-12);
    CHECK(std::abs(value(two, "s") - value(one, "s")) < 1e-15 + two.coordinates[1].error);
  }
}

TEST_CASE("a slide that stands at the drawn phase alone is driven") {
  // Crank and rod of one length: the slide is at 2 r cos(angle), which turns back where it is drawn.
  for (const double angle : {0., 0.3}) {
    CAPTURE(angle);
    const Vec3 pin(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0), end(2 * pin.x(), 0, 0);
    Mechanism m;
    m.gravity = Vec3::Zero();
    m.bodies = {body("crank", 1, pin / 2), body("rod", 1, (pin + end) / 2), body("block", 1, end)};
    m.joints = {driven(revolute("turn", "ground", "crank", {0, 0, 0}), 1),
                revolute("pin", "crank", "rod", pin), revolute("end", "rod", "block", end),
                prismatic("slide", "ground", "block", end, Vec3::UnitX())};
    const Solution s = Analysis(m).solve();
    CAPTURE(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(coordinate(s, "slide").driven);
    CHECK_FALSE(coordinate(s, "slide").speed);
  }
}
