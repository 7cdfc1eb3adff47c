// When there is a steady state, when there is none, and what the messages blame.
#include "engine/mechanism/text.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// A pendulum on a spindle whose axis leans from the vertical by `tilt`.
Mechanism tilted(double tilt, double speed) {
  Mechanism m = conical(0.5, 0.2, speed, 0.2);
  m.gravity = standard_gravity * Vec3(0, -std::cos(tilt), std::sin(tilt));
  return m;
}

// Crank about z, rod, slider along x; drawn at a crank angle of one radian.
Mechanism slider_crank(bool drive_crank) {
  const double crank = 0.1, rod = 0.3, angle = 1;
  const Vec3 pin(crank * std::cos(angle), crank * std::sin(angle), 0);
  const Vec3 end(pin.x() + std::sqrt(rod * rod - pin.y() * pin.y()), 0, 0);
  Mechanism m;
  m.bodies = {body("crank", 1, pin / 2, {0.001, 0.001, 0.001}),
              body("rod", 1, (pin + end) / 2, {0.001, 0.001, 0.001}), body("slider", 1, end)};
  m.joints = {revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}),
              revolute("pin", "crank", "rod", pin, {0, 0, 1}),
              revolute("wrist", "rod", "slider", end, {0, 0, 1}),
              sprung(prismatic("slide", "ground", "slider", end, {1, 0, 0}), drive_crank ? 1e-3 : 50)};
  if (drive_crank) m.joints[0].coordinates[0].drive = Drive{3};
  return m;
}

Mechanism gyro(double turn, double rotor_speed, const Vec3& rotor_inertia) {
  Mechanism m;
  m.bodies = {spindle(), body("gimbal", 0.1, {0, 0, 0}, {0.001, 0.001, 0.001}),
              body("rotor", 0.5, {0, 0, 0}, rotor_inertia)};
  m.joints = {spin(turn), sprung(revolute("tilt", "spindle", "gimbal", {0, 0, 0}, {0, 0, 1}), 2),
              driven(revolute("rotor", "gimbal", "rotor", {0, 0, 0}, {1, 0, 0}), rotor_speed)};
  return m;
}

Mechanism four_bar(double second_link_offset = 0) {
  // A parallel-axis loop closed by a spatial revolute: five equations, of which the plane needs two.
  const Vec3 a(0, 0, 0), b(0, 0.2, 0), c(0.3, 0.25, 0), d(0.3, 0, 0);
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("crank", 0.2, (a + b) / 2, {1e-3, 1e-4, 1e-3}),
              body("coupler", 0.3, (b + c) / 2, {1e-4, 1e-3, 1e-3}),
              body("rocker", 0.25, (c + d) / 2, {1e-3, 1e-4, 1e-3})};
  m.joints = {sprung(revolute("crank", "ground", "crank", a, {0, 0, 1}), 5, 0.3),
              revolute("knee", "crank", "coupler", b, {0, 0, 1}),
              revolute("wrist", "coupler", "rocker", c + Vec3(second_link_offset, 0, 0), {0, 0, 1}),
              revolute("rocker", "ground", "rocker", d, {0, 0, 1})};
  return m;
}

// A shaft about the vertical at 10 rad/s carries a sprung slide, which another at `second` rad/s holds by a
// spring drawn along the slide.
Mechanism two_shafts(double second) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("a", 1, Vec3::Zero(), {0.01, 0.01, 0.01}), body("b", 1, Vec3::Zero(), {0.01, 0.01, 0.01}),
              body("block", 0.5, {0.1, 0, 0})};
  m.joints = {driven(revolute("a", "ground", "a", Vec3::Zero(), Vec3::UnitY()), 10),
              driven(revolute("b", "ground", "b", Vec3::Zero(), Vec3::UnitY()), second),
              sprung(prismatic("slide", "a", "block", {0.1, 0, 0}, Vec3::UnitX()), 500)};
  m.forces = {point_spring("tie", "block", "b", {0.1, 0, 0}, {0.3, 0, 0}, 100, 0.)};
  return m;
}

Joint rotor(const std::string& name, double x, double speed) {
  return driven(revolute(name, "ground", name, {x, 0, 0}, Vec3::UnitX()), speed);
}

} // namespace

