// Steady states in which what turns at speeds that are found stands at another angle than drawn, and what
// studies make of them.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/search/most_turned.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/goals.hpp"
#include "engine/study/linear_model.hpp"
#include "engine/study/spread.hpp"
#include "tests/catch.hpp"
#include "tests/engine/coupled_shafts.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

// Of the characteristic polynomial of M q'' + C q' + K q = 0, beside its terms.
double left_of(const Eigen::MatrixXd& m, const Eigen::MatrixXd& c, const Eigen::MatrixXd& k, Complex x) {
  const Eigen::MatrixXcd all = x * x * m.cast<Complex>() + x * c.cast<Complex>() + k.cast<Complex>();
  const Eigen::MatrixXd sizes = std::norm(x) * m.cwiseAbs() + std::abs(x) * c.cwiseAbs() + k.cwiseAbs();
  return std::abs(all.determinant()) / sizes.rowwise().sum().prod();
}

} // namespace

TEST_CASE("two shafts with different torques stand turned so that their spring carries the difference",
          "[phase]") {
  Mechanism m = shafts(false);
  m.joints[0].formulas[0].text = "2 N m - 0.2 N m s * rate(p)";
  m.joints[1].formulas[0].text = "-0.5 N m - 0.05 N m s * rate(q)";
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "p"), WithinRel(6, 1e-12)); // (2 - 0.5) / 0.25
  CHECK_THAT(speed(s, "q"), WithinRel(6, 1e-12));
  CHECK(s.stable == true);
  CHECK_THAT(s.message, ContainsSubstring("stands turned against the drawn pose: q by"));
  // Every iteration on the way there is told.
  CHECK(s.iterations > 1);
  CHECK(s.history.size() == static_cast<std::size_t>(s.iterations));
  Analysis again(m);
  for (int i = 0; i < 2; ++i) { // as often as asked
    const AllSolutions all = again.solve_all();
    REQUIRE(all.equilibria.size() == 1);
    CHECK_THAT(speed(all.equilibria[0], "q"), WithinRel(6, 1e-12));
    CHECK(coordinate(again.solve(), "q").value == coordinate(s, "q").value);
  }
  SimulationOptions from_there;
  from_there.start = Start::equilibrium;
  from_there.duration = 1;
  const Run rests = simulate(m, from_there);
  REQUIRE(rests.coordinates.size() == 2);
  const CoordinateTrack &p = rests.coordinates[0], &q = rests.coordinates[1];
  for (std::size_t i = 0; i < rests.time.size(); ++i)
    CHECK_THAT(q.value[i] - p.value[i],
               WithinAbs(coordinate(s, "q").value - coordinate(s, "p").value, 1e-12));
  CompareOptions quick;
  quick.repeats = 1;
  quick.tolerances = {1e-5, 1e-10};
  quick.durations = {60};
  quick.integrators = {Integrator::runge_kutta};
  const Comparison comparison = compare(m, quick);
  INFO(comparison.message);
  CHECK(comparison.complete);
  CHECK(comparison.answer.error < 1e-12);
  CHECK(comparison.reference_error < 1e-13);
  REQUIRE(comparison.motion.size() == 1);
  CHECK(comparison.motion[0].points.at(0).error > 10 * comparison.motion[0].points.at(1).error);
  REQUIRE(comparison.best);
  CHECK(comparison.best->error < 1e-8);
  // The moment of the spring between points at 0.3 m, 0.5 m apart along the axis.
  const double twist = coordinate(s, "q").value - coordinate(s, "p").value,
               length = std::sqrt(0.25 + 2 * 0.09 * (1 - std::cos(twist)));
  CHECK_THAT(50 * (length - 0.2) * 0.09 * std::sin(-twist) / length, WithinRel(0.8, 1e-10));
  SimulationOptions run;
  run.duration = 60;
  const Run motion = simulate(m, run);
  CHECK_THAT(motion.coordinates[0].rate.back(), WithinRel(6, 1e-8));
  CHECK_THAT(motion.coordinates[1].value.back() - motion.coordinates[0].value.back(), WithinAbs(twist, 1e-7));
}

