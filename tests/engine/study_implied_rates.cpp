// Constant rates that loops and gears ask for: planetary sets, differentials and parallelograms, driven at a
// speed or by a torque, against closed forms and motions that settle.
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/singular_loops.hpp"
#include "tests/catch.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Body wheel(const std::string& name, double inertia, const Vec3& at = Vec3::Zero()) {
  return body(name, 1, at, {inertia, inertia, 2 * inertia});
}

// Sun, one planet that weighs nothing, ring and carrier about z; the ring held.
constexpr double sun_teeth = 20, planet_teeth = 16, ring_teeth = 52;
Mechanism planetary(Joint sun, double carrier_damping) {
  Mechanism m;
  m.bodies = {wheel("sun", 0.1), wheel("carrier", 0.3), body("planet", 0, {0.9, 0, 0}, {0.02, 0.02, 0.03}),
              wheel("ring", 0.5)};
  m.joints = {std::move(sun),
              dampened(revolute("carrier", "ground", "carrier", {0, 0, 0}, {0, 0, 1}), carrier_damping),
              revolute("sun on carrier", "carrier", "sun", {0, 0, 0}, {0, 0, 1}),
              revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
              revolute("ring on carrier", "carrier", "ring", {0, 0, 0}, {0, 0, 1}),
              joint(JointType::fixed, "held", "ground", "ring", {0, 0, 0}, {0, 0, 1}),
              gear("inner mesh", "sun on carrier", "planet", -sun_teeth / planet_teeth),
              gear("outer mesh", "planet", "ring on carrier", planet_teeth / ring_teeth)};
  validate(m);
  return m;
}
Joint sun_joint() {
  return revolute("sun", "ground", "sun", {0, 0, 0}, {0, 0, 1});
}

void expect_willis(const Solution& s, double sun, double carrier) {
  CHECK_THAT(carrier, WithinRel(sun * sun_teeth / (sun_teeth + ring_teeth), 1e-12));
  CHECK_THAT(speed(s, "sun on carrier"), WithinRel(sun - carrier, 1e-12));
  CHECK_THAT(speed(s, "planet"), WithinRel(-(sun - carrier) * sun_teeth / planet_teeth, 1e-12));
  CHECK_THAT(speed(s, "ring on carrier"), WithinRel(-carrier, 1e-12));
}

double carrier_rate(const Solution& s) {
  const CoordinateSolution& c = coordinate(s, "carrier");
  // Of a joint that closes the loop it is told by the others.
  return c.speed ? *c.speed : -speed(s, "ring on carrier");
}

} // namespace

TEST_CASE("a joint that closes the loop tells at which rate it turns", "[implied]") {
  for (const bool by_torque : {false, true}) {
    CAPTURE(by_torque);
    Mechanism m = planetary(by_torque ? torque_driven(sun_joint(), 100, "10 N m - 0.02 N m s*rate(sun)")
                                      : driven(sun_joint(), 100),
                            3);
    m.joints[1].cut = true;
    const Solution s = Analysis(m).solve();
    const CoordinateSolution& carrier = coordinate(s, "carrier");
    REQUIRE(carrier.dependent);
    CHECK(carrier.driven);
    const double sun = by_torque ? speed(s, "sun") : 100;
    CHECK_THAT(carrier.speed.value(), WithinRel(sun * sun_teeth / (sun_teeth + ring_teeth), 1e-12));
    CHECK(carrier.speed_error < 1e-10);
    // Columns of studies are named by it.
    CHECK(found_number(coordinate(Analysis(m).summary().coordinates, "carrier")).value().name ==
          "carrier.speed");
  }
}

TEST_CASE("a planetary set turns as Willis says", "[implied]") {
  const double damping = 3;
  const double ratio = sun_teeth / (sun_teeth + ring_teeth);
  SECTION("at a given speed, which takes the carrier's load by the ratio") {
    const Solution s = Analysis(planetary(driven(sun_joint(), 100), damping)).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    expect_willis(s, 100, carrier_rate(s));
    REQUIRE(s.drive_torques.size() == 1);
    CHECK_THAT(s.drive_torques[0].value, WithinRel(damping * 100 * ratio * ratio, 1e-10));
    CHECK_FALSE(s.at_constant_speed);
  }
  SECTION("by a torque") {
    const Mechanism m = planetary(torque_driven(sun_joint(), 50, "40 N m - 0.1 N m s * rate(sun)"), damping);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "sun"), WithinRel(40 / (0.1 + damping * ratio * ratio), 1e-12));
    expect_willis(s, speed(s, "sun"), carrier_rate(s));
    CHECK(s.stable == true);
    // One speed is left: its inertia at the sun.
    const double sun = 0.2, carrier = 0.6, planet = 0.03,
                 planet_rate = (1 - ratio) * sun_teeth / planet_teeth;
    const double inertia = sun + carrier * ratio * ratio + planet * std::pow(ratio - planet_rate, 2);
    REQUIRE(s.eigenvalues->size() == 1);
    CHECK_THAT(-(*s.eigenvalues)[0].real(), WithinRel((0.1 + damping * ratio * ratio) / inertia, 1e-9));
    SimulationOptions run;
    run.duration = 40 * inertia / (0.1 + damping * ratio * ratio);
    run.rate = 2 / run.duration;
    const Run motion = simulate(m, run);
    REQUIRE(motion.status == RunStatus::completed);
    for (const CoordinateTrack& track : motion.coordinates)
      if (track.joint == "sun") CHECK_THAT(track.rate.back(), WithinRel(speed(s, "sun"), 1e-7));
  }
}

