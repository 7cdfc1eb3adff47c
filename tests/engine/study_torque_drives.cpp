// Drives that give a torque: their steady speeds against closed forms, against the same state at prescribed
// speed and against motions that settle; their stability against characteristic polynomials.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/hopf_curve.hpp"
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <complex>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

double speed(const Solution& s, std::string_view joint) {
  INFO(s.message);
  return coordinate(s, joint).speed.value();
}

// A joint whose drive gives a torque by a law, or as a number.
Joint torque_driven(Joint j, double guess, const std::string& law, const std::string& load = "") {
  Drive& drive = j.coordinates[0].drive.emplace();
  drive.speed = guess;
  const auto give = [&](const std::string& key, const std::string& text, std::optional<double>& number) {
    number = text.find('(') == std::string::npos ? std::stod(text) : 0;
    if (*number == 0 && text != "0") j.formulas.push_back({"drive." + key, text});
  };
  give("torque", law, drive.torque);
  if (!load.empty()) give("load", load, drive.load);
  return j;
}

// Haug's governor as two coordinates, its arms' angle a and the spindle's: m(a), J(a), V(a) and the collar's
// s(a), with derivatives.
struct Governor {
  static constexpr double arm = 0.16, link_at = 0.08, link = 0.10922, g = standard_gravity;
  double a, s, s1, s2, j, j1, j2, v1, v2, m;

  explicit Governor(double angle) : a(angle) {
    const double sine = std::sin(a), cosine = std::cos(a), b = link_at;
    const double r = std::sqrt(link * link - b * b * cosine * cosine), r1 = b * b * sine * cosine / r;
    s = b * sine + r;
    s1 = b * cosine + r1;
    s2 = -b * sine + (b * b * (cosine * cosine - sine * sine) - r1 * r1) / r;
    j = 50.125 + 2 * (0.1 + arm * arm * cosine * cosine);
    j1 = -4 * arm * arm * sine * cosine;
    j2 = -4 * arm * arm * (cosine * cosine - sine * sine);
    const double spring = 1000 * (s - 0.15);
    v1 = -2 * g * arm * cosine - g * s1 + spring * s1;
    v2 = 2 * g * arm * sine - g * s2 + spring * s2 + 1000 * s1 * s1;
    m = 2 * (0.1 + arm * arm) + s1 * s1;
  }
  // Where the collar stands at s.
  static Governor at_collar(double wanted) {
    double angle = 0.78;
    for (int i = 0; i < 50; ++i)
      angle -= (Governor(angle).s - wanted) / Governor(angle).s1;
    return Governor(angle);
  }
  double speed() const { return std::sqrt(2 * v1 / j1); }
  // (m x^2 + c s1^2 x + K)(J x) + w J1 (J1 w x - gain s1), x^3 first.
  std::array<double, 4> characteristic(double damper, double gain) const {
    const double w = speed(), k = v2 - w * w * j2 / 2;
    return {m * j, damper * s1 * s1 * j, k * j + w * j1 * w * j1, -w * j1 * gain * s1};
  }
};

Complex value_of(const std::array<double, 4>& p, Complex x) {
  return ((p[0] * x + p[1]) * x + p[2]) * x + p[3];
}

} // namespace

TEST_CASE("Haug's governor with engine: speed, collar and eigenvalues", "[torque]") {
  struct Row {
    double load, speed, collar, real, growth, frequency;
  };
  // Eigenvalues by the characteristic polynomial in 40 digits.
  for (const Row& row :
       {Row{0, 11.02119658437714, 0.15, -0.68749951539699, -0.13309704133331, 6.5405003602109},
        Row{25, 10.29396051997144, 0.15 + 25. / 7500, -0.68186258229831, -0.10884435470196, 6.2497177042158},
        Row{-25, 11.74559862254488, 0.15 - 25. / 7500, -0.68779359051423, -0.1574671584956,
            6.8233597440978}}) {
    CAPTURE(row.load);
    const Mechanism m = shipped("governor_engine", {{"joints.spin.drive.load", row.load}});
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(row.speed, 1e-13));
    CHECK(std::abs(value(s, "slide") - row.collar) < 1e-14);
    CHECK(std::abs(speed(s, "spin") - row.speed) <= coordinate(s, "spin").speed_error + 1e-14 * row.speed);
    CHECK(s.stable == true);
    CHECK(s.stability_reason == StabilityReason::asymptotic);
    REQUIRE(s.eigenvalues->size() == 3); // that of the phase is not among them
    CHECK(std::abs((*s.eigenvalues)[0] - row.real) < 1e-9);
    CHECK(std::abs((*s.eigenvalues)[1] - Complex(row.growth, row.frequency)) < 1e-9);
    const Governor closed = Governor::at_collar(row.collar);
    CHECK_THAT(closed.speed(), WithinRel(row.speed, 1e-13));
    for (const Complex x : *s.eigenvalues) {
      const auto p = closed.characteristic(30, 7500);
      CHECK(std::abs(value_of(p, x)) < 1e-9 * std::abs(p[1]) * std::norm(x));
    }
    // The other question: the same state where nothing gives way to the governor.
    REQUIRE(s.at_constant_speed);
    CHECK(s.at_constant_speed->stability_reason == StabilityReason::minimum);
    const Solution prescribed =
        Analysis(shipped("governor", {{"joints.spin.drive.speed", row.speed}})).solve();
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(std::abs((*s.at_constant_speed->eigenvalues)[i] - (*prescribed.eigenvalues)[i]) < 1e-9);
    CHECK(std::abs(s.drive_torques[0].value - 0) < 1e-10);
  }
}