TEST_CASE("a motor drives a load through a flexible coupling, each in bearings of its own",
          "[phase][coupling]") {
  const double stiffness = 10, loss = 0.1;
  const bool prescribed = GENERATE(false, true);
  CAPTURE(prescribed);
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.3}), body("b", 1, {0, 0, 0.5}, {0.1, 0.1, 0.2})};
  Joint load = revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1});
  m.joints = {torque_driven(hinge("p", "ground", "a"), 5, "5 N m - 1 N m s * rate(p)"),
              prescribed ? driven(load, 4) : torque_driven(load, 3, "-0.2 N m s * rate(q)"),
              dampened(sprung(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), stiffness), loss)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double w = prescribed ? 4 : 5 / 1.2;
  CHECK_THAT(speed(s, "p"), WithinRel(w, 1e-12));
  CHECK_THAT(value(s, "c"), WithinRel(-(5 - w) / stiffness, 1e-10));
  CHECK(std::abs(value(s, "c") + (5 - w) / stiffness) <= coordinate(s, "c").error);
  CHECK(s.stable == true);
  REQUIRE(s.eigenvalues);
  if (prescribed) {
    REQUIRE(s.eigenvalues->size() == 2);
    for (const Complex x : *s.eigenvalues)
      CHECK(std::abs(0.3 * x * x + (1 + loss) * x + stiffness) < 1e-10 * stiffness);
    return;
  }
  CHECK(s.eigenvalues->size() == 3);
  const Eigen::Matrix2d mass = Eigen::Vector2d(0.3, 0.2).asDiagonal(), difference{{1, -1}, {-1, 1}};
  const Eigen::Matrix2d damping = loss * difference + Eigen::Matrix2d(Eigen::Vector2d(1, 0.2).asDiagonal());
  for (const Complex x : *s.eigenvalues)
    CHECK(left_of(mass, damping, stiffness * difference, x) < 1e-12);
  const LinearModel model = linearize(m, std::vector<std::string>{"torque(q)"},
                                      std::vector<std::string>{"rate(p)", "coordinate(c)"});
  INFO(model.refusal);
  REQUIRE(model.refusal.empty());
  for (const Complex x : *s.eigenvalues) {
    double nearest = 1e9;
    for (const Complex y : model.poles)
      nearest = std::min(nearest, std::abs(x - y));
    CHECK(nearest < 1e-9 * std::abs(x));
  }
  // The turn of both together is no state.
  CHECK(model.poles.size() == s.eigenvalues->size());
  const auto slow = transfer(best_form(model), Complex(0, 1e-6)); // both go faster, by 1 / 1.2
  REQUIRE(slow);
  CHECK(std::abs((*slow)(0, 0) - 1 / 1.2) < 1e-5);
  CHECK(std::abs((*slow)(1, 0) - 1 / 1.2 / stiffness) < 1e-5);
  SimulationOptions run;
  run.duration = 30;
  const Run motion = simulate(m, run);
  REQUIRE(motion.status == RunStatus::completed);
  CHECK_THAT(motion.coordinates[0].rate.back(), WithinRel(w, 1e-7));
}

TEST_CASE("a flexible shaft with a gear at its far end", "[phase][coupling]") {
  const bool prescribed = GENERATE(false, true);
  CAPTURE(prescribed);
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {0, 0, 0.5}, {0.2, 0.2, 0.2}),
              body("c", 1, {1, 0, 0.5}, {0.3, 0.3, 0.3})};
  m.joints = {prescribed ? driven(hinge("p", "ground", "a"), 5)
                         : torque_driven(hinge("p", "ground", "a"), 4, "2 N m - 0.2 N m s * rate(p)"),
              dampened(sprung(revolute("t", "a", "b", {0, 0, 0.5}, {0, 0, 1}), 20), 0.1),
              dampened(revolute("q", "ground", "c", {1, 0, 0.5}, {0, 0, 1}), 0.05),
              revolute("bq", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), gear("g", "bq", "q", -2)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // 2 - 0.2 w = 4 * 0.05 w
  CHECK_THAT(speed(s, "q"), WithinRel(-10, 1e-11));
  CHECK_THAT(value(s, "t"), WithinRel(-4 * 0.05 * 5 / 20, 1e-9));
  CHECK(s.stable == true);
  REQUIRE(s.eigenvalues);
  if (prescribed) return;
  CHECK(s.eigenvalues->size() == 3);
  const Eigen::Matrix2d mass = Eigen::Vector2d(0.1, 0.2 + 4 * 0.3).asDiagonal(), difference{{1, -1}, {-1, 1}};
  const Eigen::Matrix2d damping =
      0.1 * difference + Eigen::Matrix2d(Eigen::Vector2d(0.2, 4 * 0.05).asDiagonal());
  for (const Complex x : *s.eigenvalues)
    CHECK(left_of(mass, damping, 20 * difference, x) < 1e-12);
}