TEST_CASE("a differential shares the torque and not the speed", "[implied]") {
  const double left = 2, right = 5, engine = 30;
  Mechanism m;
  m.bodies = {body("case", 4, {0, 0, 0}, {0.2, 0.1, 0.1}), body("left", 3, {-0.5, 0, 0}, {0.3, 0.2, 0.2}),
              body("right", 3, {0.5, 0, 0}, {0.3, 0.2, 0.2}),
              body("planet", 0.2, {0, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {torque_driven(revolute("case", "ground", "case", {0, 0, 0}, {1, 0, 0}), 4,
                            "30 N m - 0.5 N m s * rate(case)"),
              dampened(revolute("left", "ground", "left", {-0.5, 0, 0}, {1, 0, 0}), left),
              dampened(revolute("right", "ground", "right", {0.5, 0, 0}, {1, 0, 0}), right),
              revolute("planet", "case", "planet", {0, 0, 0}, {0, 0, 1}),
              revolute("left in case", "case", "left", {-0.2, 0, 0}, {1, 0, 0}),
              revolute("right in case", "case", "right", {0.2, 0, 0}, {1, 0, 0}),
              gear("left mesh", "planet", "left in case", 1),
              gear("right mesh", "planet", "right in case", -1)};
  const bool of_case =
      GENERATE(true, false); // the joints that are coordinates: to the case, or to the ground
  if (!of_case) m.joints[1].cut = m.joints[2].cut = false;
  CAPTURE(of_case);
  validate(m);
  const Solution s = Analysis(m).solve();
  const auto wheel_rate = [&](const std::string& wheel) {
    return of_case ? speed(s, "case") + speed(s, wheel + " in case") : speed(s, wheel);
  };
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // w = (w_l + w_r) / 2 and c_l w_l = c_r w_r = (T - 0.5 w) / 2
  const double share = engine / (2 + 0.25 * (1 / left + 1 / right));
  CHECK_THAT(wheel_rate("left"), WithinRel(share / left, 1e-11));
  CHECK_THAT(wheel_rate("right"), WithinRel(share / right, 1e-11));
  CHECK_THAT(speed(s, "case"), WithinRel((share / left + share / right) / 2, 1e-11));
  CHECK_THAT(speed(s, "planet"), WithinRel((share / left - share / right) / 2, 1e-11));
  CHECK(s.stable == true);
  CHECK(s.eigenvalues->size() == 2);
  SimulationOptions run;
  run.duration = 20;
  run.rate = 0.1;
  const Run motion = simulate(m, run);
  INFO(motion.message);
  REQUIRE(motion.status == RunStatus::completed);
  for (const CoordinateTrack& track : motion.coordinates)
    if (track.joint == "left" || track.joint == "right")
      CHECK_THAT(track.rate.back(), WithinRel(wheel_rate(track.joint), 1e-7));
}

TEST_CASE("dampers that were alike, of wheels behind a differential, may become unlike", "[implied]") {
  // The planet pushes nothing while the wheels turn alike. What it hangs on is drawn off the axis.
  const double torque = 10;
  const auto with_dampers = [&](double left, double right) {
    Mechanism m;
    m.bodies = {body("case", 4, {0, 0, 0}, {0.2, 0.1, 0.1}), body("left", 3, {-0.5, 0, 0}, {0.3, 0.2, 0.2}),
                body("right", 3, {0.5, 0, 0}, {0.3, 0.2, 0.2}),
                body("planet", 0.2, {0, 0.2, 0}, {0.01, 0.01, 0.01})};
    m.joints = {torque_driven(revolute("case", "ground", "case", {0, 0, 0}, {1, 0, 0}), 10, "10"),
                dampened(revolute("left", "ground", "left", {-0.4, 0, 0}, {1, 0, 0}), left),
                dampened(revolute("right", "ground", "right", {0.4, 0, 0}, {1, 0, 0}), right),
                revolute("planet", "case", "planet", {0, 0.2, 0}, {0, 1, 0}),
                revolute("left in case", "case", "left", {-0.1, 0, 0}, {1, 0, 0}),
                revolute("right in case", "case", "right", {0.1, 0, 0}, {1, 0, 0}),
                gear("left mesh", "planet", "left in case", -1),
                gear("right mesh", "planet", "right in case", 1)};
    validate(m);
    return m;
  };
  Analysis analysis(with_dampers(1, 1));
  for (const auto& [left, right] : {std::pair{1., 1.}, std::pair{1., 0.5}, std::pair{2., 0.5}}) {
    CAPTURE(left, right);
    analysis.update(with_dampers(left, right));
    SolveOptions warm;
    warm.warm = true;
    const Solution s = analysis.solve(warm);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "case"), WithinRel(torque * (1 / left + 1 / right) / 4, 1e-11));
    CHECK_THAT(speed(s, "planet"), WithinAbs(torque * (1 / right - 1 / left) / 4, 1e-10));
    CHECK(s.stable == true);
  }
}

TEST_CASE("a wheel that stands while nothing turns it turns as soon as something does", "[implied]") {
  const auto with_torque = [](double torque) {
    Mechanism m;
    m.bodies = {body("shaft", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("wheel", 2, {0, 1, 0}, {0.2, 0.1, 0.1})};
    m.joints = {torque_driven(revolute("shaft", "ground", "shaft", {0, 0, 0}, {1, 0, 0}), 4,
                              "3 N m - 0.5 N m s * rate(shaft)"),
                dampened(revolute("wheel", "ground", "wheel", {0, 1, 0}, {1, 0, 0}), 0.4)};
    Force push;
    push.name = "push";
    push.type = ForceType::torque;
    push.body = "wheel";
    push.vector = {torque, 0, 0};
    m.forces = {push};
    validate(m);
    return m;
  };
  Analysis analysis(with_torque(0));
  REQUIRE(analysis.solve().status == Status::converged);
  analysis.update(with_torque(2));
  SolveOptions warm;
  warm.warm = true;
  const Solution s = analysis.solve(warm);
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "wheel"), WithinRel(5., 1e-11));
  CHECK_THAT(speed(s, "shaft"), WithinRel(6., 1e-11));
}