TEST_CASE("what takes hours to come round is looked at") {
  // The force along the slide is k (R cos d - r), d the angle between the shafts.
  for (const double second : {10.00003, 10.0001, 9.99, 20.00001, 7.3, -10.}) {
    const Solution s = solve(two_shafts(second));
    CAPTURE(second, s.message);
    CHECK(s.status == Status::no_steady_state);
    CHECK_THAT(s.message, ContainsSubstring("tie"));
  }
  const Solution together = solve(two_shafts(10));
  REQUIRE(together.status == Status::converged);
  CHECK(stable(together));
  // Without the tie any speeds do, and rounding of angles after so many turns adds nothing to the error.
  for (const double second : {10.00003, 20.00001}) {
    Mechanism apart = two_shafts(second);
    apart.forces.clear();
    const Solution s = solve(apart);
    CAPTURE(second, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stability_reason == StabilityReason::minimum);
    CHECK(s.coordinates.back().error < 1e-14);
  }
}

TEST_CASE("the slowest of many drives is looked at") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  for (int i = 0; i < 4; ++i) {
    const std::string name = "rotor" + std::to_string(i);
    m.bodies.push_back(body(name, 1, {0.1 * i, 0, 0}, {0.01, 0.01, 0.01}));
    m.joints.push_back(rotor(name, 0.1 * i, 100 * (i + 1)));
  }
  m.bodies.push_back(body("shaft", 1, {1, 0, 0}, {0.01, 0.01, 0.01}));
  m.bodies.push_back(body("block", 1, {1, 0.1, 0}));
  m.joints.push_back(rotor("shaft", 1, 1e-3));
  m.joints.push_back(sprung(prismatic("slide", "shaft", "block", {1, 0.1, 0}, Vec3::UnitY()), 500));
  const Solution s = solve(m);
  INFO(s.message);
  CHECK(s.status == Status::no_steady_state);
  CHECK_THAT(s.message, ContainsSubstring("the weight of block"));
  m.gravity = {0, 0, 0};
  CHECK(solve(m).status == Status::converged);
}

TEST_CASE("weight that turns with the drive leaves no steady state") {
  for (const double tilt : {1e-3, 0.1, 1.5}) {
    const Solution s = solve(tilted(tilt, 5));
    CAPTURE(tilt, s.message);
    CHECK(s.status == Status::no_steady_state);
    CHECK_THAT(s.message, ContainsSubstring("the weight of bob"));
    CHECK(s.coordinates.empty());
    CHECK_FALSE(s.stable.has_value());
  }
  // Tilted in the hinge's own plane the balance does not change to first order at the drawn phase.
  Mechanism m = tilted(0, 5);
  m.gravity = standard_gravity * Vec3(std::sin(0.2), -std::cos(0.2), 0);
  CHECK(solve(m).status == Status::no_steady_state);
  // Not turning, any tilt will do.
  CHECK(solve(tilted(0.4, 0)).status == Status::converged);
}

TEST_CASE("a slider-crank driven at its crank has no steady state") {
  const Solution s = solve(slider_crank(true));
  INFO(s.message);
  CHECK(s.status == Status::no_steady_state);
  const bool named = s.message.find("\"pin\"") != std::string::npos ||
                     s.message.find("\"wrist\"") != std::string::npos ||
                     s.message.find("\"slide\"") != std::string::npos;
  CHECK(named);
  // Standing, it settles like any other.
  CHECK(solve(slider_crank(false)).status == Status::converged);
}

TEST_CASE("a rotor must be symmetric to spin on a turning frame") {
  const Solution steady = solve(gyro(0.6, 100, {0.002, 0.001, 0.001}));
  CHECK(steady.status == Status::converged);
  CHECK(stable(steady));
  const Solution unsteady = solve(gyro(0.6, 100, {0.002, 0.001, 0.0012}));
  INFO(unsteady.message);
  CHECK(unsteady.status == Status::no_steady_state);
  CHECK_THAT(unsteady.message, ContainsSubstring("the inertia of rotor"));
}