TEST_CASE("hunting of Haug's governor begins where Routh's criterion says", "[torque][branches]") {
  const auto hopf = [](const std::string& address, double from, double to) {
    const ResponseDiagram d = follow_branches(shipped("governor_engine"), address, from, to);
    std::vector<double> found;
    for (const SpecialPoint& s : d.special)
      if (s.type == SpecialPointType::hopf) found.push_back(s.at.parameter);
    INFO(d.message);
    REQUIRE(found.size() == 1);
    return found[0];
  };
  // a1 a2 = a0 a3 of x^3 ... x^0, linear in the damper and in the gain.
  const auto p = Governor::at_collar(0.15).characteristic(1, 1);
  CHECK_THAT(hopf("joints.slide.damping", 60, 5), WithinRel(7500 * p[3] * p[0] / (p[1] * p[2]), 1e-9));
  CHECK_THAT(hopf("parameters.gain", 5000, 15000), WithinRel(30 * p[1] * p[2] / (p[3] * p[0]), 1e-9));

  // Vyshnegradsky's diagram over the load, which moves the collar.
  const PlaneCurves plane = hopf_curves(shipped("governor_engine"), {"joints.slide.damping", 5, 60},
                                        {"joints.spin.drive.load", -25, 25});
  REQUIRE(plane.curves.size() == 1);
  CHECK(plane.curves[0].points.size() > 20);
  for (const PlanePoint& at : plane.curves[0].points) {
    const auto there = Governor::at_collar(0.15 + at.y / 7500).characteristic(1, 7500);
    CHECK_THAT(at.x, WithinRel(there[3] * there[0] / (there[1] * there[2]), 1e-10));
    CHECK_THAT(at.hopf->frequency, WithinRel(std::sqrt(there[2] / there[0]), 1e-10));
  }

  const Solution hunting = Analysis(shipped("governor_engine", {{"joints.slide.damping", 20.}})).solve();
  CHECK(hunting.stable == false);
  CHECK(hunting.at_constant_speed->stable == true);
}

TEST_CASE("the motion of Haug's governor with engine settles at the direct answer", "[torque]") {
  const Mechanism m = shipped("governor_engine", {{"joints.spin.drive.load", 10.}});
  const Solution s = Analysis(m).solve();
  SimulationOptions options;
  options.duration = 160;
  options.rate = 1;
  options.at = {{"slide", 0.14}};
  const Run run = simulate(m, options);
  REQUIRE(run.status == RunStatus::completed);
  const Settled settled = find_settled(run, s, 1e-7);
  INFO(settled.message);
  CHECK(settled.time);
  CHECK(std::abs(run.energy.balance.back()) < 1e-6 * run.energy.kinetic.back());
  // From the steady state nothing moves.
  options.start = Start::equilibrium;
  options.at.clear();
  options.duration = 5;
  CHECK(distance_from(simulate(m, options), 5, s) < 1e-9);
}

TEST_CASE("rates of speeds found and of coordinates with a number", "[torque]") {
  const Solution s = Analysis(shipped("governor_engine")).solve();
  const auto solved = [](double load) {
    return Analysis(shipped("governor_engine", {{"joints.spin.drive.load", load}})).solve();
  };
  const Solution above = solved(1e-3), below = solved(-1e-3);
  for (const Sensitivity& x : s.sensitivities) {
    if (x.address != "joints.spin.drive.load") continue;
    REQUIRE(x.rates.size() == 4);
    for (const Sensitivity::Rate& rate : x.rates) {
      const double difference = rate.speed ? speed(above, rate.joint) - speed(below, rate.joint)
                                           : value(above, rate.joint) - value(below, rate.joint);
      CHECK(rate.speed == (rate.joint == "spin"));
      CHECK_THAT(rate.value, WithinRel(difference / 2e-3, 1e-7));
    }
  }
  // The load at which the collar stands where it is wanted.
  const DesignAnswer answer =
      design(shipped("governor_engine"), "joints.spin.drive.load", -25, 25, "slide", 0.1521);
  REQUIRE(answer.status == Status::converged);
  CHECK_THAT(answer.solutions[0].parameter, WithinRel(7500 * 0.0021, 1e-9));
}