TEST_CASE("what is carried round while it weighs nothing hangs as soon as it weighs something") {
  // From a bearing on a shaft that turns, which drags at it, and from one on the ground.
  const double drag = 0.01, turning = 5, arm = 0.2;
  const auto with_mass = [&](double mass) {
    Mechanism m;
    m.gravity = {0, -9.81, 0};
    m.bodies = {body("shaft", 1, {0, 0, 0}, {0.01, 0.01, 0.01}), body("bob", mass, {0, -arm, 0})};
    m.joints = {driven(revolute("drive", "ground", "shaft", {0, 0, 0}, {0, 0, 1}), turning),
                dampened(revolute("on shaft", "shaft", "bob", {0, 0, 0.1}, {0, 0, 1}), drag),
                revolute("on ground", "ground", "bob", {0, 0, -0.1}, {0, 0, 1})};
    validate(m);
    return m;
  };
  Analysis analysis(with_mass(0));
  REQUIRE(analysis.solve().status == Status::converged);
  for (const double mass : {1., 0.5, 0., 2.}) {
    CAPTURE(mass);
    analysis.update(with_mass(mass));
    const Solution s = analysis.solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    if (mass > 0)
      CHECK_THAT(coordinate(s, "on ground").value,
                 WithinAbs(std::asin(drag * turning / (mass * 9.81 * arm)), 1e-11));
  }
}