TEST_CASE("forces held by the world on a turning body leave no steady state") {
  Mechanism m = conical(0.5, 0.1, 5, 0.2);
  Force push;
  push.name = "push";
  push.type = ForceType::force;
  push.body = "bob";
  push.vector = {0.5, 0, 0};
  m.forces = {push};
  const Solution s = solve(m);
  INFO(s.message);
  CHECK(s.status == Status::no_steady_state);
  CHECK_THAT(s.message, ContainsSubstring("push"));
  // Turning with the body, or along the spin axis, it does no harm.
  m.forces[0].frame = ForceFrame::body;
  CHECK(solve(m).status == Status::converged);
  m.forces[0].frame = ForceFrame::world;
  m.forces[0].vector = {0, 0.5, 0};
  CHECK(solve(m).status == Status::converged);
}

TEST_CASE("a spring from a turning body to the ground must end on the axis") {
  Mechanism m = conical(0.5, 0.1, 5, 0.2);
  Force spring;
  spring.name = "tether";
  spring.type = ForceType::spring;
  spring.bodies = {"ground", "bob"};
  spring.points = {Vec3(0.4, -0.2, 0), m.bodies[1].position};
  spring.stiffness = 30;
  m.forces = {spring};
  const Solution s = solve(m);
  INFO(s.message);
  CHECK(s.status == Status::no_steady_state);
  CHECK_THAT(s.message, ContainsSubstring("tether"));
  m.forces[0].points[0] = {0, -0.9, 0};
  CHECK(solve(m).status == Status::converged);
}

TEST_CASE("drives at rest and drives along gravity are steady") {
  SECTION("several drives at rest") {
    const Solution s = solve(gyro(0, 0, {0.002, 0.001, 0.0012}));
    CHECK(s.status == Status::converged);
    check_value(s, "tilt", 0);
  }
  SECTION("one of two at rest, any rotor") {
    CHECK(solve(gyro(0.6, 0, {0.002, 0.001, 0.0012})).status == Status::converged);
  }
  SECTION("a lift with a pendulum") {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("cage", 1, {0, 0, 0}), body("bob", 1, {0.3, -0.4, 0})};
    m.joints = {driven(prismatic("lift", "ground", "cage", {0, 0, 0}, {0, 1, 0}), 2),
                revolute("swing", "cage", "bob", {0, 0, 0}, {0, 0, 1})};
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    check_value(s, "swing", -std::atan2(0.3L, 0.4L));
    CHECK(stable(s));
  }
  SECTION("a screw along gravity") {
    Mechanism m = conical(0.5, 0.1, 5, 0.2);
    m.joints[0].type = JointType::cylindrical;
    m.joints[0].coordinates.resize(2);
    m.joints[0].coordinates[1].drive = Drive{0.3};
    const Solution a = solve(m), b = solve(conical(0.5, 0.1, 5, 0.2));
    REQUIRE(a.status == Status::converged);
    CHECK(std::abs(value(a, "swing") - value(b, "swing")) < 1e-14);
  }
}

TEST_CASE("a joint that has to turn at a constant rate is cut, and a note says so") {
  const Analysis analysis(shipped("governor_bearing"));
  const SystemSummary summary = analysis.summary();
  CHECK(std::ranges::find(summary.cut_joints, "bearing") != summary.cut_joints.end());
  const bool told = std::ranges::any_of(
      summary.notes, [](const std::string& note) { return note.find("bearing") != std::string::npos; });
  CHECK(told);
  const Solution s = solve(shipped("governor_bearing"));
  CHECK(s.status == Status::converged);
  CHECK(stable(s));
  // A damper would keep it in the tree.
  Mechanism rubbing = shipped("governor_bearing");
  for (Joint& j : rubbing.joints)
    if (j.name == "bearing") j.coordinates[0].damping = 1e-3;
  const SystemSummary other = Analysis(rubbing).summary();
  CHECK(std::ranges::find(other.cut_joints, "bearing") != other.cut_joints.end());
  // Cut elsewhere by order: then the loops tell the bearing's rate.
  Mechanism m = shipped("governor_bearing");
  for (Joint& j : m.joints)
    if (j.name == "lift") j.cut = true;
  const Solution forced = solve(m);
  INFO(forced.message);
  REQUIRE(forced.status == Status::converged);
  CHECK(stable(forced));
  CHECK(std::abs(value(forced, "slide") - value(s, "slide")) < 1e-14);
  const auto bearing = std::ranges::find(forced.coordinates, "bearing", &CoordinateSolution::joint);
  REQUIRE(bearing != forced.coordinates.end());
  CHECK(std::abs(bearing->speed.value_or(0) + 10) < 1e-13);
}

