// A drive given to what stands in elastic bearings: the parts that make it, what cannot have one, and rotors
// whose motions are known: Jeffcott's and its tilting.
#include "app/document/bearing_drive.hpp"
#include "app/document/create.hpp"
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/periodic/periodic_state.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/campbell.hpp"
#include "tests/catch.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <complex>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double mass = 12, across = 0.3, along = 0.2, half = 0.25, film = 3e4, film_damping = 150,
                 weight = mass * 9.81;

// A rotor along `axis` in two bearings at ±half, its mass centre `e` beside the axis; weight along -y.
Mechanism rotor(double e = 0, const Vec3& axis = Vec3::UnitX(), double damping = film_damping) {
  Mechanism m;
  m.name = "Rotor";
  m.gravity = {0, -9.81, 0};
  Body body;
  body.name = "rotor";
  body.mass = mass;
  const Vec3 aside = axis.cross(Vec3::UnitY()).norm() > 0.5 ? Vec3::UnitY() : Vec3::UnitX();
  body.position = e * aside;
  body.rotation = Quat::FromTwoVectors(Vec3::UnitX(), axis);
  body.inertia = {along, across, across, 0, 0, 0};
  m.bodies.push_back(body);
  for (const double side : {-1., 1.}) {
    add_bearing(m, {"ground", "rotor"}, side * half * axis, axis);
    m.forces.back().bearing_stiffness = {film, 0, 0, film};
    m.forces.back().bearing_damping = {damping, 0, 0, damping};
  }
  return m;
}

Mechanism driven(Mechanism m, double speed) {
  CHECK(bearing_drive_refused(m, "rotor").empty());
  give_bearing_drive(m, "rotor", speed);
  validate(m);
  return m;
}

const Joint& joint(const Mechanism& m, const std::string& name) {
  const int j = joint_index(m, name);
  REQUIRE(j >= 0);
  return m.joints[static_cast<std::size_t>(j)];
}

Solution settled(const Mechanism& m) {
  validate(m);
  Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  return s;
}

const PeriodicRange& range(const PeriodicState& s, const std::string& name) {
  for (const PeriodicCoordinate& c : s.coordinates)
    if (c.joint == name) return c.range;
  FAIL(name);
  return s.coordinates[0].range;
}

} // namespace

TEST_CASE("a body in bearings turns in a sleeve that they hold") {
  Mechanism m = rotor(0.001);
  const std::string spin = give_bearing_drive(m, "rotor", 30);
  CHECK(spin == "spin1");
  REQUIRE(m.bodies.size() == 4);
  for (std::size_t b = 1; b < 4; ++b) {
    CHECK(m.bodies[b].mass == 0);
    CHECK(m.bodies[b].position.tail<2>().norm() == 0); // on the axis
  }
  CHECK(m.bodies[3].position.x() == 0); // the sleeve, beside the mass centre
  CHECK(joint(m, "tilt1").at == Vec3::Zero());
  CHECK(joint(m, "up1").at.x() < -half); // beyond the bearings, where there is room
  CHECK(joint(m, "up1").axis == Vec3::UnitY());
  CHECK(joint(m, "across1").axis == Vec3::UnitZ());
  CHECK(joint(m, spin).bodies == std::array<std::string, 2>{"sleeve1", "rotor"});
  CHECK(joint(m, spin).axis == Vec3::UnitX());
  CHECK(joint(m, spin).coordinates.at(0).drive->speed == 30);
  for (const Force& bearing : m.forces)
    CHECK(bearing.bodies == std::array<std::string, 2>{"ground", "sleeve1"});
  // And is one that turns already.
  CHECK_THAT(bearing_drive_refused(m, "rotor"), ContainsSubstring("No bearing holds rotor"));
  CHECK_THAT(bearing_drive_refused(m, "sleeve1"), ContainsSubstring("joined to the ground already"));
  CHECK(bodies_in_bearings(m).empty());
}