TEST_CASE("numbers that make something turn for a while leave no trace in the answers after them") {
  // Two shafts turn against each other and drag at a pendulum, which turns with them while it weighs nothing.
  const double speed_of_shafts = 5, left = 0.1, right = 0.2, arm = 0.2;
  const auto with_mass = [&](double mass) {
    Mechanism m;
    m.gravity = {0, -9.81, 0};
    m.bodies = {body("left", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("right", 1, {0, 0, 1}, {0.1, 0.1, 0.1}),
                body("bob", mass, {0, -arm, 0.5})};
    m.joints = {driven(revolute("left", "ground", "left", {0, 0, 0}, {0, 0, 1}), speed_of_shafts),
                driven(revolute("right", "ground", "right", {0, 0, 1}, {0, 0, 1}), -speed_of_shafts),
                revolute("hang", "ground", "bob", {0, 0, 0.5}, {0, 0, 1}),
                dampened(revolute("on left", "left", "bob", {0, 0, 0.2}, {0, 0, 1}), left),
                dampened(revolute("on right", "right", "bob", {0, 0, 0.8}, {0, 0, 1}), right)};
    validate(m);
    return m;
  };
  const double moment = (left - right) * speed_of_shafts;
  const auto check = [&](const Solution& s, double mass) {
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_FALSE(s.turned);
    if (mass > 0)
      CHECK_THAT(coordinate(s, "hang").value, WithinAbs(std::asin(moment / (mass * 9.81 * arm)), 1e-11));
    else
      CHECK_THAT(speed(s, "hang"), WithinRel(moment / (left + right), 1e-11));
  };
  const std::vector<double> masses{1, 0, 0.5, 0, 0, 2, 1};
  SECTION("as in the window") {
    Analysis analysis(with_mass(1));
    for (const double mass : masses) {
      CAPTURE(mass);
      analysis.update(with_mass(mass));
      SolveOptions warm;
      warm.warm = true;
      check(analysis.solve(warm), mass);
    }
  }
  SECTION("as in a sweep") {
    Analysis analysis(with_mass(1));
    analysis.vary(std::vector<std::string>{"bodies.bob.mass"});
    for (const double mass : masses) {
      CAPTURE(mass);
      analysis.set(std::vector{mass});
      check(analysis.solve(), mass);
    }
  }
}

TEST_CASE("two drives of a planetary set may begin alike, where the planet seems to stand", "[implied]") {
  const double apart = GENERATE(0., 1e-6, 1e-3, 5.);
  CAPTURE(apart);
  const auto at_centre = [](const std::string& name) {
    return revolute(name, "ground", name, {0, 0, 0}, {0, 0, 1});
  };
  Mechanism m;
  m.bodies = {wheel("carrier", 0.15), wheel("sun", 0.05), wheel("ring", 0.25),
              body("planet", 0.4, {0.9, 0, 0}, {0.02, 0.02, 0.02})};
  m.joints = {torque_driven(at_centre("carrier"), 10 + apart, "0 N m - 0.4 N m s * rate(carrier)"),
              torque_driven(at_centre("sun"), 10, "10 N m - 0.1 N m s * rate(sun)"),
              dampened(at_centre("ring"), 0.2),
              revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
              revolute("sun on carrier", "carrier", "sun", {0, 0, 0}, {0, 0, 1}),
              revolute("ring on carrier", "carrier", "ring", {0, 0, 0}, {0, 0, 1}),
              gear("inner mesh", "sun on carrier", "planet", -sun_teeth / planet_teeth),
              gear("outer mesh", "planet", "ring on carrier", planet_teeth / ring_teeth)};
  m.joints[1].cut = m.joints[2].cut = false;
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // The ring at r = (1 + k) c - k s; what it brakes with, 0.2 r, is shared by the sun and the carrier:
  // 10 - 0.1 s + 0.2 k r = 0 and -0.4 c - 0.2 (1 + k) r = 0.
  const double k = sun_teeth / ring_teeth;
  Eigen::Matrix2d a;
  a << -0.1 - 0.2 * k * k, 0.2 * k * (1 + k), 0.2 * (1 + k) * k, -0.4 - 0.2 * (1 + k) * (1 + k);
  const Eigen::Vector2d speeds = a.inverse() * Eigen::Vector2d(-10, 0);
  CHECK_THAT(speed(s, "sun"), WithinRel(speeds[0], 1e-11));
  CHECK_THAT(speed(s, "carrier"), WithinRel(speeds[1], 1e-11));
  CHECK_THAT(speed(s, "planet"), WithinRel(-(speeds[0] - speeds[1]) * sun_teeth / planet_teeth, 1e-11));
  CHECK(s.stable == true);
}

namespace {

// Carrier, sun and ring on the ground about one axis, one planet.
Mechanism three_shafts(Joint carrier, Joint sun, Joint ring) {
  Mechanism m;
  m.bodies = {wheel("carrier", 0.15), wheel("sun", 0.05), wheel("ring", 0.25),
              body("planet", 0.4, {0.9, 0, 0}, {0.02, 0.02, 0.02})};
  m.joints = {std::move(carrier),
              std::move(sun),
              std::move(ring),
              revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
              revolute("sun on carrier", "carrier", "sun", {0, 0, 0}, {0, 0, 1}),
              revolute("ring on carrier", "carrier", "ring", {0, 0, 0}, {0, 0, 1}),
              gear("inner mesh", "sun on carrier", "planet", -sun_teeth / planet_teeth),
              gear("outer mesh", "planet", "ring on carrier", planet_teeth / ring_teeth)};
  m.joints[1].cut = m.joints[2].cut = false;
  return m;
}

Joint shaft(const std::string& name) {
  return revolute(name, "ground", name, {0, 0, 0}, {0, 0, 1});
}

// Torques a - b w of the three: with k = sun / ring teeth, r = (1 + k) c - k s, and a torque t on the ring
// comes as (1 + k) t to the carrier and -k t to the sun.
struct ThreeTorques {
  double a[3], b[3]; // carrier, sun, ring
  Eigen::Vector2d speeds() const {
    const double k = sun_teeth / ring_teeth;
    const Eigen::Vector2d ring(1 + k, -k);
    Eigen::Matrix2d m = Eigen::Vector2d(b[0], b[1]).asDiagonal();
    m += b[2] * ring * ring.transpose();
    return m.inverse() * (Eigen::Vector2d(a[0], a[1]) + a[2] * ring);
  }
};

std::string line(const std::string& name, double a, double b) {
  return number_text(a) + " N m - " + number_text(b) + " N m s * rate(" + name + ")";
}

} // namespace

TEST_CASE("drives on all three shafts of a planetary set may begin at any speeds", "[implied]") {
  const ThreeTorques given{{0.5, 10, -2}, {0.4, 0.1, 0.2}};
  const Eigen::Vector2d speeds = given.speeds();
  for (const auto& start :
       {std::array{10., 10., -15.8}, std::array{10., 10., 10.}, std::array{3., -7., 1.}}) {
    CAPTURE(start[0], start[1], start[2]);
    const auto drive = [&](const std::string& name, std::size_t i) {
      return torque_driven(shaft(name), start[i], line(name, given.a[i], given.b[i]));
    };
    const Mechanism m = three_shafts(drive("carrier", 0), drive("sun", 1), drive("ring", 2));
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "carrier"), WithinRel(speeds[0], 1e-11));
    CHECK_THAT(speed(s, "sun"), WithinRel(speeds[1], 1e-11));
    CHECK(s.stable == true);
  }
  // Two at given speeds, alike or not: the third follows.
  for (const double second : {6., 5., 0.}) {
    CAPTURE(second);
    const double first = second == 0 ? 0 : 6;
    const Mechanism m = three_shafts(torque_driven(shaft("carrier"), 2, line("carrier", 1, 0.4)),
                                     driven(shaft("sun"), first), driven(shaft("ring"), second));
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const double k = sun_teeth / ring_teeth;
    CHECK(std::abs(speed(s, "carrier") - (second + k * first) / (1 + k)) < 1e-12);
  }
}