TEST_CASE("error against run time of Haug's governor with engine", "[torque]") {
  CompareOptions options;
  options.tolerances = {1e-9};
  options.integrators = {Integrator::bdf};
  options.durations = {100, 200};
  options.repeats = 1;
  const Comparison c = compare(shipped("governor_engine"), options);
  REQUIRE(c.status == Status::converged);
  CHECK(c.answer.error < 1e-14);
  CHECK(c.motion[1].points[0].error < 1e-9);
  CHECK(c.motion[0].points[0].error > 10 * c.motion[1].points[0].error);
}

TEST_CASE("a shaft with several steady speeds: all are found, with their eigenvalues", "[torque]") {
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 2, 0.1})};
  // T - c w = 0.3 (w - 1)(w - 3)(w - 5)
  m.joints = {dampened(
      torque_driven(
          revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 2,
          "0.5 N m s * rate(shaft) + 0.3 N m s^3 * (rate(shaft) - 1)*(rate(shaft) - 3)*(rate(shaft) - 5)"),
      0.5)};
  validate(m);
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 3);
  std::vector<std::pair<double, double>> found;
  for (const Solution& s : all.equilibria) {
    REQUIRE(s.eigenvalues->size() == 1);
    found.emplace_back(speed(s, "shaft"), s.eigenvalues->front().real());
    CHECK(s.stable == (std::abs(speed(s, "shaft") - 3) < 0.5));
  }
  std::ranges::sort(found);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK_THAT(found[i].first, WithinRel(std::array{1., 3., 5.}[i], 1e-12));
    CHECK_THAT(found[i].second, WithinRel(0.3 * std::array{8., -4., 8.}[i] / 2, 1e-9));
  }
  REQUIRE(all.bounds.size() == 1);
  CHECK(all.bounds[0].speed);
  CHECK(all.bounds[0].upper >= 6);
}

TEST_CASE("steady speeds are found orders of magnitude from where the search begins", "[torque]") {
  // T = 3 w exp(-w) + w / 10: three roots for this torque, of which the start is near none.
  const auto load = [](double w) { return 3 * w * std::exp(-w) + 0.1 * w; };
  for (const double start : {0.02, 0.1, 4., 900.}) {
    CAPTURE(start);
    Mechanism m;
    m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
    m.joints = {
        torque_driven(revolute("a", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), start,
                      "0.9 N m - 1 N m*(3*rate(a)/(1 rad/s)*exp(-rate(a)/(1 rad/s)) + rate(a)/(10 rad/s))")};
    validate(m);
    const AllSolutions all = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == 3);
    std::vector<double> found;
    for (const Solution& s : all.equilibria) {
      found.push_back(speed(s, "a"));
      CHECK(std::abs(load(found.back()) - 0.9) < 1e-12);
      CHECK(s.stable == (found.back() < 1 || found.back() > 5));
    }
    CHECK(all.bounds.at(0).upper >= 2900 * start);
  }
  // There is no end of them.
  Mechanism wavy;
  wavy.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
  wavy.joints = {
      torque_driven(revolute("a", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 2, "1 N m*sin(rate(a)*1 s)")};
  const std::size_t count = Analysis(wavy).solve_all().equilibria.size();
  CHECK(count > 20);
  CHECK(count < 100);
}

TEST_CASE("Watt's height of the cone with the speed unknown", "[torque]") {
  Mechanism m = conical(0.5, 0, 5, 0.4);
  m.joints[0] = torque_driven(m.joints[0], 6, "20 N m * (0.9 - coordinate(swing))");
  m.joints[1] = dampened(m.joints[1], 0.1);
  m.bodies[0].inertia = {0.1, 0.1, 0.1};
  validate(m);
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "swing"), WithinRel(0.9, 1e-12));
  CHECK_THAT(0.5 * std::cos(0.9), WithinRel(standard_gravity / std::pow(speed(s, "spin"), 2), 1e-12));
}

TEST_CASE("a heavy top's slow and fast steady precession with the speed unknown", "[torque]") {
  const double inertia = 0.02, across = 0.015 + 2 * 0.15 * 0.15, rate = 200, angle = 0.7;
  const double weight = 2 * standard_gravity * 0.15;
  Mechanism m;
  m.gravity = {0, 0, -standard_gravity};
  m.bodies = {body("yoke", 0), body("ring", 0), body("top", 2, {0, 0, 0.15}, {0.015, 0.015, 0.02})};
  m.joints = {torque_driven(revolute("precession", "ground", "yoke", {0, 0, 0}, {0, 0, 1}), 1,
                            "1 N m * (coordinate(nutation) - 0.7)"),
              revolute("nutation", "yoke", "ring", {0, 0, 0}, {1, 0, 0}),
              driven(revolute("spin", "ring", "top", {0, 0, 0}, {0, 0, 1}), rate)};
  m.joints[1].coordinates[0].drawn = 0;
  validate(m);
  // m g l = I3 p (r + p cos a) - I1 p^2 cos a
  const double a = (inertia - across) * std::cos(angle), b = inertia * rate;
  const double root = std::sqrt(b * b + 4 * a * weight);
  for (const double wanted : {(-b + root) / (2 * a), (-b - root) / (2 * a)}) {
    CAPTURE(wanted);
    m.joints[0].coordinates[0].drive->speed = 0.9 * wanted;
    SolveOptions options;
    options.start = {{"nutation", 0.65}};
    options.nearest = true;
    const Solution s = Analysis(m).solve(options);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "precession"), WithinRel(wanted, 1e-11));
    CHECK_THAT(value(s, "nutation"), WithinRel(angle, 1e-11));
  }
}

