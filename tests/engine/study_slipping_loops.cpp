// Joints that slip where another joint of their loop rests against a spring or a stop, so that the drives
// give their rate, and beside joints that rest in balance: against closed forms and the motion that settles.
#include "engine/dynamics/simulator.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/friction_branches.hpp"
#include "engine/study/friction_ribbon.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::string half = R"("friction": {"limit": 0.5})"; // N m

double rate(const Solution& s, std::string_view joint) {
  return coordinate(s, joint).speed.value();
}

const CoordinateTrack& track(const Run& run, std::string_view joint) {
  const auto found = std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
  REQUIRE(found != run.coordinates.end());
  return *found;
}

} // namespace

TEST_CASE("a clutch slips whose disc rests against a stop or a spring: it turns by T / k") {
  struct Case {
    std::string clutch, brake;
    double at, torque;
  };
  const Case c =
      GENERATE(Case{half, R"("damping": 0.5, "stop": {"lower": -0.1, "upper": 0.2, "stiffness": 100})",
                    0.2 + 0.005, 0.5},
               Case{half, R"("damping": 0.5, "spring": {"stiffness": 100})", 0.005, 0.5},
               Case{half + R"(, "damping": 0.01)", R"("damping": 0.5, "spring": {"stiffness": 97})",
                    (0.5 + 0.01 * clutch_shaft_speed) / 97, 0.5 + 0.01 * clutch_shaft_speed});
  CAPTURE(c.clutch, c.brake);
  const Mechanism m = clutch_and_brake(c.clutch, c.brake);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "brake"), WithinRel(c.at, 1e-12));
  CHECK_THAT(rate(s, "clutch"), WithinRel(-clutch_shaft_speed, 1e-12));
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].slips);
  CHECK(s.frictions[0].value == 0.5);
  CHECK(s.stable == true);
  REQUIRE(s.drive_torques.size() == 1);
  CHECK_THAT(s.drive_torques[0].value, WithinRel(c.torque, 1e-12));

  SimulationOptions options;
  options.duration = 5;
  const Run motion = simulate(m, options);
  INFO(motion.message);
  CHECK_THAT(track(motion, "brake").value.back(), WithinRel(c.at, 1e-6));
  CHECK_THAT(track(motion, "brake").rate.back(), WithinAbs(0, 1e-6));
}

TEST_CASE("a clutch slips whose disc rests against a spring that is flat as drawn") {
  const Mechanism m = clutch_and_brake(half, R"("spring": {"force": "=20 N m*deflection^3"})");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "brake"), WithinRel(std::cbrt(0.5 / 20), 1e-9));
  CHECK_THAT(rate(s, "clutch"), WithinRel(-clutch_shaft_speed, 1e-12));
}

TEST_CASE("the branch of a block on a conveyor ends where that stands, in a slip") {
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Conveyor", "gravity": [0, -9.81, 0],
    "bodies": [{"name": "belt", "mass": 1, "position": [0, 0, 0]}, {"name": "block", "mass": 2, "position": [0, 0.1, 0]}],
    "joints": [{"name": "belt", "type": "prismatic", "bodies": ["ground", "belt"], "at": [0, 0, 0], "axis": [1, 0, 0],
        "drive": {"speed": 0.5}},
      {"name": "rub", "type": "prismatic", "bodies": ["belt", "block"], "at": [0, 0.1, 0], "axis": [1, 0, 0],
        "friction": {"limit": 4}},
      {"name": "hold", "type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0.1, 0], "axis": [1, 0, 0],
        "spring": {"stiffness": 50}}]})json");
  // In sixty steps: 0 is one of them.
  const ResponseDiagram d = follow_response(m, "joints.belt.drive.speed", -1, 1);
  INFO(d.message);
  REQUIRE(d.branches.size() >= 2);
  for (const ResponseBranch& branch : d.branches) {
    if (branch.points.size() == 1) continue; // held on the belt that stands
    INFO(branch.begin << "; " << branch.end);
    CHECK_THAT(branch.begin + branch.end, !ContainsSubstring("fold"));
    for (const ResponsePoint& p : branch.points) {
      const auto hold = std::ranges::find(p.coordinates, "hold", &CoordinateSolution::joint);
      CHECK_THAT(std::abs(hold->value), WithinAbs(0.08, 1e-9));
    }
  }
  CHECK(std::ranges::count(d.special, SpecialPointType::slip, &SpecialPoint::type) >= 1);
}