TEST_CASE("a damped spring holds a shaft behind one at a given speed", "[phase]") {
  Mechanism m = shafts(false);
  m.joints[0] = driven(hinge("p", "ground", "a"), 6);
  m.joints[1].formulas[0].text = "0.5 N m - 0.2 N m s * rate(q)";
  m.joints[1].coordinates[0].drive->speed = 2.6;
  m.forces[0].free_length = 0;
  m.forces[0].damping = 5;
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.turned);
  CHECK_THAT(speed(s, "q"), WithinRel(6, 1e-12));
  CHECK_THAT(coordinate(s, "q").value, WithinRel(-std::asin(0.7 / (50 * 0.09)), 1e-9));
  CHECK(s.stable == true);
}

TEST_CASE("two shafts whose speeds by themselves are of no balance turn together", "[phase][coupling]") {
  const double mass = 0.5, place = 0.3, spring = 700, stiffness = 50;
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {0, 0, 0.5}, {0.1, 0.1, 0.1}),
              body("r", mass, {place, 0, 0}, {0.001, 0.001, 0.001})};
  m.joints = {torque_driven(hinge("p", "ground", "a"), 5, "5.5 N m - 0.12 N m s * rate(p)"), // 46 rad/s
              torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 4,
                            "-1.3 N m - 0.12 N m s * rate(q)"),
              dampened(sprung(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), stiffness), 0.1),
              dampened(sprung(prismatic("r", "a", "r", {place, 0, 0}, {1, 0, 0}), spring), 10)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double w = 4.2 / 0.24;
  CHECK_THAT(speed(s, "p"), WithinRel(w, 1e-11));
  CHECK_THAT(speed(s, "q"), WithinRel(w, 1e-11));
  CHECK_THAT(value(s, "c"), WithinRel((-1.3 - 0.12 * w) / stiffness, 1e-9));
  CHECK_THAT(value(s, "r"), WithinRel(mass * w * w * place / (spring - mass * w * w), 1e-9));
  CHECK(s.stable == true);
  // At constant speed the rider alone moves: m r'' + 10 r' + (k - m w^2) r = 0.
  REQUIRE(s.at_constant_speed);
  CHECK(s.at_constant_speed->stable == true);
  REQUIRE(s.at_constant_speed->eigenvalues);
  CHECK(s.at_constant_speed->eigenvalues->size() == 2);
  for (const Complex x : *s.at_constant_speed->eigenvalues)
    CHECK(std::abs(mass * x * x + 10. * x + spring - mass * w * w) < 1e-9 * spring);
}