TEST_CASE("random mechanisms: the speed is found at which the drive gives what turning takes",
          "[torque][random]") {
  int found = 0, moved = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const Mechanism prescribed = reference::random_sprung_mechanism(seed);
    const Solution there = Analysis(prescribed).solve();
    if (there.status != Status::converged || there.drive_torques.size() != 1 ||
        there.drive_torques[0].varying || there.neutral.size() > 0)
      continue;
    const DriveTorque& torque = there.drive_torques[0];
    Mechanism m = prescribed;
    Joint& driver = m.joints[static_cast<std::size_t>(joint_index(m, torque.joint))];
    Coordinate& c = driver.coordinates[static_cast<std::size_t>(torque.index)];
    const double wanted = c.drive->speed;
    if (wanted == 0) continue;
    const std::string name = coordinate_name(driver, torque.index);
    const double slope = 1 + std::abs(torque.value / wanted);
    c.drive->torque = 0;
    const std::string index = torque.count > 1 ? "." + std::to_string(torque.index) : "";
    const auto number = [](double x) { return "(" + number_text(x) + ")"; };
    driver.formulas.push_back({"drive" + index + ".torque", number(torque.value) + " - " + number(slope) +
                                                                " * 1 N m s" + "*(rate(" + name + ") - " +
                                                                number(wanted) + ")"});
    c.drive->speed = 0.97 * wanted;
    validate(m);
    SolveOptions nearest;
    nearest.nearest = true;
    for (const CoordinateSolution& x : there.coordinates)
      if (!x.driven && !x.dependent) nearest.start.emplace_back(coordinate_label(x), x.value);
    const Solution s = Analysis(m).solve(nearest);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const double speed_found = coordinate(s, torque.joint, torque.index).speed.value();
    if (std::abs(speed_found / wanted - 1) > 1e-3) continue; // another steady speed lies close
    ++found;
    CHECK_THAT(speed_found, WithinRel(wanted, 1e-9));
    CHECK(s.at_constant_speed->stable == there.stable);
    if (s.stable != true || !s.eigenvalues || moved >= 4) continue;
    double slowest = 1e9;
    for (const Complex x : *s.eigenvalues)
      slowest = std::min(slowest, -x.real());
    if (!(slowest > 0.2)) continue;
    ++moved;
    SimulationOptions run;
    run.duration = std::log(1e7) / slowest;
    run.rate = 2 / run.duration;
    for (const CoordinateSolution& x : there.coordinates)
      if (!x.driven && !x.dependent) run.at.emplace_back(coordinate_label(x), x.value);
    const Run motion = simulate(m, run);
    REQUIRE(motion.status == RunStatus::completed);
    CHECK(distance_from(motion, motion.time.size() - 1, s) < 1e-5);
  }
  CAPTURE(found, moved);
  CHECK(found > 20);
  CHECK(moved > 2);
}

TEST_CASE("torques that no speed balances are refused with the reason", "[torque]") {
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 2, 0.1})};
  const Joint shaft = revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0});
  SECTION("without resistance") {
    m.joints = {torque_driven(shaft, 3, "25")};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("shaft gives 25 N m where turning takes 0 N m: it runs away"));
  }
  SECTION("none, and nothing resists: every speed is one") {
    m.joints = {torque_driven(shaft, 3, "0")};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("Nothing determines the speed of shaft"));
  }
  SECTION("what turns with the drive") {
    const Mechanism governor = shipped("governor_engine", {{"gravity.0", 1.}, {"bodies.ball1.mass", 1.2}});
    const Solution s = Analysis(governor).solve();
    CHECK(s.status == Status::no_steady_state);
    CHECK_THAT(s.message, ContainsSubstring("turns with the drives"));
    CHECK_THROWS_WITH(follow_branches(governor, "joints.spin.drive.speed", 5, 20),
                      ContainsSubstring("is found by the drive's torque"));
  }
  SECTION("two shafts that drag each other along") {
    m.bodies.push_back(body("other", 1, {0, 0.1, 0}, {0.1, 3, 0.1}));
    m.joints = {torque_driven(shaft, 3, "2"),
                torque_driven(revolute("second", "ground", "other", {0, 0, 0}, {0, 1, 0}), 2, "-2")};
    Joint clutch = joint(JointType::revolute, "clutch", "rotor", "other", {0, 0.05, 0}, {0, 1, 0});
    clutch.cut = true;
    m.joints.push_back(dampened(clutch, 4));
    validate(m);
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("Nothing determines the speeds of shaft and second together"));
    // One that resists them both settles it.
    m.joints[0] = dampened(m.joints[0], 0.25);
    const Solution settled = Analysis(m).solve();
    REQUIRE(settled.status == Status::converged);
    CHECK(std::abs(speed(settled, "shaft")) < 1e-12);
    CHECK_THAT(speed(settled, "second"), WithinRel(-0.5, 1e-12));
  }
}