TEST_CASE("both cranks of a parallelogram may have drives that begin apart", "[implied]") {
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0.15, 0}, {0.01, 0.01, 0.01}), body("c", 2, {0.5, 0.3, 0}, {0.1, 0.1, 0.2}),
              body("b", 1, {1, 0.15, 0}, {0.01, 0.01, 0.01})};
  const auto crank = [&](const std::string& name, double x, double guess, double torque) {
    return torque_driven(revolute(name, "ground", name, {x, 0, 0}, {0, 0, 1}), guess,
                         line(name, torque, 0.5));
  };
  m.joints = {crank("a", 0, 5, 3), crank("b", 1, 3, 1), revolute("ac", "a", "c", {0, 0.3, 0}, {0, 0, 1}),
              revolute("bc", "c", "b", {1, 0.3, 0}, {0, 0, 1})};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "a"), WithinRel(4, 1e-12));
  CHECK_THAT(speed(s, "b"), WithinRel(4, 1e-12));
  m.joints[0] = driven(revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}), 2);
  CHECK_THAT(speed(Analysis(m).solve(), "b"), WithinRel(2, 1e-12));
}

TEST_CASE("a brake of a planetary set holds or slips", "[implied][friction]") {
  const ThreeTorques given{{-5, 0, 3}, {0.3, 0, 0.4}};
  const double k = sun_teeth / ring_teeth;
  // With the sun held c and r = (1 + k) c; the sun takes what is left.
  const double c = (given.a[0] + (1 + k) * given.a[2]) / (given.b[0] + (1 + k) * (1 + k) * given.b[2]),
               ring = given.a[2] - given.b[2] * (1 + k) * c, needed = std::abs(k * ring);
  const auto braked = [&](double limit) {
    Joint sun = shaft("sun");
    sun.coordinates[0].friction.emplace().limit = limit;
    return three_shafts(torque_driven(shaft("carrier"), -16, line("carrier", given.a[0], given.b[0])), sun,
                        torque_driven(shaft("ring"), 8, line("ring", given.a[2], given.b[2])));
  };
  const Mechanism firm = braked(1.25 * needed), weak = braked(0.8 * needed);
  validate(firm);
  const Solution held = Analysis(firm).solve();
  INFO(held.message);
  REQUIRE(held.status == Status::converged);
  CHECK_THAT(speed(held, "carrier"), WithinRel(c, 1e-11));
  CHECK_THAT(held.message, ContainsSubstring("takes 80 % of what it can give"));
  const Solution slips = Analysis(weak).solve();
  INFO(slips.message);
  REQUIRE(slips.status == Status::converged);
  CHECK_THAT(slips.message, ContainsSubstring("slips"));
  ThreeTorques with_limit = given;
  with_limit.a[1] = 0.8 * needed; // either way
  const Eigen::Vector2d a = with_limit.speeds();
  with_limit.a[1] = -with_limit.a[1];
  const Eigen::Vector2d b = with_limit.speeds();
  const double found = speed(slips, "carrier");
  CHECK(std::min(std::abs(found - a[0]), std::abs(found - b[0])) < 1e-10);
}