TEST_CASE("four shafts back to back, turned against each other by a spring's preload", "[phase][coupling]") {
  // A test rig for gears: a and c are tied by a spring, b and d by another, and gears turn b with a, d with
  // c. What c and d turn at nothing but the springs determines.
  const bool prescribed = GENERATE(false, true);
  const double stiffness = 50, other = 80, preload = GENERATE(0.1, 0.);
  CAPTURE(prescribed, preload);
  const double ratio = -1.5, inertia = 0.1, loss = 0.2, drag = 0.4;
  Mechanism m;
  const Vec3 all(inertia, inertia, inertia), axis(0, 1, 0);
  m.bodies = {body("a", 1, {0, 0, 0}, all), body("c", 1, {0, 0.3, 0}, all), body("b", 1, {0.3, 0, 0}, all),
              body("d", 1, {0.3, 0.3, 0}, all)};
  Joint first = revolute("pa", "ground", "a", {0, 0, 0}, axis),
        spring = dampened(sprung(revolute("s", "a", "c", {0, 0.15, 0}, axis), stiffness), loss);
  spring.coordinates[0].spring->free = preload;
  m.joints = {prescribed ? driven(first, 7.5) : torque_driven(first, 6, "3 N m - 0.4 N m s * rate(pa)"),
              revolute("pc", "ground", "c", {0, 0.3, 0}, axis),
              revolute("pb", "ground", "b", {0.3, 0, 0}, axis),
              revolute("pd", "ground", "d", {0.3, 0.3, 0}, axis),
              spring,
              dampened(sprung(revolute("t", "b", "d", {0.3, 0.15, 0}, axis), other), loss),
              gear("g1", "pa", "pb", ratio),
              gear("g2", "pc", "pd", ratio)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "pc"), WithinRel(7.5, 1e-10));
  const double whole = stiffness + ratio * ratio * other, damping = loss * (1 + ratio * ratio),
               turning = inertia * (1 + ratio * ratio), twist = stiffness * preload / whole;
  CHECK_THAT(value(s, "s"), WithinAbs(twist, 1e-10));
  CHECK_THAT(value(s, "t"), WithinAbs(ratio * twist, 1e-10));
  CHECK(s.stable == true);
  const auto holds = [&](Complex x) {
    return std::abs(turning * x * x + damping * x + whole) < 1e-9 * whole;
  };
  REQUIRE(s.eigenvalues);
  if (prescribed) {
    CHECK(s.eigenvalues->size() == 2);
    CHECK(std::ranges::all_of(*s.eigenvalues, holds));
  } else {
    CHECK(s.eigenvalues->size() == 3);
    const Eigen::Matrix2d mass = Eigen::Vector2d(turning, turning).asDiagonal(), difference{{1, -1}, {-1, 1}};
    const Eigen::Matrix2d drags =
        damping * difference + Eigen::Matrix2d(Eigen::Vector2d(drag, 0).asDiagonal());
    for (const Complex x : *s.eigenvalues)
      CHECK(left_of(mass, drags, whole * difference, x) < 1e-12);
    REQUIRE(s.at_constant_speed); // of pa, whose speed a torque gives
    REQUIRE(s.at_constant_speed->eigenvalues);
    CHECK(s.at_constant_speed->eigenvalues->size() == 2);
    CHECK(std::ranges::all_of(*s.at_constant_speed->eigenvalues, holds));
  }
  const AllSolutions listed = Analysis(m).solve_all();
  REQUIRE(listed.equilibria.size() == 1);
  CHECK_THAT(value(listed.equilibria[0], "s"), WithinAbs(twist, 1e-10));
}

TEST_CASE("shafts that a spring ties and nothing drives or resists turn at any common speed", "[phase]") {
  Mechanism m = shafts(false);
  m.joints = {torque_driven(hinge("p", "ground", "a"), 5, "0"),
              torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 5, "0")};
  m.forces[0].free_length = GENERATE(0.2, 0.6);
  CAPTURE(m.forces[0].free_length);
  validate(m);
  const Solution s = Analysis(m).solve();
  CHECK(s.status == Status::not_converged);
  CHECK_THAT(s.message, ContainsSubstring("Nothing determines the speeds of p and q together"));
}