TEST_CASE("shafts found at different speeds turn against each other, wherever their search began",
          "[torque]") {
  // A spring between their rims pulls along the line of the axes as drawn: there the balance holds.
  Mechanism m;
  m.bodies = {body("a", 1, Vec3::Zero()), body("b", 1, Vec3::UnitX())};
  m.bodies[0].inertia = m.bodies[1].inertia = {0.1, 0.1, 0.1};
  m.joints = {torque_driven(revolute("one", "ground", "a", Vec3::Zero(), Vec3::UnitZ()), 10,
                            "5 N m - 0.5 N m s * rate(one)"),
              torque_driven(revolute("two", "ground", "b", Vec3::UnitX(), Vec3::UnitZ()), 10,
                            "3.5 N m - 0.5 N m s * rate(two)")};
  const Solution apart = Analysis(m).solve({});
  REQUIRE(apart.status == Status::converged);
  CHECK(speed(apart, "one") == Approx(10));
  CHECK(speed(apart, "two") == Approx(7));
  Force spring;
  spring.name = "spring";
  spring.bodies = {"a", "b"};
  spring.points = {Vec3(0.2, 0, 0), Vec3(0.8, 0, 0)};
  spring.stiffness = 100;
  spring.free_length = 0.3;
  m.forces = {spring};
  CHECK(Analysis(m).solve({}).status == Status::no_steady_state);
}

TEST_CASE("a motor's curve as a table over the speed", "[torque]") {
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 2, 0.1})};
  m.joints = {
      dampened(torque_driven(revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 4,
                             "table(rate(shaft), [0, 12 N m], [5, 10 N m], [10, 5 N m], [12 rad/s, 0])"),
               1)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // Between 5 and 10 rad/s, where the curve's slopes are harmonic means of those beside.
  const double left = 2 / (1 / -0.4 + 1 / -1.), right = (9. + 12.) / (9 / -1. + 12 / -2.5);
  const auto curve = [&](double w) {
    const double t = (w - 5) / 5;
    return 10 * (2 * t * t * t - 3 * t * t + 1) + 5 * left * (t * t * t - 2 * t * t + t) +
           5 * (3 * t * t - 2 * t * t * t) + 5 * right * (t * t * t - t * t);
  };
  const double w = speed(s, "shaft");
  CHECK(w > 5);
  CHECK_THAT(curve(w), WithinRel(w, 1e-12));
  CHECK(s.stable == true);
}

TEST_CASE("Floquet: multipliers where the speed of the period is found", "[torque][floquet]") {
  // Springs on a turntable pull at a bead on a fixed slide (Mathieu's equation), at rest where they balance.
  Mechanism m;
  m.bodies = {body("bead", 1), body("table", 1, Vec3::Zero(), {1, 1, 1})};
  m.joints = {driven(revolute("spin", "ground", "table", Vec3::Zero(), Vec3::UnitZ()), 8),
              dampened(prismatic("x", "ground", "bead", Vec3::Zero(), Vec3::UnitX()), 0.3)};
  for (const double side : {1., -1.})
    m.forces.push_back(
        point_spring(side > 0 ? "east" : "west", "table", "bead", Vec3(side, 0, 0), Vec3::Zero(), 50, 0.7));
  for (const double free : {0.7, 1.4}) {
    CAPTURE(free);
    for (Force& spring : m.forces)
      spring.free_length = free;
    SolveOptions nearest;
    nearest.nearest = true;
    const Solution prescribed = Analysis(m).solve(nearest);
    REQUIRE(prescribed.floquet);
    const auto expect = [&](const Solution& s, std::optional<double> of_shaft) {
      INFO(s.message);
      REQUIRE(s.status == Status::converged);
      CHECK_THAT(speed(s, "spin"), WithinRel(8, 1e-12));
      REQUIRE(s.floquet);
      CHECK_THAT(s.floquet->period, WithinRel(prescribed.floquet->period, 1e-12));
      CHECK(s.stable == prescribed.stable);
      std::vector<Complex> wanted = prescribed.floquet->multipliers;
      if (of_shaft) wanted.push_back(*of_shaft);
      REQUIRE(s.floquet->multipliers.size() == wanted.size());
      for (const Complex mu : wanted) {
        double apart = 1;
        for (const Complex other : s.floquet->multipliers)
          apart = std::min(apart, std::abs(mu - other));
        CHECK(apart < 1e-7);
      }
    };
    Mechanism by_torque = m;
    by_torque.joints[0] = torque_driven(revolute("spin", "ground", "table", Vec3::Zero(), Vec3::UnitZ()), 7,
                                        "4 N m - 0.5 N m s * rate(spin)");
    expect(Analysis(by_torque).solve(nearest), std::exp(-0.5 * prescribed.floquet->period));
    Mechanism left = m;
    left.joints[0].coordinates[0].drive->keeps = DriveKeeps::momentum;
    expect(Analysis(left).solve(nearest), {}); // neither phase nor momentum is among them
  }
}