TEST_CASE("loops turn with a slow drive beside a fast one, too") {
  Mechanism m = shipped("differential");
  for (Joint& j : m.joints)
    if (j.name == "case") j.coordinates[0].drive->speed = 1e-3; // where its search begins
  const Solution alone = solve(m);
  REQUIRE(alone.status == Status::converged);
  m.bodies.push_back(body("rotor", 1, {2, 0, 0}, {0.01, 0.01, 0.01}));
  m.joints.push_back(rotor("rotor", 2, 3000));
  SolveOptions options;
  options.search = 0;
  const Solution beside = solve(m, options);
  INFO(beside.message);
  REQUIRE(beside.status == Status::converged);
  CHECK(coordinate(beside, "case").speed.value() == Approx(coordinate(alone, "case").speed.value()));
}

TEST_CASE("loops that cannot be closed are infeasible, and the joint is named") {
  SECTION("a link too long") {
    Mechanism m = shipped("governor");
    m.joints[4].length = 2;
    const Solution s = solve(m);
    INFO(s.message);
    CHECK(s.status == Status::infeasible);
    CHECK_THAT(s.message, ContainsSubstring("link1"));
    CHECK(s.coordinates.empty());
  }
  SECTION("two rods that do not reach") {
    Mechanism m;
    m.bodies = {body("a", 1, {0.25, 0, 0}), body("b", 1, {1.75, 0, 0})};
    m.joints = {revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}),
                revolute("b", "ground", "b", {2, 0, 0}, {0, 0, 1}),
                distance("rope", "a", "b", {0.5, 0, 0}, {1.5, 0, 0}, 0.2)};
    const Solution s = solve(m);
    INFO(s.message);
    CHECK(s.status == Status::infeasible);
    CHECK_THAT(s.message, ContainsSubstring("rope"));
  }
}

TEST_CASE("a loop with more equations than it needs converges") {
  const Mechanism m = four_bar();
  const Solution s = solve(m);
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(stable(s));
  CHECK(s.reactions_nonunique);
  CHECK(s.residual < 1e-13);
  // As the same loop closed in its plane alone: by a distance joint in place of the coupler's far end.
  Mechanism plane = m;
  plane.bodies.erase(plane.bodies.begin() + 1);
  plane.joints = {m.joints[0], m.joints[3],
                  distance("coupler", "crank", "rocker", m.joints[1].at, m.joints[2].at)};
  Mechanism light = m;
  light.bodies[1] = body("coupler", 0, m.bodies[1].position);
  const Solution a = solve(light), b = solve(plane);
  REQUIRE(a.status == Status::converged);
  REQUIRE(b.status == Status::converged);
  CHECK(std::abs(value(a, "crank") - value(b, "crank")) < 1e-12);
  CHECK_FALSE(b.reactions_nonunique);
  // The shipped one on a turntable.
  const Solution turning = solve(shipped("fourbar_turntable"));
  CHECK(turning.status == Status::converged);
  CHECK(turning.reactions_nonunique);
  CHECK(stable(turning));
}