TEST_CASE(
    "a balanced rotor that is given a drive sinks as in its bearings, with the frequencies of a gyroscope") {
  const double speed = GENERATE(0., 10., 200.);
  CAPTURE(speed);
  const Solution s = settled(driven(rotor(0, Vec3::UnitX(), 0), speed));
  CHECK_THAT(value(s, "up1"), WithinRel(-weight / (2 * film), 1e-12));
  CHECK_THAT(value(s, "across1"), WithinAbs(0, 1e-15));
  // Shifts swing at sqrt(2 k / m); tilts as across s^2 -+ i along speed s + 2 k half^2 = 0.
  std::vector<std::complex<double>> expected;
  for (const double sign : {1., -1.}) {
    for (int i = 0; i < 2; ++i)
      expected.emplace_back(0, sign * std::sqrt(2 * film / mass));
    const double g = along * speed / (2 * across), k = 2 * film * half * half / across;
    expected.emplace_back(0, sign * (g + std::sqrt(g * g + k)));
    expected.emplace_back(0, sign * (g - std::sqrt(g * g + k)));
  }
  REQUIRE(s.eigenvalues);
  REQUIRE(s.eigenvalues->size() == expected.size());
  for (const auto& e : expected) {
    double nearest = 1e300;
    for (const auto& found : *s.eigenvalues)
      nearest = std::min(nearest, std::abs(found - e));
    CAPTURE(e);
    CHECK(nearest < 1e-6 * std::abs(e));
  }
}

TEST_CASE("held still by its drive, a body swings as it did in its bearings") {
  Mechanism m = rotor();
  m.gravity.setZero();
  m.bodies[0].position = {0.1, 0, 0};
  m.forces[0].bearing_stiffness = {8e4, 5e3, -3e3, 2e5};
  m.forces[0].bearing_damping = {900, 100, 50, 300};
  m.forces[1].x_axis = Vec3(0, 3, 4);
  m.forces[1].bearing_stiffness = {4e4, 0, 2e3, 9e4};
  const Solution before = settled(m), after = settled(driven(m, 0));
  REQUIRE(before.eigenvalues);
  REQUIRE(after.eigenvalues);
  CHECK(before.eigenvalues->size() == 12); // with the turn and the shift along the axis
  CHECK(after.eigenvalues->size() == 8);
  for (const auto& e : *after.eigenvalues) {
    double nearest = 1e300;
    for (const auto& same : *before.eigenvalues)
      nearest = std::min(nearest, std::abs(same - e));
    CAPTURE(e);
    CHECK(nearest < 1e-7 * std::abs(e));
  }
}

TEST_CASE("an unbalanced rotor that is given a drive whirls as Jeffcott's") {
  const double e = 1e-3, natural = std::sqrt(2 * film / mass), zeta = film_damping / (mass * natural);
  for (const double n : {0.3, 1., 2.5}) {
    CAPTURE(n);
    const PeriodicState s = find_periodic_state(driven(rotor(e), n * natural));
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const double r = e * n * n / std::hypot(1 - n * n, 2 * zeta * n), sag = weight / (2 * film);
    CHECK_THAT(range(s, "up1").mean, WithinAbs(-sag, 1e-10));
    CHECK_THAT(range(s, "up1").most, WithinAbs(r - sag, 1e-7 * r));
    CHECK_THAT(range(s, "across1").most, WithinAbs(r, 1e-7 * r));
    CHECK_THAT(range(s, "tilt1").most, WithinAbs(0, 1e-9));
    CHECK(s.stable == true);
    REQUIRE(s.drive_torques.size() == 1);
    // What the drive gives on the average is what the bearings' dampers take.
    CHECK_THAT(s.drive_torques[0].range.mean, WithinRel(2 * film_damping * n * natural * r * r, 1e-6));
  }
}