namespace {

// In seconds of another length. A hub, on a slide of it a point mass whose damper is negative; or, `tied`, a
// pendulum that lifts a sleeve by a rod.
Mechanism timed_hub(double second, bool tied, bool keeps_momentum) {
  const auto per_second = [&](double value, int times) { return value / std::pow(second, times); };
  Mechanism m;
  m.gravity = {0, 0, tied ? -per_second(standard_gravity, 2) : 0};
  m.bodies = {body("hub", 1, {0, 0, 0}, {0.2, 0.2, 0.2})};
  m.joints = {torque_driven(revolute("spin", "ground", "hub", {0, 0, 0}), per_second(5, 1),
                            number_text(per_second(5, 2)) + " N m - " + number_text(per_second(1, 1)) +
                                " N m s*rate(spin)")};
  if (keeps_momentum) {
    m.joints[0].formulas.clear();
    m.joints[0].coordinates[0].drive->torque.reset();
    m.joints[0].coordinates[0].drive->keeps = DriveKeeps::momentum;
  }
  if (tied) {
    m.bodies.push_back(body("arm", 0.5, {0.5, 0, -0.3}, {0.1, 0.1, 0.1}));
    m.bodies.push_back(body("sleeve", 0.3, {0, 0, -0.2}));
    m.joints.push_back(
        dampened(sprung(revolute("lean", "hub", "arm", {0.2, 0, 0}, {0, 1, 0}), per_second(1, 2)),
                 per_second(0.2, 1)));
    m.joints.push_back(
        dampened(sprung(prismatic("slide", "hub", "sleeve", {0, 0, -0.2}, {0, 0, 1}), per_second(300, 2)),
                 per_second(3, 1)));
    m.joints.push_back(distance("rod", "arm", "sleeve", {0.4, 0, -0.2}, {0, 0, -0.2}));
    return m;
  }
  m.bodies.push_back(body("bob", 0.5, {0.3, 0, 0}));
  m.joints.push_back(
      sprung(prismatic("slide", "hub", "bob", {0.3, 0, 0}, {1, 0, 0}), per_second(150, 2), 0.3));
  m.joints[1].coordinates[0].drawn = 0.3;
  m.joints[1].coordinates[0].damping_force = 0;
  m.joints[1].formulas = {{"damping_force", number_text(per_second(-2, 1)) + " N s/m*rate"}};
  return m;
}

} // namespace

TEST_CASE("eigenvalues go with the unit of time, whatever turns at speeds that are found", "[torque]") {
  for (const bool tied : {false, true})
    for (const bool keeps_momentum : {false, true}) {
      Analysis in_seconds(timed_hub(1, tied, keeps_momentum));
      const Solution wanted = in_seconds.solve();
      const std::vector<VibrationMode> modes = in_seconds.modes();
      REQUIRE(wanted.status == Status::converged);
      REQUIRE(wanted.eigenvalues);
      CHECK(wanted.stable == tied);
      double largest = 0;
      for (const Complex s : *wanted.eigenvalues)
        largest = std::max(largest, std::abs(s));
      for (const double second : {1e-8, 1e-4, 1e-2, 1e3, 1e8}) {
        CAPTURE(tied, keeps_momentum, second);
        Analysis analysis(timed_hub(second, tied, keeps_momentum));
        const Solution found = analysis.solve();
        REQUIRE(found.status == Status::converged);
        CHECK(found.stable == wanted.stable);
        CHECK(found.stability_reason == wanted.stability_reason);
        REQUIRE(found.eigenvalues);
        REQUIRE(found.eigenvalues->size() == wanted.eigenvalues->size());
        for (std::size_t i = 0; i < wanted.eigenvalues->size(); ++i)
          CHECK(std::abs((*found.eigenvalues)[i] * second - (*wanted.eigenvalues)[i]) < 1e-9 * largest);
        const std::vector<VibrationMode> there = analysis.modes();
        REQUIRE(there.size() == modes.size());
        for (std::size_t i = 0; i < modes.size(); ++i)
          for (std::size_t k = 0; k < modes[i].amplitudes.size(); ++k)
            CHECK(std::abs(std::abs(there[i].amplitudes[k].value) - std::abs(modes[i].amplitudes[k].value)) <
                  1e-8);
      }
    }
}