TEST_CASE("a wheel on a bearing turns at the speed that its air gives it", "[implied]") {
  // The shaft drags it along by the bearing's oil, the air holds it back.
  Mechanism m;
  m.bodies = {wheel("shaft", 0.1), wheel("disc", 0.2)};
  Joint bearing = dampened(revolute("bearing", "shaft", "disc", {0, 0, 0}, {0, 0, 1}), 0.3);
  m.joints = {driven(revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 0, 1}), 10), bearing};
  for (const double side : {1., -1.}) {
    Force air;
    air.name = side > 0 ? "air1" : "air2";
    air.type = ForceType::drag;
    air.body = "disc";
    air.at = Vec3(side * 0.5, 0, 0);
    air.linear = 0.4;
    m.forces.push_back(air);
  }
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // 0.3 r + 2 * 0.4 * 0.5^2 (10 + r) = 0
  CHECK_THAT(speed(s, "bearing"), WithinRel(-0.2 * 10 / 0.5, 1e-12));
  CHECK(s.stable == true);
  CHECK_THAT(s.drive_torques.at(0).value, WithinRel(0.3 * 4, 1e-11));
}

TEST_CASE("gears lead the torque of a drive to others", "[implied]") {
  Mechanism m;
  m.bodies = {wheel("a", 0.1), wheel("b", 0.2, {1, 0, 0})};
  m.joints = {dampened(torque_driven(revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}), 5, "12"), 0.5),
              dampened(revolute("b", "ground", "b", {1, 0, 0}, {0, 0, 1}), 0.25), gear("mesh", "a", "b", -3)};
  SECTION("one drive") {
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "a"), WithinRel(12 / (0.5 + 9 * 0.25), 1e-13));
    CHECK_THAT(speed(s, "b"), WithinRel(-3 * 12 / (0.5 + 9 * 0.25), 1e-13));
    REQUIRE(s.drive_torques.size() == 1);
    CHECK_THAT(s.drive_torques[0].value, WithinRel(12, 1e-12));
    REQUIRE(s.gears.size() == 1);
    CHECK_THAT(std::abs(s.gears[0].b), WithinRel(0.25 * std::abs(speed(s, "b")), 1e-12));
    REQUIRE(s.eigenvalues->size() == 1);
    CHECK_THAT((*s.eigenvalues)[0].real(), WithinRel(-(0.5 + 9 * 0.25) / (0.2 + 9 * 0.4), 1e-11));
    REQUIRE(s.at_constant_speed);
  }
  SECTION("two drives add up") {
    m.joints[1] = dampened(torque_driven(m.joints[1], 5, "-2"), 0.25);
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "a"), WithinRel((12 + 3 * 2) / (0.5 + 9 * 0.25), 1e-13));
    CHECK(simulate(m, {}).status == RunStatus::completed); // their guesses do not fit
  }
  SECTION("none, and nothing resists") {
    m.joints[0] = torque_driven(revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}), 5, "0");
    m.joints[1] = revolute("b", "ground", "b", {1, 0, 0}, {0, 0, 1});
    validate(m);
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("Nothing determines the speeds of a and b together"));
  }
  SECTION("a given speed at one end and a torque at the other") {
    m.joints[1] = driven(revolute("b", "ground", "b", {1, 0, 0}, {0, 0, 1}), 3);
    const auto found = find_mistakes(m);
    REQUIRE(found.size() == 1);
    CHECK(found[0].where() == "joints.mesh");
    CHECK_THAT(found[0].expected(), ContainsSubstring("drives of one kind"));
  }
}