TEST_CASE("directions that nothing resists are said to be neutral") {
  SECTION("a top turned about its own axis") {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("top", 1, {0.1, -0.3, 0.05}, {0.01, 0.01, 0.01})};
    m.joints = {joint(JointType::spherical, "socket", "ground", "top", {0, 0, 0})};
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    CHECK(s.neutral == std::vector<std::string>{"socket"});
    CHECK_FALSE(s.stable.has_value());
    CHECK(s.stability_reason == StabilityReason::neutral);
    CHECK_THAT(s.message, ContainsSubstring("Nothing resists socket turning about [0, 1, 0]; the angle"));
    CHECK(std::abs(s.poses[0].position.y() + m.bodies[0].position.norm()) < 1e-12);
  }
  SECTION("a ball on a string turned about it") {
    const Solution s = solve(shipped("ball_on_string"));
    CHECK(s.neutral == std::vector<std::string>{"ball.free"});
    const Vec3 string = (s.poses[1].position - Vec3(0.25, 0.9, 0)).normalized();
    const Vec3 axis =
        std::abs(string.x()) > std::abs(string.y()) ? string : Vec3(-string); // to the larger one
    CHECK_THAT(s.message, ContainsSubstring("Nothing resists ball.free turning about [" +
                                            rounded_text(axis.x(), 4) + ", " + rounded_text(axis.y(), 4)));
  }
  SECTION("two that are geared to each other") {
    Mechanism m;
    m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {1, 0, 0}, {0.1, 0.1, 0.1})};
    m.joints = {revolute("p", "ground", "a", {0, 0, 0}, {0, 0, 1}),
                revolute("q", "ground", "b", {1, 0, 0}, {0, 0, 1}), gear("mesh", "p", "q", -2)};
    const Solution s = solve(m);
    CHECK_THAT(s.message,
               ContainsSubstring("Nothing resists p, q along one direction together; where they stand "
                                 "along it is arbitrary"));
  }
  SECTION("a wheel that spins freely beside a pendulum") {
    Mechanism m = conical(0.5, 0.1, 5, 0.2);
    m.bodies.push_back(body("wheel", 0.5, m.bodies[1].position, {0.01, 0.01, 0.01}));
    m.joints.push_back(revolute("axle", "bob", "wheel", m.bodies[1].position, {0, 0, 1}));
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    CHECK(s.neutral == std::vector<std::string>{"axle"});
    CHECK_FALSE(s.stable.has_value());
    // The rest is solved all the same: the wheel is a point mass more at the bob.
    Mechanism heavy = conical(0.5, 0.1, 5, 0.2);
    heavy.bodies[1].mass = 1.5;
    CHECK(std::abs(value(s, "swing") - value(solve(heavy), "swing")) < 1e-12);
  }
  SECTION("nothing is neutral where a spring holds it") {
    Mechanism m;
    m.bodies = {body("wheel", 1, {0, 0, 0}, {0.1, 0.1, 0.1})};
    m.joints = {sprung(revolute("axle", "ground", "wheel", {0, 0, 0}, {0, 0, 1}), 1e-6)};
    const Solution s = solve(m);
    CHECK(s.neutral.empty());
    CHECK(stable(s));
  }
}

TEST_CASE("a gear to a coordinate that carries no load of its own leaves the other free to settle",
          "[gear]") {
  for (double ratio : {-3., -2., -1., 0.5, 2., 3., 7.}) {
    INFO("ratio " << ratio);
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("arm", 1, {1, 0, 0}), body("wheel", 1, {3, 0, 0}, {0.1, 0.1, 0.1})};
    m.joints = {joint(JointType::revolute, "a", "ground", "arm", Vec3::Zero()),
                joint(JointType::revolute, "b", "ground", "wheel", {3, 0, 0})};
    Joint gear;
    gear.name = "g";
    gear.type = JointType::gear;
    gear.joints = {"a", "b"};
    gear.ratio = ratio;
    m.joints.push_back(gear);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    CHECK(std::abs(s.coordinates[0].value + std::numbers::pi / 2) < 1e-12);
    CHECK(std::abs(s.coordinates[1].value - ratio * s.coordinates[0].value) < 1e-12);
  }
}

TEST_CASE("a heavy hub's constant energy does not hide which way is down", "[descent]") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1e6, Vec3::Zero(), {1e6, 1e6, 1e6}), body("bob", 1e-9, {0.001, -0.7, 0})};
  m.joints = {joint(JointType::revolute, "spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()),
              joint(JointType::revolute, "swing", "hub", "bob", Vec3::Zero())};
  m.joints[0].coordinates[0].drive = Drive{6};
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
}

TEST_CASE("sliding a parameter away and back gives the answer of a fresh start", "[warm]") {
  Mechanism m = shipped("governor");
  Analysis analysis(m);
  const Solution fresh = analysis.solve();
  SolveOptions warm;
  warm.warm = true;
  const auto slide = [&](double speed, double stiffness) {
    set_parameter(m, "joints.spin.drive.speed", speed);
    set_parameter(m, "joints.slide.spring.stiffness", stiffness);
    analysis.update(m);
    return analysis.solve(warm);
  };
  for (double speed : {11., 5., 0., 3., 15., 11.0174})
    slide(speed, 98);
  const Solution back = slide(11.0174, 1000);
  REQUIRE(back.status == Status::converged);
  CHECK(std::abs(back.coordinates[1].value - fresh.coordinates[1].value) < 1e-9);
  CHECK(std::abs(back.coordinates[2].value - fresh.coordinates[2].value) < 1e-9);
}