TEST_CASE("the eigenvalues of a light bead on a heavy shaft are those of its own motion", "[torque]") {
  // Hung at R by a massless wire, w^2 = 5 g / (2 R): cos a = 2 / 5 and s^2 + c / (m R^2) s + w^2 sin^2 a = 0.
  constexpr double reach = 0.4, inertia = 50, drag = 0.3;
  const double w = std::sqrt(2.5 * standard_gravity / reach), sine2 = 1 - 0.16;
  for (const double mass : {1e-3, 1e-8, 1e-10, 1e-14, 1e-20}) {
    CAPTURE(mass);
    Mechanism m;
    m.gravity = {0, 0, -standard_gravity};
    m.bodies = {body("shaft", 1, {0, 0, 0}, Vec3::Constant(inertia)),
                body("bead", mass, {reach * std::sqrt(sine2), 0, -0.4 * reach})};
    m.joints = {
        torque_driven(revolute("spin", "ground", "shaft", {0, 0, 0}), w,
                      number_text(inertia * w) + " N m - " + number_text(inertia) + " N m s*rate(spin)"),
        dampened(revolute("lean", "shaft", "bead", {0, 0, 0}, {0, -1, 0}), drag * mass * reach * reach)};
    SolveOptions nearest;
    nearest.nearest = true;
    const Solution s = Analysis(m).solve(nearest);
    REQUIRE(s.status == Status::converged);
    CHECK(value(s, "lean") == Approx(0).margin(1e-9));
    CHECK(s.stable == true);
    REQUIRE(s.eigenvalues);
    REQUIRE(s.eigenvalues->size() == 3);
    // The shaft's own -1, to the share of the bead.
    CHECK(std::abs((*s.eigenvalues)[0] + 1.) < 1e-4 * mass / 1e-3 + 1e-9);
    const Complex swing(-drag / 2, std::sqrt(w * w * sine2 - drag * drag / 4));
    CHECK(std::abs((*s.eigenvalues)[1] - swing) < (1e-3 * mass / 1e-3 + 1e-9) * std::abs(swing));
  }
}

TEST_CASE("laws of torque that mean nothing are mistakes with their place", "[torque]") {
  Mechanism m = shipped("governor_engine");
  Joint& spin = m.joints[0];
  const auto mistake = [&](const std::string& law) {
    spin.formulas[0].text = law;
    const auto found = find_mistakes(m);
    REQUIRE(found.size() == 1);
    CHECK(found[0].where().starts_with("joints.spin.drive"));
    return found[0].expected();
  };
  CHECK_THAT(mistake("gain * coordinate(slides)"), ContainsSubstring("did you mean \"slide\""));
  CHECK_THAT(mistake("gain * rate(slide)"), ContainsSubstring("expected N m, found"));
  CHECK_THAT(mistake("gains * coordinate(slide)"), ContainsSubstring("gains"));
  CHECK_THAT(mistake("gain * coordinate(slide"), ContainsSubstring("column"));
  spin.formulas[0].text = "gain * 1 m * coordinate(spin)";
  CHECK_THROWS_WITH(Analysis(m), ContainsSubstring("expected a rate"));
  spin.formulas[0].text = "gain * coordinate(slide)";
  spin.coordinates[0].drive->speed = 0;
  CHECK_THAT(find_mistakes(m).at(0).expected(), ContainsSubstring("other than zero"));
  CHECK(write_scene(shipped("governor_engine")) ==
        write_scene(read_scene(write_scene(shipped("governor_engine")))));
}

TEST_CASE("a centrifugal clutch engages at its speed, slips, and where it would lock creeps", "[torque]") {
  // Of the scene, in its words.
  constexpr double m = 0.1, r = 0.05, gap = 0.002, radius = r + gap + 0.01, k = 8000, preload = 80,
                   hardness = 1e6, mu = 0.3, creep = 1, slope = 0.2, resistance = 0.05;
  const auto at = [](double idle) {
    const Solution s = Analysis(shipped("centrifugal_clutch", {{"parameters.idle", idle}})).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    return s;
  };
  // m (r + x) w^2 = preload + k x + hardness (x - gap).
  const auto capacity = [&](double w) {
    const double x = (m * r * w * w - preload + hardness * gap) / (k + hardness - m * w * w);
    return 3 * mu * radius * hardness * (x - gap);
  };
  const double engages = std::sqrt((preload + k * gap) / (m * (r + gap)));
  CHECK(std::abs(capacity(engages)) < 1e-9);
  const Solution below = at(engages * (1 - 1e-6)), above = at(engages * (1 + 1e-6));
  CHECK_THAT(speed(below, "motor"), WithinRel(engages * (1 - 1e-6), 1e-13));
  CHECK(speed(below, "drum") == 0);
  CHECK(speed(above, "drum") > 0);
  // Slipping: slope (idle - w) = capacity(w), halved into; far from locking friction is all of mu.
  for (const double idle : {150., 200., 240., 280.}) {
    CAPTURE(idle);
    double low = engages, high = idle;
    for (int i = 0; i < 100; ++i) {
      const double w = (low + high) / 2;
      (slope * (idle - w) > capacity(w) ? low : high) = w;
    }
    const Solution s = at(idle);
    CHECK_THAT(speed(s, "motor"), WithinRel(low, 1e-11));
    CHECK_THAT(speed(s, "drum"), WithinRel(capacity(low) / resistance, 1e-9));
    CHECK(speed(s, "motor") - speed(s, "drum") > 20 * creep);
  }
  // Locked: what the drum resists with is a part of what friction could give.
  const Solution locked = at(400);
  const double motor = speed(locked, "motor"), drum = speed(locked, "drum");
  CHECK_THAT(resistance * drum, WithinRel(capacity(motor) * std::tanh((motor - drum) / creep), 1e-9));
  CHECK_THAT(resistance * drum, WithinRel(slope * (400 - motor), 1e-12));
  CHECK(motor - drum < creep);
}

