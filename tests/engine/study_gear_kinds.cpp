// Belts, racks and screws: ratios, balances of force and torque by closed forms, and the power they pass on.
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

constexpr double g = 9.80665, pi = std::numbers::pi;

Joint tie(const std::string& name, GearKind kind, const std::string& a, const std::string& b) {
  Joint j = gear(name, a, b, 1);
  j.kind = kind;
  return j;
}

Body disc(const std::string& name, double inertia, const Vec3& at = Vec3::Zero()) {
  return body(name, 1, at, {inertia, inertia, 2 * inertia});
}

// A wheel on a spring, and a weight that slides down and that a rack or screw hangs on the wheel.
Mechanism hoist(GearKind kind) {
  Mechanism m;
  m.gravity = {0, -g, 0};
  m.bodies = {disc("wheel", 0.1), body("load", 3, {0.2, 0, 0}, {0.01, 0.01, 0.01})};
  m.joints = {sprung(revolute("turn", "ground", "wheel", {0, 0, 0}, {0, 0, 1}), 40),
              prismatic("slide", "ground", "load", {0.2, 0, 0}, {0, 1, 0}),
              tie("tie", kind, "turn", "slide")};
  m.joints[2].radii[0] = 0.06;
  m.joints[2].lead = 0.4;
  return m;
}

} // namespace

TEST_CASE("a rack and a screw hang a weight on a spring that turns", "[gear kinds]") {
  for (const GearKind kind : {GearKind::rack, GearKind::screw}) {
    CAPTURE(type_name(kind));
    const Mechanism m = hoist(kind);
    validate(m);
    const double by_turn = kind == GearKind::rack ? 0.06 : 0.4 / (2 * pi); // m/rad
    CHECK_THAT(gear_ratio(m.joints[2]), WithinRel(by_turn, 1e-15));
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    // k q = -m g r: virtual work of the weight.
    const double turn = -3 * g * by_turn / 40;
    CHECK_THAT(coordinate(s, "turn").value, WithinRel(turn, 1e-14));
    CHECK_THAT(coordinate(s, "slide").value, WithinRel(by_turn * turn, 1e-14));
    // The tie holds the weight, and what it does to the wheel passes the same work.
    REQUIRE(s.gears.size() == 1);
    CHECK_THAT(s.gears[0].b, WithinRel(3 * g, 1e-13));
    CHECK_THAT(s.gears[0].a, WithinRel(-3 * g * by_turn, 1e-13));
  }
}

TEST_CASE("a belt turns a second shaft by its radii, crossed against the first", "[gear kinds]") {
  for (const bool crossed : {false, true}) {
    CAPTURE(crossed);
    Mechanism m;
    m.bodies = {disc("motor", 0.1), disc("fan", 0.3, {0.5, 0, 0})};
    m.joints = {revolute("drive", "ground", "motor", {0, 0, 0}, {0, 0, 1}),
                dampened(revolute("fan", "ground", "fan", {0.5, 0, 0}, {0, 0, 1}), 0.7),
                tie("belt", GearKind::belt, "drive", "fan")};
    m.joints[2].radii = {0.04, 0.1};
    m.joints[2].crossed = crossed;
    SECTION("at a given speed") {
      m.joints[0].coordinates[0].drive = Drive{30};
      validate(m);
      const Solution s = Analysis(m).solve();
      REQUIRE(s.status == Status::converged);
      // The damper's power comes from the drive: c (w r_a / r_b)^2 = T w.
      CHECK_THAT(s.drive_torques.at(0).value, WithinRel(0.7 * 30 * 0.16, 1e-13));
    }
    SECTION("by a torque, of which the speeds follow") {
      Drive& drive = m.joints[0].coordinates[0].drive.emplace();
      drive.speed = 5;
      drive.torque = 2;
      validate(m);
      const Solution s = Analysis(m).solve();
      INFO(s.message);
      REQUIRE(s.status == Status::converged);
      const double w = 2 / (0.7 * 0.16);
      CHECK_THAT(coordinate(s, "drive").speed.value(), WithinRel(w, 1e-13));
      CHECK_THAT(coordinate(s, "fan").speed.value(), WithinRel((crossed ? -0.4 : 0.4) * w, 1e-13));
    }
  }
}