TEST_CASE("a parallelogram's crank turns the rocker", "[implied]") {
  Mechanism m;
  m.bodies = {body("crank", 1, {0, 0.15, 0}, {0.01, 0.01, 0.01}),
              body("coupler", 2, {0.5, 0.3, 0}, {0.1, 0.1, 0.2}),
              body("rocker", 1, {1, 0.15, 0}, {0.01, 0.01, 0.01})};
  m.joints = {driven(revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}), 10),
              revolute("pin", "crank", "coupler", {0, 0.3, 0}, {0, 0, 1}),
              dampened(revolute("rocker", "ground", "rocker", {1, 0, 0}, {0, 0, 1}), 0.7),
              revolute("end", "coupler", "rocker", {1, 0.3, 0}, {0, 0, 1})};
  SECTION("at a given speed") {
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "pin"), WithinRel(-10, 1e-12));
    CHECK_THAT(speed(s, "rocker"), WithinRel(10, 1e-12));
    CHECK_THAT(s.drive_torques.at(0).value, WithinRel(7, 1e-10));
  }
  SECTION("by a torque") {
    m.joints[0] = torque_driven(revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}), 5,
                                "8 N m - 0.1 N m s * rate(crank)");
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "crank"), WithinRel(10, 1e-12));
    CHECK_THAT(speed(s, "pin"), WithinRel(-10, 1e-12));
    CHECK(s.stable == true);
  }
  SECTION("no parallelogram, no steady state") {
    m.bodies[2].position.x() = 1.05;
    m.joints[2].at.x() = 1.1;
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::no_steady_state);
    CHECK_THAT(s.message, !ContainsSubstring("change point"));
  }
  // Turned by an angle from where all its bodies are in one line.
  const auto turned_to = [&](double angle) {
    const Vec3 arm = 0.3 * Vec3(std::cos(angle), std::sin(angle), 0), far = Vec3::UnitX();
    m.bodies[0].position = arm / 2;
    m.bodies[1].position = arm + far / 2;
    m.bodies[2].position = far + arm / 2;
    m.joints[1].at = arm;
    m.joints[3].at = far + arm;
  };
  SECTION("drawn flat, or as good as that, it is told to stand at a change point") {
    // There the coupler's rate does not follow from the loop: it could as well go over to an
    // antiparallelogram.
    const double angle = GENERATE(0., 3e-13, 1e-11, std::numbers::pi);
    const bool torque = GENERATE(false, true), damped = GENERATE(false, true);
    CAPTURE(angle, torque, damped);
    turned_to(angle);
    if (torque)
      m.joints[0] = torque_driven(revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}), 5,
                                  "8 N m - 0.1 N m s * rate(crank)");
    if (!damped) m.joints[2].coordinates[0].damping = 0;
    const Solution s = Analysis(m).solve();
    CHECK(s.status != Status::converged);
    CHECK_THAT(s.message, Catch::Matchers::StartsWith("No steady state was found: the loop of"));
    CHECK_THAT(s.message, ContainsSubstring("is drawn at a change point"));
    CHECK_THAT(s.message, !ContainsSubstring("runs away"));
  }
  SECTION("turned on a little, as it is told, it has its steady state") {
    const bool torque = GENERATE(false, true);
    turned_to(1e-7);
    if (torque)
      m.joints[0] = torque_driven(revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}), 5,
                                  "8 N m - 0.1 N m s * rate(crank)");
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "rocker"), WithinRel(10, 1e-9));
    const int end[]{0};
    CHECK_FALSE(find_change_point(m, compile_for_drives(m), end));
  }
  SECTION("of several loops that which is drawn so is found, and looking for it can be ended") {
    turned_to(0.3);
    m.bodies.push_back(body("second rod", 2, {1.5, 0.1, 0}, {0.1, 0.1, 0.2}));
    m.bodies.push_back(body("second rocker", 1, {2, 0.05, 0}, {0.01, 0.01, 0.01}));
    const double angle = GENERATE(0., 0.3);
    const Vec3 arm = 0.2 * Vec3(std::cos(angle), std::sin(angle), 0), from = Vec3::UnitX();
    m.bodies[3].position = from + arm + from / 2;
    m.bodies[4].position = 2 * from + arm / 2;
    m.joints.push_back(revolute("second pin", "rocker", "second rod", from + arm, {0, 0, 1}));
    m.joints.push_back(revolute("second", "ground", "second rocker", 2 * from, {0, 0, 1}));
    m.joints.push_back(revolute("second end", "second rod", "second rocker", 2 * from + arm, {0, 0, 1}));
    const System system = compile_for_drives(m);
    REQUIRE(system.cuts.size() == 2);
    const int both[]{0, 1};
    const std::optional<int> flat = find_change_point(m, system, both);
    CHECK(flat.has_value() == (angle == 0));
    if (flat)
      CHECK_THAT(m.joints[static_cast<std::size_t>(system.cuts[static_cast<std::size_t>(*flat)].joint)].name,
                 Catch::Matchers::StartsWith("second"));
    const std::atomic<bool> cancel = true;
    const Interruptible scope(&cancel);
    CHECK_THROWS_AS(find_change_point(m, system, both), Interrupted);
  }
  SECTION("driven at its dead point a rocker is at no change point") {
    // Crank and coupler in line: the rocker, which is driven, can go one way only.
    m.bodies[0].position = {0.1, 0, 0};
    m.bodies[1].position = {0.5, 0, 0};
    m.bodies[2].position = {0.9, 0.25, 0};
    m.joints[1].at = {0.2, 0, 0};
    m.joints[3].at = {0.8, 0, 0};
    m.joints[2] = driven(revolute("rocker", "ground", "rocker", {1, 0.5, 0}, {0, 0, 1}), 1);
    m.joints[0].coordinates[0].drive.reset();
    const Solution s = Analysis(m).solve();
    CHECK(s.status != Status::converged);
    CHECK_THAT(s.message, !ContainsSubstring("change point"));
  }
  SECTION("left to itself it keeps no momentum, as it turns others") {
    m.joints[0].coordinates[0].drive->keeps = DriveKeeps::momentum;
    try {
      Analysis(m).solve();
      FAIL("it was not refused");
    } catch (const SceneError& error) {
      CHECK(error.where() == "joints.crank.drive.keeps");
      CHECK_THAT(error.expected(),
                 Catch::Matchers::StartsWith("expected speed, or no loop that makes others turn with crank"));
    }
  }
  SECTION("beside what falls there is no equilibrium, and no drive that lacks anything") {
    m.gravity = {0, -standard_gravity, 0};
    m.bodies.push_back(body("block", 1, {2, 0, 0}));
    m.joints.push_back(prismatic("fall", "ground", "block", {2, 0, 0}, Vec3::UnitY()));
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("fall"));
  }
  SECTION("in its weight it takes a torque that changes") {
    m.gravity = {0, -standard_gravity, 0};
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged); // at a given speed the drive gives what it takes
    const DriveTorque& drive = s.drive_torques.at(0);
    CHECK(drive.varying);
    // Twice a turn it passes a flat pose, a change point, a quarter turn from where it is drawn.
    const double amplitude = (1 * 0.15 + 2 * 0.3 + 1 * 0.15) * standard_gravity;
    REQUIRE(drive.range);
    CHECK_THAT(drive.range->mean, WithinRel(7, 1e-9));
    CHECK_THAT(drive.range->most, WithinRel(7 + amplitude, 1e-7));
    CHECK_THAT(drive.range->least, WithinRel(7 - amplitude, 1e-7));
    m.joints[0] = torque_driven(revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}), 5, "8");
    CHECK(Analysis(m).solve().status == Status::no_steady_state);
  }
}