TEST_CASE("two cuts are exchanged where one exchange alone makes nothing better", "[existence]") {
  // Loops that share a shaft: on the way to cuts that need no drive to be pulled open are some that need as
  // many.
  const char* const scenes[] = {R"({"flyball": 1, "name": "r", "gravity": [0, -9.8, 0],
 "bodies": [
  {"name": "b0", "mass": 1.0, "position": [0, 0.0, 0], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b1", "mass": 1.3, "position": [0.1, 0.1, 0], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b2", "mass": 1.6, "position": [0.2, 0.2, 0], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b3", "mass": 1.9, "position": [0.1, 0.30000000000000004, 0], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b4", "mass": 2.2, "position": [0.2, 0.4, 0], "inertia": [0.1, 0.12, 0.13]}],
 "joints": [
  {"name": "j0", "type": "revolute", "bodies": ["ground", "b0"], "at": [0, 0.1, 0], "axis": [0, 1, 0], "drive": {"speed": -4}},
  {"name": "j1", "type": "cylindrical", "bodies": ["b0", "b1"], "at": [0, 0.3, 0], "axis": [0, 1, 0]},
  {"name": "j2", "type": "distance", "bodies": ["b1", "b2"], "points": [[0.3, 0.1, 0], [0.1, 0.3, 0]], "length": 0.282842712474619},
  {"name": "j3", "type": "revolute", "bodies": ["b1", "b3"], "at": [0.2, 0.3, 0], "axis": [1, 0, 0]},
  {"name": "j4", "type": "revolute", "bodies": ["b0", "b4"], "at": [0, 0, 0], "axis": [0, 1, 0]},
  {"name": "j5", "type": "distance", "bodies": ["b4", "ground"], "points": [[0.3, 0.1, 0], [0.1, 0.3, 0]], "length": 0.282842712474619},
  {"name": "j6", "type": "revolute", "bodies": ["b1", "ground"], "at": [0, 0, 0], "axis": [0, 1, 0]},
  {"name": "j7", "type": "prismatic", "bodies": ["b1", "b4"], "at": [0, 0.1, 0], "axis": [0, 0, 1]}]})",
                                R"({"flyball": 1, "name": "r", "gravity": [0, -9.8, 0],
 "bodies": [
  {"name": "b0", "mass": 1.0, "position": [0.1, 0.0, 0.05], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b1", "mass": 1.3, "position": [0.2, 0.1, 0], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b2", "mass": 1.6, "position": [0, 0.2, 0], "inertia": [0.1, 0.12, 0.13]},
  {"name": "b3", "mass": 1.9, "position": [0.2, 0.30000000000000004, 0.05], "inertia": [0.1, 0.12, 0.13]}],
 "joints": [
  {"name": "j0", "type": "revolute", "bodies": ["ground", "b0"], "at": [0, 0, 0], "axis": [0, 1, 0], "drive": {"speed": 5}},
  {"name": "j1", "type": "revolute", "bodies": ["b0", "b1"], "at": [0, 0.1, 0], "axis": [0, 1, 0]},
  {"name": "j2", "type": "revolute", "bodies": ["b1", "b2"], "at": [0, 0.1, 0], "axis": [0, 1, 0]},
  {"name": "j3", "type": "revolute", "bodies": ["b0", "b3"], "at": [0, 0.3, 0], "axis": [0, 1, 0]},
  {"name": "j4", "type": "revolute", "bodies": ["b3", "b2"], "at": [0.2, 0, 0], "axis": [0, 1, 0]},
  {"name": "j5", "type": "cylindrical", "bodies": ["b2", "b0"], "at": [0, 0.1, 0], "axis": [0, 1, 0]},
  {"name": "j6", "type": "prismatic", "bodies": ["b1", "ground"], "at": [0.2, 0, 0], "axis": [0, 1, 0]}]})"};
  for (const char* scene : scenes) {
    const Solution s = solve(read_scene(scene));
    CAPTURE(s.message);
    CHECK(s.status == Status::converged);
  }
}
