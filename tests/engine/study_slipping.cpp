// Steady states that there are by dry friction alone: what it holds as drawn, and what slips at a constant
// rate against its limit, against closed forms and against the motion that settles.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/friction_branches.hpp"
#include "engine/study/friction_report.hpp"
#include "engine/study/sweep.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/solutions.hpp"

#include <string>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

// A shaft turned at 20 rad/s and a disc on it: joints between ground, shaft and disc, and forces on these.
Mechanism disc_on_shaft(const std::string& joints, const std::string& forces = "") {
  const std::string body = R"(, "mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.02]})";
  return read_scene(R"({"flyball": 2, "name": "Clutch", "bodies": [{"name": "shaft")" + body +
                    R"(, {"name": "disc")" + body + R"(],
    "joints": [{"name": "shaft", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "drive": {"speed": 20}}, )" +
                    joints + R"(], "forces": [)" + forces + "]}");
}

std::string turning(const std::string& name, const std::string& parent, const std::string& more) {
  return R"({"name": ")" + name + R"(", "type": "revolute", "bodies": [")" + parent +
         R"(", "disc"], "at": [0, 0, 0], "axis": [0, 0, 1], )" + more + "}";
}

// Two of 0.5 N s/m each at 0.3 m: 0.09 N m s against what turns.
const std::string paddles =
    R"({"name": "a", "type": "drag", "body": "disc", "at": [0.3, 0, 0], "linear": 0.5},
       {"name": "b", "type": "drag", "body": "disc", "at": [-0.3, 0, 0], "linear": 0.5})";

} // namespace

TEST_CASE("a clutch between two shafts in bearings of their own locks or slips") {
  const double limit = GENERATE(0.5, 0.9, 1.9);
  CAPTURE(limit);
  const Mechanism m = motor_and_load(R"("friction": {"limit": )" + number_text(limit) + "}");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  REQUIRE(s.frictions.size() == 1);
  const double taken = 0.2 * 5 / 1.2;
  const bool locks = limit > taken;
  CHECK(s.frictions[0].slips == !locks);
  CHECK_THAT(s.frictions[0].value.value(), WithinRel(locks ? taken : limit, 1e-10));
  CHECK_THAT(speed(s, "pa"), WithinRel(locks ? 5 / 1.2 : 5 - limit, 1e-10));
  CHECK_THAT(speed(s, "pb"), WithinRel(locks ? 5 / 1.2 : limit / 0.2, 1e-10));
  if (!locks) return;
  CHECK(value(s, "c") == 0);
  CHECK_THAT(s.message, ContainsSubstring("Friction holds c as drawn"));
  const Holding holding = find_holding(m, {});
  CHECK_THAT(holding.takes.value(), WithinRel(taken / limit, 1e-10));
}

TEST_CASE("a flexible coupling with friction has a band") {
  const Mechanism m =
      motor_and_load(R"("spring": {"stiffness": 10}, "damping": 0.1, "friction": {"limit": 0.3})");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "c"), WithinRel(-0.2 * 5 / 1.2 / 10, 1e-9));
  const FrictionReport report = report_friction(m, s);
  INFO(report.band.message);
  REQUIRE(report.band.found);
  const auto c = std::ranges::find(report.band.extents, "c", &BandExtent::name);
  REQUIRE(c != report.band.extents.end());
  CHECK_THAT(c->low, WithinRel(-(0.2 * 5 / 1.2 + 0.3) / 10, 1e-8));
  CHECK_THAT(c->high, WithinRel(-(0.2 * 5 / 1.2 - 0.3) / 10, 1e-8));
}

TEST_CASE("a clutch that slips drives against a brake: T / c") {
  const Mechanism m = disc_on_shaft(turning("clutch", "shaft", R"("friction": {"limit": 0.5})") + ", " +
                                    turning("brake", "ground", R"("damping": 0.1)"));
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "clutch"), WithinRel(0.5 / 0.1 - 20, 1e-12));
  CHECK_THAT(speed(s, "brake"), WithinRel(0.5 / 0.1, 1e-12));
  CHECK(s.stable == true);
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].slips);
  CHECK(s.frictions[0].value == 0.5);
  REQUIRE(s.drive_torques.size() == 1);
  CHECK_THAT(s.drive_torques[0].value, WithinRel(0.5, 1e-12));
  CHECK_THAT(s.message, ContainsSubstring("clutch slips at a constant rate"));
  expect_same_motion(m, s, "clutch", 10, 0);
}

