// Backlash given to gears: the parts that make it, what cannot have any, and what it settles to.
#include "app/document/backlash.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

// Three wheels in a train, the first driven, loads on the others.
Mechanism train() {
  return parse_scene(R"({"flyball": 1, "name": "Train",
    "bodies": [
      {"name": "a", "mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.02]},
      {"name": "b", "mass": 2, "position": [0.3, 0, 0], "inertia": [0.05, 0.05, 0.1]},
      {"name": "c", "mass": 3, "position": [0.8, 0, 0], "inertia": [0.1, 0.1, 0.2]}],
    "joints": [
      {"name": "turn_a", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 0, 1],
       "drive": {"speed": 10}},
      {"name": "turn_b", "type": "revolute", "bodies": ["ground", "b"], "at": [0.3, 0, 0], "axis": [0, 0, 1]},
      {"name": "turn_c", "type": "revolute", "bodies": ["ground", "c"], "at": [0.8, 0, 0], "axis": [0, 0, 1]},
      {"name": "first", "type": "gear", "joints": ["turn_a", "turn_b"], "ratio": -0.5},
      {"name": "second", "type": "gear", "joints": ["turn_b", "turn_c"], "ratio": -0.4}],
    "forces": [
      {"name": "on_b", "type": "torque", "body": "b", "vector": [0, 0, 3]},
      {"name": "on_c", "type": "torque", "body": "c", "vector": [0, 0, 2]}]})");
}

Solution settled(const Mechanism& m) {
  validate(m);
  Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  return s;
}

double on_flank(double torque) {
  return std::copysign(usual_mesh_of_angles.play / 2, torque) + torque / usual_mesh_of_angles.stiffness;
}

} // namespace

TEST_CASE("a wheel is hung in a rim, with a parameter for its play") {
  Mechanism m = train();
  const std::string play = give_backlash(m, "second");
  CHECK(play == "play1");
  REQUIRE(m.bodies.size() == 4);
  CHECK(m.bodies[3].name == "rim1");
  CHECK(m.bodies[3].mass == 0);
  CHECK(m.joints[2].bodies == std::array<std::string, 2>{"ground", "rim1"});
  const Joint& made = m.joints[static_cast<std::size_t>(joint_index(m, play))];
  CHECK(made.bodies == std::array<std::string, 2>{"rim1", "c"});
  CHECK(made.at == m.joints[2].at);
  const Solution s = settled(m);
  CHECK_THAT(value(s, play), WithinRel(on_flank(2), 1e-12));
  // One number for both sides.
  set_parameter(m, "parameters.backlash", 0.06);
  CHECK_THAT(value(settled(m), play), WithinRel(0.03 + 2 / usual_mesh_of_angles.stiffness, 1e-12));
}

TEST_CASE("what is geared to the wheel follows it through its play") {
  const bool second_too = GENERATE(false, true);
  const bool second_first = GENERATE(false, true);
  CAPTURE(second_too, second_first);
  Mechanism m = train();
  std::string first, second;
  if (second_too && second_first) second = give_backlash(m, "second");
  first = give_backlash(m, "first");
  if (second_too && !second_first) second = give_backlash(m, "second");
  const Solution s = settled(m);
  CAPTURE(s.message);
  const double through = 3 - 0.4 * 2;
  CHECK_THAT(value(s, first), WithinRel(on_flank(through), 1e-11));
  CHECK_THAT(value(s, "follow1"), WithinRel(-0.4 * on_flank(through), 1e-11));
  if (second_too) CHECK_THAT(value(s, second), WithinRel(on_flank(2), 1e-11));
  CHECK(s.stable == true);
  CHECK_THAT(s.drive_torques.at(0).value, WithinRel(0.5 * through, 1e-11));
}

TEST_CASE("the play is on the side that the drive does not turn") {
  Mechanism m = train();
  std::swap(m.joints[0].coordinates[0].drive, m.joints[2].coordinates[0].drive);
  const std::string play = give_backlash(m, "second"); // the drive is on its second side
  CHECK(m.joints[static_cast<std::size_t>(joint_index(m, play))].bodies[1] == "b");
  // a is geared to b and follows.
  CHECK(m.joints[static_cast<std::size_t>(joint_index(m, "follow1"))].bodies[1] == "a");
  const Solution s = settled(m);
  CHECK_THAT(value(s, play), WithinRel(on_flank(3), 1e-11));
}

TEST_CASE("a rack has its play along the slide") {
  Mechanism m = parse_scene(R"({"flyball": 1, "name": "Hoist", "gravity": [0, -9.8, 0],
    "bodies": [
      {"name": "wheel", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.2]},
      {"name": "load", "mass": 3, "position": [0.2, 0, 0], "inertia": [0.01, 0.01, 0.01]}],
    "joints": [
      {"name": "turn", "type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 0, 0], "axis": [0, 0, 1],
       "spring": {"stiffness": 40}},
      {"name": "slide", "type": "prismatic", "bodies": ["ground", "load"], "at": [0.2, 0, 0], "axis": [0, 1, 0]},
      {"name": "tie", "type": "gear", "kind": "rack", "joints": ["turn", "slide"], "radius": 0.06}]})");
  const std::string play = give_backlash(m, "tie");
  CHECK(m.parameters.back().unit == "m");
  const Solution s = settled(m);
  CHECK_THAT(value(s, play),
             WithinRel(-usual_mesh_of_slides.play / 2 - 3 * 9.8 / usual_mesh_of_slides.stiffness, 1e-11));
  CHECK_THAT(value(s, "turn"), WithinRel(-3 * 9.8 * 0.06 / 40, 1e-11));
  CHECK(s.stable == true);
}

TEST_CASE("what cannot have backlash says why, and stays as it is") {
  const auto refused = [](const Mechanism& m, const std::string& gear, const std::string& why) {
    CHECK_THAT(backlash_refused(m, gear), ContainsSubstring(why));
    Mechanism tried = m;
    CHECK_THROWS_AS(give_backlash(tried, gear), SceneError);
    CHECK(tried == m);
  };
  Mechanism m = train();
  CHECK(backlash_refused(m, "first").empty());
  m.joints[1].coordinates[0].damping = 0.1;
  refused(m, "first", "turn_b would act on the rim");
  m = train();
  m.joints[2].coordinates[0].damping = 0.1; // which would have to follow
  refused(m, "first", "turn_c would act on the rim");
  m = train();
  m.joints[1].coordinates[0].drive = Drive{.torque = 1};
  refused(m, "first", "Drives turn both of its sides");
  m = train();
  Joint ring = m.joints[4];
  ring.name = "ring";
  ring.ratio = 1;
  m.joints.push_back(ring);
  refused(m, "first", "a ring");
  refused(m, "turn_a", "expected a gear");
}