TEST_CASE("a planetary set drives a load through a coupling, its sun by a torque or at the speed that gives",
          "[phase][coupling]") {
  Mechanism m;
  m.bodies = {body("sun", 1, {0, 0, 0}, {0.15, 0.15, 0.3}), body("carrier", 1, {0, 0, 0}, {0.15, 0.15, 0.3}),
              body("planet", 0, {0.9, 0, 0}, {0.015, 0.015, 0.03}),
              body("ring", 1, {0, 0, 0}, {0.15, 0.15, 0.3}), body("load", 1, {0, 0, 0.5}, {0.15, 0.15, 0.3})};
  m.joints = {
      torque_driven(hinge("sun", "ground", "sun"), 6, "5 N m - 0.3 N m s * rate(sun)"),
      torque_driven(hinge("carrier", "ground", "carrier"), 2, "5 N m - 1 N m s * rate(carrier)"),
      hinge("sc", "carrier", "sun"),
      revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
      hinge("rc", "carrier", "ring"),
      torque_driven(hinge("ring", "ground", "ring"), 2, "-0.1 N m s * rate(ring)"),
      torque_driven(revolute("load", "ground", "load", {0, 0, 0.5}, {0, 0, 1}), 5, "-0.2 N m s * rate(load)"),
      dampened(sprung(revolute("cp", "ring", "load", {0, 0, 0.5}, {0, 0, 1}), 10), 0.1),
      gear("in", "sc", "planet", -1.25),
      gear("out", "planet", "rc", 4. / 13)};
  validate(m);
  const Solution by_torque = Analysis(m).solve();
  INFO(by_torque.message);
  REQUIRE(by_torque.status == Status::converged);
  const double ring = speed(by_torque, "ring"), coupled = value(by_torque, "cp");
  CHECK_THAT(speed(by_torque, "load"), WithinRel(ring, 1e-11));
  CHECK_THAT(coupled, WithinRel(-0.2 * ring / 10, 1e-9));
  Mechanism given = m;
  given.joints[0] = driven(hinge("sun", "ground", "sun"), speed(by_torque, "sun"));
  validate(given);
  const Solution at_speed = Analysis(given).solve();
  INFO(at_speed.message);
  REQUIRE(at_speed.status == Status::converged);
  for (const char* shaft : {"carrier", "ring", "load"})
    CHECK_THAT(speed(at_speed, shaft), WithinRel(speed(by_torque, shaft), 1e-9));
  CHECK_THAT(value(at_speed, "cp"), WithinRel(coupled, 1e-9));
}

TEST_CASE("coupled shafts with many slides on them, and with more than are looked at", "[phase][coupling]") {
  const auto with_slides = [](int count) {
    Mechanism m;
    m.bodies = {body("a", 1, {0, 0, 0}, {0.2, 0.2, 0.3}), body("b", 1, {0, 0, 0.5}, {0.2, 0.2, 0.15})};
    m.joints = {
        torque_driven(hinge("p", "ground", "a"), 5, "5 N m - 1 N m s * rate(p)"),
        torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 3, "-0.2 N m s * rate(q)"),
        dampened(sprung(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), 10), 0.1)};
    for (int i = 0; i < count; ++i) {
      const std::string name = "r" + std::to_string(i);
      m.bodies.push_back(body(name, 0.01, {0.1, 0, 0}, {0, 0, 0}));
      m.joints.push_back(sprung(prismatic(name, "a", name, {0.1, 0, 0}, {1, 0, 0}), 10 + i));
    }
    return m;
  };
  const Solution s = Analysis(with_slides(70)).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double w = 5 / 1.2;
  CHECK_THAT(speed(s, "p"), WithinRel(w, 1e-11));
  CHECK_THAT(speed(s, "q"), WithinRel(w, 1e-11));
  CHECK_THAT(value(s, "c"), WithinRel(-0.2 * w / 10, 1e-10));
  CHECK_THAT(value(s, "r0"), WithinRel(0.01 * 0.1 * w * w / (10 - 0.01 * w * w), 1e-9));
  const Solution larger = Analysis(with_slides(most_turned_coordinates)).solve();
  CHECK(larger.status == Status::no_steady_state);
  CHECK_THAT(larger.message,
             ContainsSubstring("with more than 200 coordinates such states are not looked for"));
}

TEST_CASE("two shafts with play between them turn together against its flank", "[phase][coupling]") {
  const double play = 0.1, stiffness = 1000;
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.3}), body("b", 1, {0, 0, 0.5}, {0.1, 0.1, 0.2})};
  Joint teeth = dampened(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), 0.1);
  Stop& stop = teeth.coordinates[0].stop.emplace();
  stop.lower = -play;
  stop.upper = play;
  stop.stiffness = stiffness;
  m.joints = {torque_driven(hinge("p", "ground", "a"), 5, "5 N m - 1 N m s * rate(p)"),
              torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 3, "-0.2 N m s * rate(q)"),
              teeth};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "p"), WithinRel(5 / 1.2, 1e-11));
  CHECK_THAT(value(s, "c"), WithinRel(-play - 0.2 * 5 / 1.2 / stiffness, 1e-9));
  CHECK(s.stable == true);
}