TEST_CASE("the critical speeds of a rotor that is given a drive are Jeffcott's and that of its tilting") {
  // Without weight, which the whole turns about nowhere.
  const Vec3 axis = GENERATE(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(2, 3, 6) / 7);
  CAPTURE(axis.transpose());
  Mechanism m = driven(rotor(0, axis, 0), 10);
  m.gravity.setZero();
  const std::string speed = "joints.spin1.drive.speed";
  const CampbellDiagram d = campbell_diagram(m, speed, follow_branches(m, speed, 5, 250), std::array{1.});
  // Forward tilts swing once a turn at w^2 (across - along) = 2 k half^2, backward ones at (across + along).
  const double shift = std::sqrt(2 * film / mass),
               tilt = std::sqrt(2 * film * half * half / (across - along)),
               back = std::sqrt(2 * film * half * half / (across + along));
  for (const double expected : {shift, tilt, back}) {
    double nearest = 1e300;
    for (const CriticalSpeed& c : d.critical)
      nearest = std::min(nearest, std::abs(c.speed - expected));
    CAPTURE(expected);
    CHECK(nearest < 1e-6 * expected);
  }
  for (const CriticalSpeed& c : d.critical)
    CHECK(std::min({std::abs(c.speed - shift), std::abs(c.speed - tilt), std::abs(c.speed - back)}) <
          1e-6 * c.speed);
}

TEST_CASE("the axis and where gravity is say how the sleeve slides") {
  SECTION("along z, up is up") {
    const Mechanism m = driven(rotor(0, Vec3::UnitZ()), 10);
    CHECK(joint(m, "up1").axis == Vec3::UnitY());
    CHECK(joint(m, "across1").axis == -Vec3::UnitX());
  }
  SECTION("upright, it is held along its axis, where it would fall") {
    Mechanism m = rotor(0, Vec3::UnitY());
    CHECK(Analysis(m).solve().status != Status::converged);
    m = driven(m, 10);
    CHECK(joint_index(m, "up1") < 0);
    CHECK(joint_index(m, "across2") >= 0);
    CHECK(settled(m).stable == true);
  }
  SECTION("askew") {
    const Vec3 axis = Vec3(2, 3, 6) / 7;
    const Mechanism m = driven(rotor(0, axis), 10);
    const Vec3 up = joint(m, "up1").axis, side = joint(m, "across1").axis;
    for (const double product : {up.dot(axis), side.dot(axis), up.dot(side)})
      CHECK_THAT(product, WithinAbs(0, 1e-15));
    // It sinks across the axis by what its weight has there.
    CHECK_THAT(value(settled(m), "up1"), WithinRel(-weight * std::sqrt(1 - 9. / 49) / (2 * film), 1e-9));
  }
  SECTION("bearings that are stiff along it let it slide there") {
    Mechanism m = rotor(0, Vec3::UnitY());
    BearingMatrix& full = m.forces[0].bearing_stiffness;
    full.assign(36, 0);
    full[0] = full[7] = film;
    full[14] = 1e5;
    m.forces[0].bearing_damping.clear();
    CHECK_THAT(value(settled(driven(m, 10)), "along1"), WithinRel(-weight / 1e5, 1e-12));
  }
}

TEST_CASE("a hinge that makes bearings idle goes into their sleeve, with its drive") {
  Mechanism m = rotor();
  const bool turned_round = GENERATE(false, true);
  add_joint(m, JointType::revolute, {"ground", "rotor"}, {0.1, 0, 0}, Vec3(turned_round ? -2 : 2, 0, 0));
  if (turned_round) std::swap(m.joints[0].bodies[0], m.joints[0].bodies[1]);
  m.joints[0].coordinates[0].drive.emplace().speed = 40;
  CHECK_THAT(value(settled(m), "revolute1"), WithinAbs(0, 1e-12));
  const std::vector<BodyInBearings> found = bodies_in_bearings(m);
  REQUIRE(found.size() == 1);
  CHECK(found[0].body == "rotor");
  CHECK(found[0].hinge == "revolute1");
  CHECK(give_bearing_drive(m, "rotor", 10) == "revolute1");
  CHECK(joint(m, "revolute1").bodies[turned_round ? 1 : 0] == "sleeve1");
  CHECK(joint(m, "revolute1").bodies[turned_round ? 0 : 1] == "rotor");
  CHECK(joint(m, "revolute1").coordinates[0].drive->speed == 40);
  CHECK_THAT(value(settled(m), "up1"), WithinRel(-weight / (2 * film), 1e-12));
}