TEST_CASE("friction in the brake, which closes the loop") {
  const Mechanism m = disc_on_shaft(turning("free", "shaft", R"("damping": 0.1)") + ", " +
                                    turning("brake", "ground", R"("friction": {"limit": 0.5})"));
  const Solution s = Analysis(m).solve();
  CHECK_THAT(speed(s, "brake"), WithinRel(20 - 0.5 / 0.1, 1e-12));
  expect_same_motion(m, s, "brake", 10, 0);
}

TEST_CASE("a disc that the air brakes: held by enough friction, slipping with less") {
  const Mechanism slips = disc_on_shaft(turning("free", "shaft", R"("friction": {"limit": 0.5})"), paddles);
  const Solution s = Analysis(slips).solve();
  CHECK_THAT(speed(s, "free"), WithinRel(-20 + 0.5 / 0.09, 1e-12));
  expect_same_motion(slips, s, "free", 10, 0);

  const Mechanism holds = disc_on_shaft(turning("free", "shaft", R"("friction": {"limit": 5})"), paddles);
  const Solution held = Analysis(holds).solve();
  INFO(held.message);
  REQUIRE(held.status == Status::converged);
  CHECK(value(held, "free") == 0);
  CHECK_FALSE(coordinate(held, "free").driven);
  REQUIRE(held.frictions.size() == 1);
  CHECK_FALSE(held.frictions[0].slips);
  CHECK_THAT(held.frictions[0].value.value(), WithinRel(0.09 * 20, 1e-12));
  CHECK_THAT(held.message, ContainsSubstring("takes 36 % of what it can give"));
  const FrictionReport report = report_friction(holds, held);
  CHECK_FALSE(report.band.found);
  CHECK_THAT(report.band.message, ContainsSubstring("no steady state without friction in it"));
  REQUIRE(report.speeds.size() == 1);
  CHECK_THAT(report.speeds[0].upper.value(), WithinRel(5 / 0.09, 1e-9));
}

TEST_CASE("without friction the disc in the air is not said to fly off by the centrifugal force") {
  Mechanism m = disc_on_shaft(
      turning("free", "shaft", R"json("spring": {"force": "=0.1 N m*tanh(deflection/(1 rad))"})json"),
      paddles);
  const Solution s = Analysis(m).solve();
  CHECK(s.status != Status::converged);
  CHECK_THAT(s.message, !ContainsSubstring("centrifugal"));
}