TEST_CASE("a belt whose sign the axes turn round in space is warned of", "[gear kinds]") {
  // Whether an open belt between the wheels, each given by its joint, turns them alike in space.
  const auto alike = [](const Joint& a, const Joint& b, bool crossed) {
    Mechanism m;
    m.bodies = {disc("a", 0.1), disc("b", 0.1, {0.5, 0, 0}), disc("arm", 0.1)};
    m.joints = {a, b, tie("belt", GearKind::belt, a.name, b.name)};
    m.joints[2].crossed = crossed;
    const bool is = wheels_turn_alike(m, m.joints[2]);
    const std::vector<SceneError> warnings = find_warnings(m);
    REQUIRE(warnings.size() == (is ? 0 : 1));
    if (is) return true;
    CHECK(warnings[0].where() == "joints.belt");
    CHECK_THAT(warnings[0].expected(),
               ContainsSubstring(crossed ? "there it is an open belt" : "there it is a crossed one"));
    return false;
  };
  const Vec3 z = Vec3::UnitZ(), there{0.5, 0, 0};
  for (const bool crossed : {false, true}) {
    const Joint a = revolute("a", "ground", "a", Vec3::Zero(), z);
    CHECK(alike(a, revolute("b", "ground", "b", there, 3 * z), crossed));
    CHECK_FALSE(alike(a, revolute("b", "ground", "b", there, -z), crossed));
    CHECK_FALSE(alike(a, revolute("b", "b", "ground", there, z), crossed));
    CHECK(alike(a, revolute("b", "b", "ground", there, -z), crossed));
    CHECK(alike(a, revolute("b", "ground", "b", there, Vec3::UnitX()), crossed)); // a quarter turned
    // A planet's wheel on an arm, and the wheel about which the arm goes, which stands still.
    CHECK_FALSE(alike(revolute("arm", "ground", "arm", Vec3::Zero(), z), revolute("b", "arm", "b", there, z),
                      crossed));
  }
}

TEST_CASE("a chain over three wheels is a belt from each to the next", "[gear kinds]") {
  Mechanism m;
  m.bodies = {disc("a", 0.1), disc("b", 0.1, {1, 0, 0}), disc("c", 0.1, {2, 0, 0})};
  m.joints = {revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}),
              revolute("b", "ground", "b", {1, 0, 0}, {0, 0, 1}),
              dampened(revolute("c", "ground", "c", {2, 0, 0}, {0, 0, 1}), 1),
              tie("ab", GearKind::belt, "a", "b"), tie("bc", GearKind::belt, "b", "c")};
  m.joints[3].radii = {0.1, 0.2};
  m.joints[4].radii = {0.2, 0.05};
  m.joints[0].coordinates[0].drive = Drive{10};
  validate(m);
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(s.drive_torques.at(0).value, WithinRel(10 * 2. * 2., 1e-13)); // c turns at 10 * 0.1 / 0.05
}

TEST_CASE("a rack in a turning frame ties balls to a sleeve as the gear of its ratio does", "[gear kinds]") {
  const auto turntable = [](GearKind kind) {
    Mechanism m = hoist(kind);
    m.bodies.push_back(disc("table", 1));
    m.joints[0].bodies[0] = m.joints[1].bodies[0] = "table";
    m.joints.push_back(revolute("spin", "ground", "table", {0, 0, 0}, {0, 1, 0}));
    m.joints.back().coordinates[0].drive = Drive{9};
    m.bodies[0].position = {0.05, 0.1, 0};
    return m;
  };
  Mechanism as_gear = turntable(GearKind::gear);
  as_gear.joints[2].ratio = 0.06;
  const Solution a = Analysis(turntable(GearKind::rack)).solve(), b = Analysis(as_gear).solve();
  REQUIRE(a.status == Status::converged);
  CHECK(a.coordinates.at(0).value == b.coordinates.at(0).value);
  CHECK(a.residual == b.residual);
}