TEST_CASE("a coupling with play lies against its flank where what rides on the shafts is dragged",
          "[phase][coupling]") {
  const double radius = 0.12, lower = -0.0733, stop = 200.5, linear = 0.2, quadratic = 0.04;
  Mechanism m;
  m.gravity = Vec3::Zero();
  for (const double y : {0., -0.3}) {
    const std::string n = y == 0 ? "0" : "1";
    m.bodies.push_back(body("shaft" + n, 2, {0, y, 0}, {0.1, 0.085, 0.1}));
    m.bodies.push_back(body("rider" + n, 0.9, {radius, y, 0}, {0.002, 0.003, 0.002}));
    m.joints.push_back(
        torque_driven(revolute("p" + n, "ground", "shaft" + n, {0, y, 0}, Vec3::UnitY()), 5,
                      y == 0 ? "3.03 N m - 0.898 N m s * rate(p0)" : "-0.278 N m - 0.124 N m s * rate(p1)"));
    m.joints.push_back(dampened(
        sprung(prismatic("h" + n, "shaft" + n, "rider" + n, {radius, y, 0}, Vec3::UnitX()), 430), 2));
    Force drag;
    drag.type = ForceType::drag;
    drag.name = "drag" + n;
    drag.body = "rider" + n;
    drag.at = {radius, y, 0};
    drag.linear = linear;
    drag.quadratic = quadratic;
    m.forces.push_back(drag);
  }
  m.joints.push_back(dampened(revolute("c", "shaft0", "shaft1", {0, -0.15, 0}, Vec3::UnitY()), 0.12));
  m.joints.back().coordinates[0].stop = Stop{lower, 0.0961, stop};
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  const auto place = [&](const std::string& joint) {
    return std::ranges::find(s.coordinates, joint, &CoordinateSolution::joint)->value;
  };
  const double w = speed(s, "p0");
  const auto drag = [&](const std::string& joint) {
    const double r = radius + place(joint);
    return linear * r * r * w + quadratic * r * r * r * w * w;
  };
  CHECK_THAT(3.03 - 0.898 * w - 0.278 - 0.124 * w, WithinAbs(drag("h0") + drag("h1"), 1e-10));
  CHECK_THAT(place("c"), WithinAbs(lower - (0.278 + 0.124 * w + drag("h1")) / stop, 1e-10));
}

TEST_CASE("of states that stand turned a stable one is the answer, wherever it lies", "[phase]") {
  const Mechanism m =
      read_scene(R"json({"flyball": 2, "name": "Three shafts", "gravity": [0, 0, 0], "bodies": [
    {"name": "s0", "mass": 2.254, "position": [0, 0, 0], "inertia": [0.1, 0.1025, 0.1]},
    {"name": "s1", "mass": 0.75, "position": [0, 0.1, 0], "inertia": [0.1, 0.3985, 0.1]},
    {"name": "s2", "mass": 2.415, "position": [0, 0.2, 0], "inertia": [0.1, 0.3515, 0.1]}],
    "joints": [{"name": "c0", "type": "revolute", "bodies": ["s0", "s1"], "at": [0, 0.05, 0], "axis": [0, 1, 0],
      "spring": {"stiffness": 19.29}, "damping": 0.07},
    {"name": "p1", "type": "revolute", "bodies": ["ground", "s1"], "at": [0, 0.1, 0], "axis": [0, 1, 0],
      "drive": {"torque": "=3.5106 N m - 0.3727 N m s*rate(p1)", "speed": 5.438}},
    {"name": "p2", "type": "revolute", "bodies": ["ground", "s2"], "at": [0, 0.2, 0], "axis": [0, 1, 0],
      "drive": {"torque": "=0.8663 N m - 0.4049 N m s*rate(p2)", "speed": 2.979}},
    {"name": "p0", "type": "revolute", "bodies": ["ground", "s0"], "at": [0, 0, 0], "axis": [0, 1, 0],
      "drive": {"torque": "=1.0366 N m - 0.3606 N m s*rate(p0)", "speed": 2.573}}],
    "forces": [{"name": "f1", "type": "spring", "bodies": ["s0", "s2"], "stiffness": 994.7, "free_length": 0,
      "points": [[0.13798537, 0, -0.20573214], [0.17859106, 0.2, -0.15874255]], "damping": 3.1},
    {"name": "f2", "type": "spring", "bodies": ["s0", "s1"], "stiffness": 1949.4, "free_length": 0.234,
      "points": [[-0.1845518, 0, -0.1646514], [-0.29733512, 0.1, -0.03154722]]}]})json");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK_THAT(speed(s, "p1"), WithinRel((3.5106 + 0.8663 + 1.0366) / (0.3727 + 0.4049 + 0.3606), 1e-11));
  SimulationOptions run;
  run.duration = 100;
  const Run motion = simulate(m, run);
  REQUIRE(motion.status == RunStatus::completed);
  const auto at = [&](std::string_view name) {
    return std::ranges::find(motion.coordinates, name, &CoordinateTrack::joint)->value.back();
  };
  CHECK_THAT(at("p1") - at("p0"), WithinAbs(coordinate(s, "p1").value - coordinate(s, "p0").value, 1e-6));
  CHECK_THAT(at("p2") - at("p0"), WithinAbs(coordinate(s, "p2").value - coordinate(s, "p0").value, 1e-6));
}