TEST_CASE("a clutch between two shafts slips up to where both turn alike, to the last digits") {
  // Alike at 25/6 rad/s, with 5/6 N m in the clutch.
  const Mechanism m = motor_and_load(half);
  for (const double to : {2., 0.9}) {
    const ResponseDiagram d = follow_response(m, "joints.c.friction.limit", 0.1, to);
    INFO(d.message);
    REQUIRE(d.special.size() == 1);
    CHECK(d.special[0].type == SpecialPointType::slip);
    CHECK_THAT(d.special[0].at.parameter, WithinRel(5. / 6, 1e-9));
    CHECK(d.branches.size() == 2);
  }
  Mechanism nearly = m;
  nearly.joints[2].coordinates[0].friction->limit = 5. / 6 - 1e-7;
  const Solution s = Analysis(nearly).solve();
  REQUIRE(s.status == Status::converged);
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].slips);
  CHECK_THAT(rate(s, "c"), WithinRel(-6e-7, 1e-6)); // (5/6 - T) (1 + 5) rad/s per N m
}

TEST_CASE("a damper that closes a loop balances a spring: the sizes of what it gives count") {
  const Mechanism m = clutch_and_brake(R"("damping": 0.01)", R"("spring": {"stiffness": 97})");
  SolveOptions nearest;
  nearest.nearest = true;
  const Solution s = Analysis(m).solve(nearest);
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_FALSE(s.fallback);
  CHECK_THAT(value(s, "brake"), WithinRel(0.01 * clutch_shaft_speed / 97, 1e-12));
}

TEST_CASE("the branch of a disc that a slipping clutch presses against a spring") {
  const Mechanism m = clutch_and_brake(half, R"("spring": {"stiffness": 100})");
  const ResponseDiagram d = follow_response(m, "joints.brake.spring.stiffness", 50, 200);
  INFO(d.message);
  REQUIRE(d.branches.size() == 1);
  CHECK(d.branches[0].points.front().parameter == 50);
  CHECK(d.branches[0].points.back().parameter == 200);
  for (const ResponsePoint& p : d.branches[0].points) {
    const auto brake = std::ranges::find(p.coordinates, "brake", &CoordinateSolution::joint);
    CHECK_THAT(brake->value, WithinRel(0.5 / p.parameter, 1e-9));
  }
}

TEST_CASE("a clutch slips beside a pendulum that its friction does not hold as drawn: it hangs") {
  const Mechanism m =
      clutch_and_brake(half, R"("damping": 0.1)", R"("friction": {"limit": 1}, "damping": 0.5)");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(rate(s, "clutch"), WithinRel(0.5 / 0.1 - clutch_shaft_speed, 1e-12));
  CHECK_THAT(value(s, "hinge"), WithinRel(-std::numbers::pi / 2, 1e-12));
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].joint == "clutch");
  CHECK(s.stable == true);

  SimulationOptions options;
  options.duration = 20;
  const Run motion = simulate(m, options);
  INFO(motion.message);
  CHECK_THAT(track(motion, "clutch").rate.back(), WithinRel(rate(s, "clutch"), 1e-6));
  // It sticks within its band: m g l sin(away) <= T.
  CHECK_THAT(track(motion, "hinge").value.back(), WithinAbs(value(s, "hinge"), std::asin(1 / 10.) + 1e-6));
}

TEST_CASE("a clutch holds beside a pendulum that hangs in balance") {
  const Mechanism m = clutch_and_brake(R"("friction": {"limit": 5})", R"("damping": 0.1)",
                                       R"("friction": {"limit": 1}, "damping": 0.5)");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(value(s, "clutch") == 0);
  CHECK_THAT(rate(s, "brake"), WithinRel(clutch_shaft_speed, 1e-12));
  CHECK_THAT(value(s, "hinge"), WithinRel(-std::numbers::pi / 2, 1e-12));
  REQUIRE(s.frictions.size() == 1);
  CHECK_THAT(s.frictions[0].value.value(), WithinRel(0.1 * clutch_shaft_speed, 1e-12));
  CHECK_THAT(s.message, ContainsSubstring("Friction holds clutch as drawn"));
}