TEST_CASE("friction that carries a weight at every phase of the drive holds it") {
  for (const std::string spring : {"", R"(, "spring": {"stiffness": 200, "free": 0.2})"}) {
    const Mechanism m = read_scene(R"({"flyball": 2, "name": "Arm", "gravity": [0, -9.80665, 0],
      "bodies": [{"name": "arm", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
                 {"name": "b", "mass": 1, "position": [0.2, 0, 0]}],
      "joints": [{"name": "s", "type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
          "axis": [0, 0, 1], "drive": {"speed": 2}},
        {"name": "t", "type": "prismatic", "bodies": ["arm", "b"], "at": [0.2, 0, 0], "axis": [1, 0, 0],
          "coordinate": 0.2, "friction": {"limit": 20})" +
                                   spring + "}]}");
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(value(s, "t") == 0.2);
    CHECK(coordinate(s, "t").error == 0);
    // Hanging straight down, weight and m r w^2 pull alike.
    CHECK_THAT(s.frictions.at(0).value.value(), WithinRel(-9.80665 - 0.2 * 4, 1e-12));
    CHECK_THAT(s.message, ContainsSubstring("as drawn"));
    SolveOptions plain;
    plain.nearest = true;
    CHECK(Analysis(m).solve(plain).status == Status::no_steady_state);
  }
}

TEST_CASE("friction in the planet of a differential that slips, against the motion") {
  const auto wheel = [](const std::string& name, double inertia) {
    return R"({"name": ")" + name + R"(", "mass": 1, "position": [)" + (name == "planet" ? "0.05" : "0") +
           R"(, 0, 0], "inertia": [)" + number_text(inertia) + ", " + number_text(inertia) + ", " +
           number_text(2 * inertia) + "]}";
  };
  const auto joint = [](const std::string& name, const std::string& a, const std::string& b,
                        const std::string& more) {
    return R"({"name": ")" + name + R"(", "type": "revolute", "bodies": [")" + a + R"(", ")" + b +
           R"("], "at": [)" + (name == "planet" ? "0.05" : "0") + R"(, 0, 0], "axis": [0, 0, 1])" + more +
           "}";
  };
  const Mechanism m =
      read_scene(R"({"flyball": 2, "name": "Differential", "bodies": [)" + wheel("sun", 0.01) + ", " +
                 wheel("carrier", 0.01) + ", " + wheel("ring", 0.01) + ", " + wheel("planet", 1e-4) +
                 R"(], "joints": [)" +
                 joint("sun", "ground", "sun",
                       R"json(, "drive": {"torque": "=10 N m - 0.02 N m s*rate(sun)", "speed": 100})json") +
                 ", " + joint("carrier", "ground", "carrier", R"(, "damping": 0.3)") + ", " +
                 joint("ring", "ground", "ring", R"(, "damping": 0.4)") + ", " +
                 joint("planet", "carrier", "planet", R"(, "friction": {"limit": 0.5})") + ", " +
                 joint("sun_c", "carrier", "sun", "") + ", " + joint("ring_c", "carrier", "ring", "") + R"(,
      {"name": "m1", "type": "gear", "joints": ["sun_c", "planet"], "ratio": -1.5},
      {"name": "m2", "type": "gear", "joints": ["planet", "ring_c"], "ratio": 0.2857142857142857}]})");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.frictions.at(0).slips);
  expect_same_motion(m, s, "planet", 10, 0);
}

TEST_CASE("the load of a clutch rises: it holds up to T / w, then slips, in a sweep and in a branch") {
  const double limit = 0.5, speed = 20, change = limit / speed;
  const std::string load = "joints.brake.damping";
  const Mechanism m = disc_on_shaft(turning("clutch", "shaft", R"("friction": {"limit": 0.5})") + ", " +
                                    turning("brake", "ground", R"("damping": 0.01)"));
  for (const SweepPoint& p : sweep(m, std::vector<Variation>{{load, 0.01, 0.09, 5}})) {
    const double c = p.parameters[0];
    CAPTURE(c);
    REQUIRE(p.solution.status == Status::converged);
    REQUIRE(p.solution.frictions.size() == 1);
    CHECK(p.solution.frictions[0].slips == (c > change));
    CHECK_THAT(test::speed(p.solution, "brake"), WithinRel(c > change ? limit / c : speed, 1e-12));
  }
  for (const bool rises : {true, false}) {
    CAPTURE(rises);
    const ResponseDiagram d =
        rises ? follow_response(m, load, 0.01, 0.1) : follow_response(m, load, 0.1, 0.01);
    INFO(d.message);
    REQUIRE(d.status == Status::converged);
    REQUIRE(d.branches.size() == 2);
    REQUIRE(d.special.size() == 1);
    CHECK(d.special[0].type == SpecialPointType::slip);
    CHECK_THAT(d.special[0].at.parameter, WithinRel(change, 1e-10));
    CHECK(d.special[0].branch == 0);
    for (std::size_t b = 0; b < 2; ++b) {
      const std::vector<ResponsePoint>& points = d.branches[b].points;
      const bool slips = (b == 0) != rises;
      CHECK_THAT((b == 0 ? points.back() : points.front()).parameter, WithinRel(change, 1e-10));
      REQUIRE(points.size() > 8);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const ResponsePoint& p = points[i];
        REQUIRE(p.frictions.size() == 1);
        CHECK(p.frictions[0].slips == slips);
        CHECK(p.stable == true);
        CHECK_THAT(p.frictions[0].value.value(), WithinRel(slips ? limit : p.parameter * speed, 1e-9));
        const CoordinateSolution& clutch = p.coordinates.at(1);
        REQUIRE(clutch.joint == "clutch");
        REQUIRE(clutch.speed.has_value() == slips);
        if (slips) CHECK_THAT(*clutch.speed, WithinAbs(limit / p.parameter - speed, 1e-9));
        // Straight lines between points are no farther off than they are drawn.
        if (!slips || i == 0) continue;
        const double middle = (p.parameter + points[i - 1].parameter) / 2;
        CHECK_THAT((*clutch.speed + *points[i - 1].coordinates[1].speed) / 2,
                   WithinAbs(limit / middle - speed, 0.005 * speed));
      }
    }
  }
}