TEST_CASE("a steady state that the equations have no place for is not denied", "[implied]") {
  // A shaft that twists, its far end in a bearing of its own with a gear on it: it turns steadily, twisted by
  // the torque that the geared wheel takes, and so is found as a motion alone.
  Mechanism m;
  m.bodies = {wheel("near", 0.1), wheel("far", 0.2, {0, 0, 0.5}), wheel("geared", 0.3, {1, 0, 0.5})};
  m.joints = {torque_driven(revolute("p", "ground", "near", {0, 0, 0}), 5, "2 N m - 0.2 N m s*rate(p)"),
              dampened(sprung(revolute("twist", "near", "far", {0, 0, 0.5}), 20), 0.1),
              dampened(revolute("q", "ground", "geared", {1, 0, 0.5}), 0.05),
              revolute("bearing", "ground", "far", {0, 0, 0.5}), gear("g", "bearing", "q", -2)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  CHECK((s.status == Status::converged || s.message.starts_with("No steady state was found: as the drives")));
  // A crank and a rocker turn together, too, but at no constant rates: there is none.
  const auto without = [](Mechanism linkage) { return Analysis(linkage).solve().message; };
  Mechanism linkage;
  linkage.bodies = {body("crank", 1, {0.1, 0, 0}, {0.01, 0.01, 0.01}),
                    body("coupler", 1, {0.5, 0.3, 0}, {0.05, 0.05, 0.05}),
                    body("rocker", 1, {0.9, 0.3, 0}, {0.02, 0.02, 0.02})};
  linkage.joints = {driven(revolute("spin", "ground", "crank", {0, 0, 0}), 5),
                    revolute("pin", "crank", "coupler", {0.2, 0, 0}),
                    revolute("far pin", "coupler", "rocker", {0.8, 0.6, 0}),
                    revolute("pivot", "ground", "rocker", {1, 0, 0})};
  CHECK_THAT(without(linkage), Catch::Matchers::StartsWith("No steady state: as the drives turn"));
}