TEST_CASE("a torque may name measures of coordinates and rates") {
  const Mechanism by_law = shipped("governor_engine");
  Mechanism by_measure = by_law;
  by_measure.measures.push_back({"opening", "", "coordinate(slide) - closed", "m"});
  by_measure.measures.push_back({"closed", "", "0.15 m", "m"});
  for (Joint& joint : by_measure.joints)
    for (Formula& formula : joint.formulas)
      if (formula.key == "drive.torque") formula.text = "gain*opening";
  validate(by_measure);
  const Solution direct = Analysis(by_law).solve(), named = Analysis(by_measure).solve();
  CHECK(speed(named, "spin") == speed(direct, "spin"));
  CHECK(named.eigenvalues == direct.eigenvalues);
  // Taken up as a change of the law.
  Analysis analysis(by_measure);
  Mechanism other = by_measure;
  other.measures.back().text = "0.16 m";
  analysis.update(other);
  CHECK_THAT(value(analysis.solve(), "slide"), WithinRel(0.16, 1e-12));

  const auto mistake = [&](const std::string& measure, const std::string& law) {
    Mechanism m = by_law;
    m.measures.push_back({"M", "", measure, "m"});
    m.measures.push_back({"N", "", "M", "m"});
    for (Joint& joint : m.joints)
      for (Formula& formula : joint.formulas)
        if (formula.key == "drive.torque") formula.text = law;
    try {
      validate(m);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(mistake("coordinate(slide)", "gain*(N - 0.15 m)").empty());
  CHECK_THAT(mistake("1 m*reaction(slide)/(1 N)", "gain*N"),
             ContainsSubstring("M asks for reaction(): a torque or load is one of"));
  CHECK_THAT(mistake("N", "gain*M"), ContainsSubstring("circle of measures"));
  CHECK_THAT(mistake("coordinate(slide)", "1 m*spring(slide)"),
             ContainsSubstring("is one of coordinates, rates"));
}

TEST_CASE("a law keeps the coordinates that it asks for, wherever loops could be cut") {
  const double sun = 20, planet = 16, ring = 52;
  Mechanism m;
  const auto wheel = [](const std::string& name, const Vec3& at) {
    return body(name, 1, at, {0.1, 0.1, 0.2});
  };
  m.bodies = {wheel("sun", {0, 0, 0}), wheel("carrier", {0, 0, 0}), wheel("planet", {0.9, 0, 0}),
              wheel("ring", {0, 0, 0})};
  m.joints = {torque_driven(revolute("sun", "ground", "sun", {0, 0, 0}, {0, 0, 1}), 100,
                            "10 N m - 0.02 N m s*rate(sun) - 0.01 N m s*rate(carrier)"),
              dampened(revolute("carrier", "ground", "carrier", {0, 0, 0}, {0, 0, 1}), 0.3),
              dampened(revolute("ring", "ground", "ring", {0, 0, 0}, {0, 0, 1}), 0.4),
              revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
              revolute("sun on carrier", "carrier", "sun", {0, 0, 0}, {0, 0, 1}),
              revolute("ring on carrier", "carrier", "ring", {0, 0, 0}, {0, 0, 1}),
              gear("inner mesh", "sun on carrier", "planet", -sun / planet),
              gear("outer mesh", "planet", "ring on carrier", planet / ring)};
  validate(m);
  const Solution s = Analysis(m).solve();
  const double ws = speed(s, "sun"), wc = speed(s, "carrier"), wr = speed(s, "ring");
  CHECK_THAT((ws - wc) * sun, WithinRel(-(wr - wc) * ring, 1e-12));
  const double torque = 10 - 0.02 * ws - 0.01 * wc;
  CHECK_THAT(0.3 * wc * wc + 0.4 * wr * wr, WithinRel(torque * ws, 1e-12));
  CHECK_THAT(-0.4 * wr, WithinRel(torque * ring / sun, 1e-12));
}