TEST_CASE(
    "a branch goes on where a steady state without friction ends, by what friction holds and lets slip") {
  // The spring gives 1 N m at most, which balances 0.09 w up to w = 11.1; as drawn it gives nothing, and
  // friction 2 N m.
  const Mechanism m = disc_on_shaft(
      turning("free", "shaft",
              R"json("friction": {"limit": 2}, "spring": {"force": "=1 N m*tanh(deflection/(1 rad))"})json"),
      paddles);
  const ResponseDiagram d = follow_response(m, "joints.shaft.drive.speed", 5, 30);
  INFO(d.message);
  REQUIRE(d.branches.size() == 2);
  CHECK(d.branches[0].points.front().frictions.empty());
  CHECK(d.branches[0].points.back().parameter < 1 / 0.09);
  const std::vector<ResponsePoint>& held = d.branches[1].points;
  CHECK(held.front().parameter == Approx(d.branches[0].points.back().parameter).epsilon(1e-9));
  CHECK(d.branches[1].begin == "a steady state without friction begins");
  CHECK_THAT(held.back().parameter, WithinRel(2 / 0.09, 1e-9));
}

TEST_CASE("slipping begins at a place of the grid as well as between two") {
  const double to = GENERATE(65., 66.3); // in sixty steps from 5: of 1, and of more
  // The paddles take 0.09 w, friction holds 0.9: up to 10 rad/s.
  const Mechanism m = disc_on_shaft(turning("free", "shaft", R"("friction": {"limit": 0.9})"), paddles);
  const ResponseDiagram d = follow_response(m, "joints.shaft.drive.speed", 5, to);
  INFO(d.message);
  REQUIRE(d.branches.size() == 2);
  for (const ResponseBranch& b : d.branches)
    CHECK((b.begin == "a joint with friction begins to slip, or sticks" ||
           b.end == "a joint with friction begins to slip, or sticks"));
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::slip);
  CHECK_THAT(d.special[0].at.parameter, WithinRel(10, 1e-9));
}

TEST_CASE("all steady states: what slips is listed, and bands tell of what friction holds") {
  const AllSolutions slipping =
      Analysis(disc_on_shaft(turning("free", "shaft", R"("friction": {"limit": 0.5})"), paddles)).solve_all();
  INFO(slipping.message);
  REQUIRE(slipping.equilibria.size() == 1);
  CHECK(slipping.equilibria[0].frictions.at(0).slips);
  CHECK_THAT(speed(slipping.equilibria[0], "free"), WithinRel(-20 + 0.5 / 0.09, 1e-12));
  CHECK_THAT(slipping.message, ContainsSubstring("No steady state without friction in it was found"));
  CHECK_THAT(slipping.message, ContainsSubstring("One rests on friction."));

  const AllSolutions held =
      Analysis(disc_on_shaft(turning("free", "shaft", R"("friction": {"limit": 5})"), paddles)).solve_all();
  REQUIRE(held.equilibria.size() == 1);
  CHECK_FALSE(held.equilibria[0].frictions.at(0).slips);

  const AllSolutions pendulum = Analysis(rubbing_pendulum(1.5)).solve_all();
  REQUIRE(pendulum.equilibria.size() == 2);
  for (const Solution& s : pendulum.equilibria)
    CHECK(s.frictions.empty());
}