TEST_CASE("what friction holds as drawn is not listed a second time where it would rest in balance") {
  const Mechanism m =
      clutch_and_brake(half, R"("damping": 0.1)", R"("friction": {"limit": 12}, "damping": 0.5)");
  const AllSolutions all = Analysis(m).solve_all();
  INFO(all.message);
  REQUIRE(all.equilibria.size() == 1);
  CHECK(value(all.equilibria[0], "hinge") == 0);
  const ResponseDiagram d = follow_response(m, "joints.hinge.friction.limit", 5, 15);
  INFO(d.message);
  // In balance up to the weight's 10 N m, and held as drawn beyond.
  REQUIRE(d.branches.size() == 2);
  for (const ResponseBranch& branch : d.branches) {
    const bool held = branch.points.front().frictions.size() == 2;
    CHECK_THAT(held ? branch.points.front().parameter : branch.points.back().parameter, WithinRel(10, 1e-9));
  }
}

TEST_CASE("the band of a spring that gives no more ends, though its state runs away") {
  // The spring gives less than 1 N m, however far it is turned; friction 2.
  const Mechanism m = clutch_and_brake(
      R"json("friction": {"limit": 2}, "spring": {"force": "=1 N m*tanh(deflection/(1 rad))"})json",
      R"("damping": 0.01)");
  const std::vector<RibbonPlace> places{{10, {}}, {20, {}}};
  const std::vector<RibbonPoint> ribbon = friction_ribbon(m, "joints.shaft.drive.speed", places);
  REQUIRE(ribbon.size() == 2);
  for (const RibbonPoint& point : ribbon)
    for (const BandExtent& extent : point.extents) {
      CAPTURE(extent.name, extent.low, extent.high);
      CHECK_FALSE(std::isfinite(extent.low)); // no bound is told
      CHECK_FALSE(std::isfinite(extent.high));
    }
}

TEST_CASE("friction's branches end at once where they are cancelled, and tell how far they have come") {
  const Mechanism m = clutch_and_brake(half, R"("damping": 0.01)");
  std::atomic<bool> cancel = false;
  double part = 0;
  BranchOptions options;
  options.cancel = &cancel;
  options.progress = [&](const Progress& now) {
    if (std::string_view(now.phase) != "following what rests on friction") return;
    CHECK(now.part >= part);
    part = now.part;
    cancel = cancel || part > 0.1;
  };
  ResponseDiagram d;
  add_friction_branches(m, "joints.brake.damping", 0.01, 0.1, options, d);
  CHECK(part > 0.1);
  CHECK(part < 0.2);
  CHECK(d.branches.empty());
}

TEST_CASE("a brake with friction turns with the shaft behind a sprung coupling, which gives way by T / k") {
  const Mechanism m = clutch_and_brake(R"("spring": {"stiffness": 100}, "damping": 0.5)", half);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "clutch"), WithinRel(-0.005, 1e-12));
  CHECK_THAT(rate(s, "brake"), WithinRel(clutch_shaft_speed, 1e-12));
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].value == -0.5);
  CHECK(s.stable == true);

  SimulationOptions options;
  options.duration = 5;
  const Run motion = simulate(m, options);
  INFO(motion.message);
  CHECK_THAT(track(motion, "clutch").value.back(), WithinRel(-0.005, 1e-6));
}

TEST_CASE("a slip that the drives give is told beside a rotor that turns a thousand times as fast") {
  Mechanism m = clutch_and_brake(half, R"("damping": 0.5, "spring": {"stiffness": 100})");
  m.bodies.push_back(body("rotor", 1, {3, 0, 0}, {0.01, 0.01, 0.02}));
  m.joints.push_back(
      driven(revolute("fast", "ground", "rotor", {3, 0, 0}, {0, 0, 1}), 1000 * clutch_shaft_speed));
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "brake"), WithinRel(0.005, 1e-12));
  CHECK_THAT(rate(s, "clutch"), WithinRel(-clutch_shaft_speed, 1e-12));
}