TEST_CASE("sensitivities know leads and radii", "[gear kinds][sensitivity]") {
  Mechanism m = hoist(GearKind::screw);
  m.sliders = {{"joints.tie.lead", 0.1, 1, SliderScale::linear, ""}};
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  // turn = -m g lead / (2 pi k)
  REQUIRE(s.sensitivities.size() == 1);
  const auto turn = std::ranges::find(s.sensitivities[0].rates, "turn", &Sensitivity::Rate::joint);
  CHECK_THAT(turn->value, WithinRel(-3 * g / (2 * pi * 40), 1e-12));
}

TEST_CASE("what ties the wrong coordinates is told by its name", "[gear kinds]") {
  const auto expect = [](Mechanism m, const std::string& where, const std::string& what) {
    try {
      validate(m);
      FAIL("nothing was said");
    } catch (const SceneError& error) {
      CHECK(error.where() == where);
      CHECK_THAT(error.expected(), ContainsSubstring(what));
    }
  };
  Mechanism m = hoist(GearKind::rack);
  std::swap(m.joints[2].joints[0], m.joints[2].joints[1]);
  expect(m, "joints.tie.joints[0]",
         "expected a turn, found the slide slide: a rack turns at its first joint");
  m = hoist(GearKind::belt);
  expect(m, "joints.tie.joints[1]", "expected a turn, found the slide slide: a belt runs over two wheels");
  m = hoist(GearKind::screw);
  m.joints[2].lead = 0;
  expect(m, "joints.tie.lead", "other than zero");
  m = hoist(GearKind::rack);
  m.joints[2].radii[0] = 0;
  expect(m, "joints.tie.radius", "other than zero");
}

TEST_CASE("kinds of gears are written as they are read", "[gear kinds]") {
  const std::string text = R"({"flyball": 2, "name": "ties",
    "bodies": [{"name": "nut", "mass": 1, "position": [0, 0, 0]}, {"name": "wheel", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]}],
    "joints": [
      {"name": "thread", "type": "cylindrical", "bodies": ["ground", "nut"], "at": [0, 0, 0], "axis": [0, 1, 0]},
      {"name": "axle", "type": "revolute", "bodies": ["ground", "wheel"], "at": [1, 0, 0], "axis": [0, 1, 0]},
      {"name": "screw", "type": "gear", "kind": "screw", "joints": ["thread.0", "thread.1"], "lead": "=5 mm"},
      {"name": "belt", "type": "gear", "kind": "belt", "joints": ["axle", "thread.0"], "radii": [0.1, "=20 cm"], "crossed": true}]})";
  const Mechanism m = read_scene(text);
  CHECK(m.joints[2].lead == 0.005);
  CHECK(m.joints[3].radii == std::array{0.1, 0.2});
  CHECK(gear_ratio(m.joints[3]) == -0.5);
  CHECK(read_scene(write_scene(m)) == m);
  const auto mistake = [&](const std::string& from, const std::string& to) -> std::string {
    std::string wrong = text;
    wrong.replace(wrong.find(from), from.size(), to);
    try {
      read_scene(wrong);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  CHECK_THAT(mistake(R"("lead": "=5 mm")", R"("ratio": 2)"),
             ContainsSubstring("joints.screw.ratio") && ContainsSubstring("does not belong to a screw"));
  CHECK_THAT(mistake(R"("lead": "=5 mm")", R"("offset": 0)"),
             ContainsSubstring("joints.screw.lead") && ContainsSubstring("missing; a screw needs it"));
  CHECK_THAT(mistake(R"("kind": "belt")", R"("kind": "chain")"),
             ContainsSubstring("expected gear, belt, rack or screw"));
  CHECK_THAT(mistake(R"("=5 mm")", R"("=5 N")"), ContainsSubstring("joints.screw.lead"));
}