TEST_CASE("two couplings side by side, one of them behind gears", "[phase][coupling]") {
  Mechanism m;
  const Vec3 inertia(0.2, 0.2, 0.3);
  m.bodies = {body("a", 1, {0, 0, 0}, inertia), body("b", 1, {0, 0, 0.1}, inertia),
              body("c", 1, {0.3, 0, 0}, inertia), body("d", 1, {0.3, 0, 0.1}, inertia)};
  const Vec3 axis(0, 0, 1);
  m.joints = {torque_driven(revolute("pa", "ground", "a", {0, 0, 0}, axis), 5, "5 N m - 1 N m s*rate(pa)"),
              torque_driven(revolute("pb", "ground", "b", {0, 0, 0.1}, axis), 5, "-0.2 N m s*rate(pb)"),
              revolute("pc", "ground", "c", {0.3, 0, 0}, axis),
              revolute("pd", "ground", "d", {0.3, 0, 0.1}, axis),
              dampened(sprung(revolute("c", "a", "b", {0, 0, 0.05}, axis), 10), 0.1),
              dampened(sprung(revolute("k", "c", "d", {0.3, 0, 0.05}, axis), 4), 0.05),
              gear("g1", "pa", "pc", 2),
              gear("g2", "pd", "pb", 0.5)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // k = 2 c, and both carry what b takes.
  const double c = -0.2 * 5 / 1.2 / (10 + 2 * 4 * 2);
  CHECK_THAT(value(s, "c"), WithinRel(c, 1e-9));
  CHECK_THAT(value(s, "k"), WithinRel(2 * c, 1e-9));
  CHECK_THAT(speed(s, "pb"), WithinRel(5 / 1.2, 1e-11));
  CHECK(s.stable == true);
}

TEST_CASE("rates of a state that stands turned: against differences of solves", "[phase][coupling]") {
  enum class Tie { coupling, spring_and_given_speed };
  const Tie tie = GENERATE(Tie::coupling, Tie::spring_and_given_speed);
  Mechanism m = shafts(false);
  m.parameters.push_back({"T", "", 2, "N m", {}});
  m.joints[0].formulas[0].text = "T - 0.2 N m s * rate(p)";
  m.joints[1].formulas[0].text = "-0.05 N m s * rate(q)";
  std::vector<std::string> numbers{"parameters.T"};
  if (tie == Tie::coupling) {
    m.forces.clear();
    m.joints.push_back(dampened(sprung(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), 10), 0.1));
    numbers.emplace_back("joints.c.spring.stiffness");
    numbers.emplace_back("joints.c.spring.free");
  } else {
    m.joints[1] = driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 6);
    m.forces[0].damping = 3;
    numbers.emplace_back("joints.q.drive.speed");
    numbers.emplace_back("forces.k.stiffness");
  }
  m.points = {{"A", {0.3, 0, 0}}, {"B", {0, 0.4, 0.5}}};
  m.measures.push_back({"apart", "", "distance(a@A, b@B)", "m"});
  for (const std::string& number : numbers) {
    m.sliders.emplace_back().parameter = number;
    m.sliders.back().to = 100;
  }
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.turned);
  REQUIRE(s.sensitivities.size() == numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    CAPTURE(numbers[i]);
    const double at = get_parameter(m, numbers[i]), h = 1e-4 * (at != 0 ? at : 1);
    Solution side[2];
    for (const int k : {0, 1}) {
      Mechanism there = m;
      set_parameter(there, numbers[i], at + (k == 0 ? h : -h));
      side[k] = Analysis(there).solve();
      REQUIRE(side[k].status == Status::converged);
    }
    CHECK_THAT(
        s.sensitivities[i].measures.at(0),
        WithinAbs((side[0].measures[0].value.value() - side[1].measures[0].value.value()) / (2 * h), 1e-7));
    for (const auto& rate : s.sensitivities[i].rates) {
      CAPTURE(rate.joint);
      const CoordinateSolution &a = coordinate(side[0], rate.joint), &b = coordinate(side[1], rate.joint);
      const double difference = a.speed ? *a.speed - *b.speed : a.value - b.value;
      CHECK_THAT(rate.value, WithinAbs(difference / (2 * h), 1e-6));
    }
  }
}