TEST_CASE("bearings in a housing, named points and idle free joints go along") {
  Mechanism m = rotor();
  Body housing;
  housing.name = "housing";
  housing.mass = 3;
  m.bodies.push_back(housing);
  add_joint(m, JointType::prismatic, {"ground", "housing"}, {0, 0, 0}, Vec3::UnitY());
  m.joints[0].coordinates[0].spring.emplace().stiffness = 1e5;
  for (Force& bearing : m.forces)
    bearing.bodies[0] = "housing";
  m.points.push_back({.name = "A", .at = {-half, 0, 0}});
  for (const char* i : {"0", "1", "2"})
    m.forces[0].formulas.push_back({std::string("at.") + i, std::string("A.") + "xyz"[i[0] - '0']});
  add_joint(m, JointType::free, {"ground", "rotor"}, {0, 0, 0}, Vec3::UnitZ());
  m = driven(m, 10);
  CHECK(joint_index(m, "free1") < 0);
  CHECK(joint(m, "up1").bodies[0] == "housing");
  CHECK(joint(m, "spin1").formulas == m.forces[0].formulas);
  CHECK(joint(m, "spin1").at == Vec3(-half, 0, 0));
  const Solution s = settled(m);
  CHECK_THAT(value(s, "prismatic1"), WithinRel(-(weight + 3 * 9.81) / 1e5, 1e-12));
  CHECK_THAT(value(s, "up1"), WithinRel(-weight / (2 * film), 1e-12));
}

TEST_CASE("what cannot be driven in its bearings says why, and stays as it is") {
  const auto refused = [](const Mechanism& m, const std::string& body, const std::string& why) {
    CHECK_THAT(bearing_drive_refused(m, body), ContainsSubstring(why));
    CHECK(bodies_in_bearings(m).empty());
    Mechanism tried = m;
    CHECK_THROWS_AS(give_bearing_drive(tried, body, 10), SceneError);
    CHECK(tried == m);
  };
  Mechanism m = rotor();
  SECTION("another axis") {
    m.forces[1].axis = {1, 0.01, 0};
    refused(m, "rotor", "not on one axis");
  }
  SECTION("an axis beside") {
    m.forces[1].at = Vec3(half, 0.001, 0);
    refused(m, "rotor", "not on one axis");
  }
  SECTION("pedestals of their own") {
    m.bodies.push_back(m.bodies[0]);
    m.bodies[1].name = "pedestal";
    m.forces[1].bodies[0] = "pedestal";
    CHECK_THAT(bearing_drive_refused(m, "rotor"), ContainsSubstring("in several bodies"));
  }
  SECTION("a joint beside them") {
    add_joint(m, JointType::spherical, {"ground", "rotor"}, {0, 0, 0}, Vec3::UnitX());
    refused(m, "rotor", "By spherical1 it is joined to the ground already");
  }
  SECTION("joints by way of another body") {
    m.bodies.push_back(m.bodies[0]);
    m.bodies[1].name = "motor";
    add_joint(m, JointType::revolute, {"ground", "motor"}, {-1, 0, 0}, Vec3::UnitX());
    add_joint(m, JointType::universal, {"motor", "rotor"}, {-0.5, 0, 0}, Vec3::UnitY(), Vec3::UnitZ());
    refused(m, "rotor", "By universal1 it is joined to the ground already");
  }
  SECTION("a free joint with a spring") {
    add_joint(m, JointType::free, {"ground", "rotor"}, {0, 0, 0}, Vec3::UnitZ());
    m.joints[0].coordinates[2].spring.emplace().stiffness = 1;
    refused(m, "rotor", "By free1 it is joined to the ground already");
  }
  SECTION("a bearing that resists the turn") {
    BearingMatrix& full = m.forces[0].bearing_damping;
    full.assign(36, 0);
    full[35] = 1;
    m.forces[0].bearing_stiffness.clear();
    refused(m, "rotor", "bearing1 resists turning");
  }
  SECTION("an axis by an expression") {
    m.forces[1].formulas.push_back({"axis.0", "1"});
    refused(m, "rotor", "given by an expression");
  }
  SECTION("nothing that a bearing holds") {
    m.forces.clear();
    refused(m, "rotor", "No bearing holds rotor");
  }
}