TEST_CASE("of what slips at several speeds, or turns at several beside what is held, all are listed") {
  // A brake of 0.5 N m: it slips where the torque is that.
  Mechanism m;
  m.bodies = {body("disc", 1, {0, 0, 0}, {0.1, 0.1, 0.1})};
  const std::string three = "0.01 N m s^3 * (2 rad/s - rate(A)) * (5 rad/s - rate(A)) * (9 rad/s - rate(A))";
  m.joints = {torque_driven(revolute("A", "ground", "disc", {0, 0, 0}, {0, 1, 0}), 1, "0.5 N m + " + three)};
  m.joints[0].coordinates[0].friction = Friction{.limit = 0.5};
  validate(m);
  const AllSolutions one = Analysis(m).solve_all();
  std::vector<std::pair<double, std::optional<bool>>> found;
  for (const Solution& s : one.equilibria) {
    CHECK(s.frictions.at(0).slips);
    found.emplace_back(std::round(speed(s, "A") * 1e9) / 1e9, s.stable);
  }
  std::ranges::sort(found);
  CHECK(found == decltype(found){{2, true}, {5, false}, {9, true}});

  // It turns another with a brake of 0.6 N m, by 0.1 N m s of its speed.
  m.joints[0] = torque_driven(revolute("A", "ground", "disc", {0, 0, 0}, {0, 1, 0}), 1, three);
  m.bodies.push_back(body("other", 1, {1, 0, 0}, {0.1, 0.1, 0.1}));
  m.joints.push_back(torque_driven(revolute("B", "ground", "other", {1, 0, 0}, {0, 1, 0}), 1,
                                   "0.1 N m s * (rate(A) - rate(B))"));
  m.joints[1].coordinates[0].friction = Friction{.limit = 0.6};
  validate(m);
  std::vector<std::pair<double, double>> speeds;
  for (const Solution& s : Analysis(m).solve_all().equilibria)
    speeds.emplace_back(std::round(speed(s, "A") * 1e9) / 1e9, std::round(speed(s, "B") * 1e9) / 1e9);
  std::ranges::sort(speeds);
  CHECK(speeds == decltype(speeds){{2, 0}, {5, 0}, {9, 3}});
}

TEST_CASE("a clutch slips the way that its shafts turn at one of several speeds") {
  // Beyond 3 N m of the second shaft's torque, which its speed lets jump at 11 rad/s, Newton-Raphson comes to
  // speeds at which the clutch would slip the other way.
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {0, 1, 0}, {0.1, 0.1, 0.1})};
  m.joints = {
      torque_driven(revolute("A", "ground", "a", {0, 0, 0}, {0, 1, 0}), 15, "-0.3 N m - 0.3 N m s * rate(A)"),
      torque_driven(revolute("B", "ground", "b", {0, 1, 0}, {0, 1, 0}), 15,
                    "-2 N m + 3 N m * tanh((rate(B) - 11 rad/s) / (2 rad/s)) - 0.06 N m s * rate(B)"),
      revolute("clutch", "a", "b", {0, 0.5, 0}, {0, 1, 0})};
  m.joints[2].coordinates[0].friction = Friction{.limit = 2.7};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 1);
  for (const Solution& slipping : {s, all.equilibria[0]}) {
    CHECK_THAT(speed(slipping, "A"), WithinRel(-10, 1e-12));
    CHECK_THAT(speed(slipping, "B"), WithinRel(-2.3 / 0.06, 1e-12));
    CHECK(slipping.frictions.at(0).slips);
    CHECK(slipping.stable == true);
  }
  expect_same_motion(m, s, "B", 60, 1);
}

TEST_CASE("four shafts, each with friction in its bearing, slip on and on") {
  Mechanism m;
  m.name = "Four";
  for (int i = 0; i < 4; ++i) {
    const std::string n = std::to_string(i);
    m.bodies.push_back(body("s" + n, 1, {double(i), 0, 0}, {0.1, 0.1, 0.1}));
    Joint joint = revolute("p" + n, "ground", "s" + n, {double(i), 0, 0}, {0, 1, 0});
    joint.coordinates[0].friction = Friction{.limit = 0.2};
    joint.coordinates[0].drive = Drive{.speed = 5, .torque = 0};
    joint.formulas.push_back({"drive.torque", n + " N m + 2 N m - 0.5 N m s * rate(p" + n + ")"});
    m.joints.push_back(joint);
  }
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  for (int i = 0; i < 4; ++i)
    CHECK_THAT(speed(s, "p" + std::to_string(i)), WithinRel((i + 2 - 0.2) / 0.5, 1e-12));
}