TEST_CASE("studies over the coupling of a motor and its load", "[phase][coupling]") {
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.3}), body("b", 1, {0, 0, 0.5}, {0.1, 0.1, 0.2})};
  m.joints = {torque_driven(hinge("p", "ground", "a"), 5, "5 N m - 1 N m s * rate(p)"),
              torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 3, "-0.2 N m s * rate(q)"),
              dampened(sprung(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), 10), 0.1)};
  m.points = {{"A", {0.3, 0, 0}}, {"B", {0.3, 0, 0.5}}};
  m.measures.push_back({"apart", "", "distance(a@A, b@B)", "m"});
  validate(m);
  const std::string number = "joints.c.spring.stiffness";
  const double torque = 0.2 * 5 / 1.2; // of the coupling: c = -torque / stiffness
  const auto apart = [&](double stiffness) {
    return std::sqrt(0.25 + 2 * 0.09 * (1 - std::cos(torque / stiffness)));
  };
  const std::vector<Tolerance> tolerances{{number, Distribution::normal, 0.5}};
  SpreadOptions samples;
  samples.samples = 50;
  ThreadSharing sharing;
  const SpreadAnswer scatter = spread(m, tolerances, samples, sharing);
  INFO(scatter.message);
  REQUIRE(scatter.status == Status::converged);
  for (const SpreadOutput& output : scatter.outputs) {
    CAPTURE(output.name);
    const double expected = output.name == "c"       ? 0.5 * torque / 100
                            : output.name == "apart" ? 0.5 * (apart(9.999) - apart(10.001)) / 0.002
                                                     : 0;
    CHECK_THAT(output.linear_deviation, WithinAbs(expected, 1e-9));
    CHECK(output.linear_shares.at(0) == (expected > 0 ? 1 : 0));
  }
  CHECK(std::ranges::count(scatter.fate, SampleFate::followed) == 50);
  const std::vector<FreeNumber> free{{number, 5, 20}};
  const GoalAnswer reached = seek_goals(m, free, std::vector<Goal>{{"c", -0.06}});
  INFO(reached.message);
  REQUIRE(reached.reached);
  CHECK_THAT(reached.numbers.at(0).value, WithinRel(torque / 0.06, 1e-9));
  const DesignAnswer wanted = design(m, number, 5, 20, "c", -0.06, {});
  INFO(wanted.message);
  REQUIRE(wanted.solutions.size() == 1);
  const DesignSolution& found = wanted.solutions[0];
  CHECK_THAT(found.parameter, WithinRel(torque / 0.06, 1e-12));
  CHECK(found.parameter_error < 1e-12 * found.parameter);
  CHECK(found.at.stable == true);
  REQUIRE(found.rate);
  CHECK_THAT(*found.rate, WithinRel(0.06 * 0.06 / torque, 1e-9)); // of -torque / stiffness
}
