// Which steady state a mechanism driven by torques is told to have, and whether it is told to be stable: on
// kinks of the torques, at roots of higher order, where the first root is unstable or far from where the
// search begins, and of random mechanisms with several drives, against their motions.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/hopf_curve.hpp"
#include "tests/catch.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <numbers>
#include <random>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

// A rotor of 1 kg m^2 about z.
Mechanism lone_rotor(double guess, const std::string& law, const std::string& load = "") {
  Mechanism m;
  m.bodies = {body("r", 1, {0, 0, 0}, {1, 1, 1})};
  m.joints = {torque_driven(revolute("s", "ground", "r", {0, 0, 0}, {0, 0, 1}), guess, law, load)};
  validate(m);
  return m;
}

// A mass on a slide with a damper of 1 N s/m and a spring by a law.
Mechanism sprung_slide(const std::string& force) {
  Mechanism m;
  m.bodies = {body("b", 1)};
  Joint slide = dampened(joint(JointType::prismatic, "s", "ground", "b", {0, 0, 0}, {1, 0, 0}), 1);
  slide.coordinates[0].spring = CoordinateSpring{0, 0, "", 0};
  slide.formulas.push_back({"spring.force", force});
  m.joints = {slide};
  validate(m);
  return m;
}

// A ball on an arm of 0.3 m, hinged 0.05 m beside a shaft whose torque falls as the arm rises:
// w^2 (e + L sin q) cos q = g sin q and 5 - gain q = 0.3 w + 0.01 w^2. The law counts whole turns of the arm,
// and Newton-Raphson goes several of them back.
Mechanism arm_on_a_shaft(const std::string& gain) {
  Mechanism m;
  m.gravity = {0, -9.80665, 0};
  m.bodies = {body("t", 2, {0, 0, 0}, {0.4, 0.4, 0.4}), body("ball", 1.2, {0.05, -0.3, 0})};
  m.joints = {torque_driven(revolute("m", "ground", "t", {0, 0, 0}, {0, 1, 0}), 7,
                            "5 N m - " + gain + " * coordinate(p)",
                            "0.3 N m s * rate(m) + 0.01 N m s^2 * rate(m)^2"),
              dampened(revolute("p", "t", "ball", {0.05, 0, 0}, {0, 0, 1}), 0.08)};
  validate(m);
  return m;
}

} // namespace

TEST_CASE("kinks of torques are told, and stability is where both sides prove it", "[torque][kinks]") {
  SECTION("it grows on one side: unstable, whatever the other") {
    const Solution s = Analysis(lone_rotor(1, "-1 N m s * abs(rate(s))")).solve();
    REQUIRE(s.status == Status::converged);
    CHECK(std::abs(speed(s, "s")) < 1e-12);
    CHECK(s.stable == false);
    CHECK_THAT(s.message,
               ContainsSubstring("The torque of s stands on a kink of its law, where its slope with "
                                 "rate(s) jumps from 1 to -1 N m s/rad"));
    Mechanism other = lone_rotor(1, "0", "1 N m s * abs(rate(s))");
    const Solution load = Analysis(other).solve();
    CHECK(load.stable == false);
    CHECK_THAT(load.message, ContainsSubstring("The load of s stands on a kink"));
  }
  SECTION("one eigenvalue that dies out on both sides: stable") {
    const Solution s =
        Analysis(lone_rotor(1, "1 N m - 2 N m s * max(0 rad/s, rate(s) - 3 rad/s) - 1/3 * 1 N m s * rate(s)"))
            .solve();
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "s"), WithinRel(3, 1e-12));
    CHECK(s.stable == true);
    CHECK_THAT(s.message, ContainsSubstring("jumps from -0.3333 to -2.333 N m s/rad"));
  }
  SECTION("several that die out on both sides: open") {
    Mechanism m = lone_rotor(1.5, "0 N m");
    m.joints[0] = torque_driven(revolute("s", "ground", "r", {0, 0, 0}, {0, 0, 1}), 1.5,
                                "2 N m - 1 N m s * rate(s) - 0.5 N m s * abs(rate(s) - rate(t))");
    m.bodies.push_back(body("q", 1, {1, 0, 0}, {1, 1, 1}));
    m.joints.push_back(
        torque_driven(revolute("t", "ground", "q", {1, 0, 0}, {0, 0, 1}), 1.5, "2 N m - 1 N m s * rate(t)"));
    validate(m);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "s"), WithinRel(2, 1e-12));
    CHECK(!s.stable);
    CHECK(s.stability_reason == StabilityReason::marginal);
    CHECK_THAT(s.message, ContainsSubstring("whether it is stable stays open"));
    // Two inputs cross the kink, and it is told once.
    CHECK(s.message.find("stands on a kink") == s.message.rfind("stands on a kink"));
    const AllSolutions all = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == 1);
    CHECK(!all.equilibria[0].stable);
    CHECK_THAT(all.message, ContainsSubstring("stands on a kink"));
  }
  SECTION("torque and load bend at the same speed") {
    const auto verdict = [](const char* load) {
      return Analysis(lone_rotor(4, "max(0 N m, 5 N m - 1 N m s*rate(s))", load)).solve().stable;
    };
    CHECK(verdict("0.5 N m s*max(0 rad/s, rate(s) - 5 rad/s)") == true);
    CHECK(verdict("-0.5 N m s*max(0 rad/s, rate(s) - 5 rad/s)") == false);
  }
  SECTION("smooth laws have none") {
    for (const char* law : {"1 N m - 1 N m s^2 * rate(s) * abs(rate(s))",
                            "table(rate(s), [0, 12 N m], [2, 4 N m], [5, -10 N m])",
                            "1 N m * tanh(1e8 * (5 - rate(s) * 1 s)) - 0.9 N m",
                            "1 N m * tanh(1e10 * (5 - rate(s) * 1 s)) - 0.9 N m"}) {
      CAPTURE(law);
      const Solution s =
          Analysis(lone_rotor(std::string(law).find("tanh") == std::string::npos ? 1 : 4, law)).solve();
      REQUIRE(s.status == Status::converged);
      CHECK(s.stable == true);
      CHECK(s.message.find("kink") == std::string::npos);
    }
  }
}

TEST_CASE("at roots of higher order the verdict is open, for solve, all and branches alike",
          "[torque][kinks]") {
  SECTION("of a torque, from either side") {
    const auto power = GENERATE("1 N m * (rate(s) * 1 s - 2)^2", "-1e8 N m * (rate(s) * 1 s - 2)^2",
                                "-1 N m * (rate(s) * 1 s - 2)^3");
    const auto guess = GENERATE(1., 3.);
    CAPTURE(power, guess);
    const Mechanism m = lone_rotor(guess, power);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK(std::abs(speed(s, "s") - 2) < 1e-4);
    CHECK(s.stability_reason == StabilityReason::marginal);
    const AllSolutions all = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == 1);
    CHECK(all.equilibria[0].stability_reason == StabilityReason::marginal);
    const ResponseDiagram diagram = follow_branches(m, "bodies.r.mass", 0.5, 2);
    REQUIRE(!diagram.branches.empty());
    for (const ResponsePoint& p : diagram.branches[0].points)
      CHECK(!p.stable);
  }
  SECTION("of a spring") {
    const auto force = GENERATE("1 N/m^2 * (deflection - 0.1 m)^2", "1 N/m^3 * (deflection - 0.1 m)^3");
    CAPTURE(force);
    const Mechanism m = sprung_slide(force);
    CHECK(Analysis(m).solve().stability_reason == StabilityReason::marginal);
    const AllSolutions all = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == 1);
    CHECK(all.equilibria[0].stability_reason == StabilityReason::marginal);
    const ResponseDiagram diagram = follow_branches(m, "joints.s.damping", 0.5, 2);
    REQUIRE(!diagram.branches.empty());
    for (const ResponsePoint& p : diagram.branches[0].points)
      CHECK(!p.stable);
  }
}

TEST_CASE("an unstable steady speed is left for the stable one that the motion goes to", "[torque]") {
  SECTION("of one shaft") {
    const Mechanism m = lone_rotor(1, "3 N m * sin(rate(s) * 1 s)", "0.5 N m s * rate(s)");
    const Solution s = Analysis(m).solve();
    CHECK_THAT(speed(s, "s"), WithinRel(2.67878308, 1e-7)); // 3 sin w = w / 2
    CHECK(s.stable == true);
    CHECK_THAT(s.message, ContainsSubstring("arrived at an unstable state"));
    SolveOptions nearest; // asked for, it is the answer
    nearest.nearest = true;
    CHECK(std::abs(speed(Analysis(m).solve(nearest), "s")) < 1e-9);
  }
  SECTION("with a disc that spins on a swinging arm: as at that speed prescribed") {
    const auto made = [](bool torque) {
      Mechanism m;
      m.bodies = {body("hub", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("arm", 0),
                  body("disc", 1, {0.3, -0.4, 0}, {0.01, 0.02, 0.01})};
      m.bodies[2].rotation = Quat(0.9486832980505138, 0, 0, 0.31622776601683794);
      const Joint spin = revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0});
      m.joints = {torque ? torque_driven(dampened(spin, 0.1), 5, "0.9 N m + 0 N m s * rate(spin)")
                         : driven(spin, 9),
                  dampened(revolute("swing", "hub", "arm", {0, 0, 0}, {0, 0, 1}), 0.2),
                  driven(revolute("disc", "arm", "disc", {0.3, -0.4, 0}, {0.6, -0.8, 0}), 200)};
      validate(m);
      return m;
    };
    const Solution s = Analysis(made(true)).solve(), there = Analysis(made(false)).solve();
    REQUIRE(there.stable == true);
    INFO(s.message);
    CHECK(s.stable == true);
    CHECK_THAT(speed(s, "spin"), WithinRel(9, 1e-10));
    CHECK_THAT(value(s, "swing"), WithinRel(value(there, "swing"), 1e-9));
  }
  SECTION("which grows along (1, -1) alone") {
    // Two balls on one diameter, each on its slide outwards, and a spring of k from one to the other: drawn
    // even they stay even, though -m w^2 < 0 pushes them apart. One goes to its inner stop, and for the other
    // k (r + inner - free) = m w^2 r.
    Mechanism m;
    m.bodies = {body("hub", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("a", 1, {0.1, 0, 0}),
                body("b", 1, {-0.1, 0, 0})};
    m.joints = {torque_driven(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 0, 1}), 10,
                              "10 N m s * (10 rad/s - rate(spin))"),
                dampened(joint(JointType::prismatic, "ra", "hub", "a", {0.1, 0, 0}, {1, 0, 0}), 1),
                dampened(joint(JointType::prismatic, "rb", "hub", "b", {-0.1, 0, 0}, {-1, 0, 0}), 1)};
    for (std::size_t i : {1U, 2U})
      m.joints[i].coordinates[0].stop = Stop{-0.05, 0.2, 1e6};
    m.forces = {point_spring("tie", "a", "b", {0.1, 0, 0}, {-0.1, 0, 0}, 1000, 0.2)};
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    CHECK(s.stable == true);
    CHECK_THAT(speed(s, "spin"), WithinRel(10, 1e-10));
    const double out = std::max(value(s, "ra"), value(s, "rb")),
                 in = std::min(value(s, "ra"), value(s, "rb"));
    CHECK_THAT(in, WithinRel(-0.05, 1e-3)); // of a stiff stop
    CHECK_THAT(out + 0.1, WithinRel(1000 * (0.2 - (in + 0.1)) / (1000 - 100), 1e-9));
  }
  SECTION("a ball on a string") {
    Mechanism m = shipped("ball_on_string");
    m.joints[0] = torque_driven(m.joints[0], 4, "1 N m - 0.1 N m s * rate(spin)");
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable != false);
    CHECK(s.message.find("goes on without end") == std::string::npos);
  }
}

TEST_CASE("a speed is found from almost at rest", "[torque]") {
  Mechanism m = shipped("governor_engine");
  const double speed_there = speed(Analysis(m).solve(), "spin");
  for (const double start : {1e-4, 1e-2, 1., 1e3}) {
    INFO(start << " rad/s");
    set_parameter(m, "joints.spin.drive.speed", start);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(speed_there, 1e-12));
  }
}

TEST_CASE("a speed far above where the search begins is found, or said how far it looked", "[torque]") {
  const Mechanism m = lone_rotor(5, "3 N m + 2 N m * sin(rate(s) * 1 s / 4)", "0.002 N m s * rate(s)");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // The first at which 3 + 2 sin(w/4) falls below 0.002 w: from 5 rad/s the motion comes there from below.
  double w = 5;
  const auto surplus = [](double x) { return 3 + 2 * std::sin(x / 4) - 0.002 * x; };
  while (surplus(w) > 0)
    w += 1e-3;
  CHECK(std::abs(speed(s, "s") - w) < 2e-3);
  CHECK(s.stable == true);
  CHECK(s.fallback == Fallback::slow_motion);
  const Solution none = Analysis(lone_rotor(5, "3 N m + 2 N m * sin(rate(s) * 1 s / 4)")).solve();
  CHECK(none.status == Status::not_converged);
  CHECK_THAT(none.message, ContainsSubstring("runs away"));
  CHECK_THAT(none.message, ContainsSubstring("speeds up to 1.5e+04 rad/s found none"));
}

namespace {

// Links hinged one below the other on a shaft, each with a spring, drawn hanging.
Mechanism sprung_chain(int count) {
  Mechanism m = hanging_chain(count, 3);
  for (int i = 0; i < count; ++i) {
    Joint& hinge = m.joints[static_cast<std::size_t>(i) + 1];
    hinge = sprung(dampened(hinge, 0.01), 0.5 * count, 0.3 / count);
  }
  m.bodies[0].inertia = {0.1, 0.1, 0.1};
  return m;
}

} // namespace

TEST_CASE("a chain that a torque drives stands as at that speed prescribed, however long", "[torque]") {
  const int count = GENERATE(4, 20, 60, 250);
  const bool by_angle = GENERATE(false, true);
  CAPTURE(count, by_angle);
  const Mechanism prescribed = sprung_chain(count);
  Mechanism m = prescribed;
  // 3 rad/s, or what the angle of the first hinge takes off.
  m.joints[0] = torque_driven(m.joints[0], 2.5,
                              by_angle ? "0.9 N m - 0.1 N m s * rate(spin) - 0.3 N m * coordinate(hinge1)"
                                       : "0.9 N m - 0.1 N m s * rate(spin)",
                              "0.2 N m s * rate(spin)");
  validate(m);
  SolveOptions plain;
  plain.details = false;
  const Solution s = Analysis(m).solve(plain);
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double found = speed(s, "spin");
  const double angle = by_angle ? value(s, "hinge1") : 0;
  CHECK_THAT(found, WithinRel(3 - angle, 1e-11));
  if (!by_angle) {
    CHECK(s.stable == true);
    if (count > 8) CHECK(s.stability_reason == StabilityReason::minimum);
  }
  Mechanism at_speed = prescribed;
  at_speed.joints[0].coordinates[0].drive->speed = found;
  SolveOptions from_there = plain;
  for (const CoordinateSolution& c : s.coordinates)
    if (!c.driven && !c.speed) from_there.start.emplace_back(coordinate_label(c), c.value);
  from_there.nearest = true;
  const Solution there = Analysis(at_speed).solve(from_there);
  REQUIRE(there.status == Status::converged);
  double apart = 0;
  for (const CoordinateSolution& c : there.coordinates)
    if (!c.driven) apart = std::max(apart, std::abs(c.value - value(s, c.joint)));
  CHECK(apart < 1e-10);
  if (by_angle) return;
  // And as solving at that speed answers from the drawn pose.
  const Solution answer = Analysis(at_speed).solve(plain);
  CHECK(std::abs(value(answer, "hinge1") - value(s, "hinge1")) < 1e-9);
  // With eigenvalues, of the matrices, the verdict is the same.
  if (count > 60) return;
  const Solution whole = Analysis(m).solve();
  CHECK(whole.stable == true);
  REQUIRE(whole.eigenvalues);
  CHECK(std::ranges::all_of(*whole.eigenvalues, [](std::complex<double> x) { return x.real() < 0; }));
}

TEST_CASE("a chain that a torque turns leaves the pose it hangs in as at that speed prescribed, and as soon",
          "[torque]") {
  const int count = GENERATE(20, 200);
  const double tilt = GENERATE(0., 0.1);
  CAPTURE(count, tilt);
  const Mechanism prescribed = hanging_chain(count, 5);
  Mechanism m = prescribed;
  m.joints[0] = torque_driven(m.joints[0], 4.95, "0.5 N m s * (5 - rate(spin))");
  validate(m);
  SolveOptions options;
  options.details = false;
  options.start = {{"hinge1", tilt}};
  const Solution there = Analysis(prescribed).solve(options), s = Analysis(m).solve(options);
  REQUIRE(there.status == Status::converged);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK_THAT(speed(s, "spin"), WithinRel(5, 1e-12));
  CHECK(std::abs(value(s, "hinge1")) > 0.5);
  for (const CoordinateSolution& c : there.coordinates)
    if (!c.driven) CHECK(std::abs(std::abs(c.value) - std::abs(value(s, c.joint))) < 1e-9); // of either side
  CHECK(s.iterations <= 2 * there.iterations);
}

TEST_CASE("a chain that a torque turns either way goes on the way it is searched for", "[torque]") {
  const int count = GENERATE(5, 12, 40);
  const double from = GENERATE(2.5, -2.5);
  const bool cubic = GENERATE(false, true);
  CAPTURE(count, from, cubic);
  Mechanism m = hanging_chain(count, 1);
  m.joints[0] = torque_driven(m.joints[0], from,
                              cubic ? "2 N m s * rate(spin) * (25 - (rate(spin) / (1 rad/s))^2)"
                                    : "5 N m s * rate(spin) - 0.8 N m s^2 * rate(spin) * abs(rate(spin))");
  for (std::size_t i = 1; i < m.joints.size(); ++i)
    m.joints[i] = dampened(m.joints[i], 0.01);
  validate(m);
  SolveOptions options;
  options.details = false;
  options.start = {{"hinge1", 0.2}};
  const Solution s = Analysis(m).solve(options);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK_THAT(speed(s, "spin"), WithinRel(std::copysign(cubic ? 5 : 6.25, from), 1e-10));
}

TEST_CASE("a long chain that several speeds balance is found at one that it stays at", "[torque]") {
  const double from = GENERATE(0.5, 1.);
  const int count = GENERATE(12, 40);
  const double tilt = GENERATE(0., 0.01);
  CAPTURE(from, count, tilt);
  Mechanism m = resized(hanging_chain(count, 1), 4);
  m.joints[0] = torque_driven(m.joints[0], from, "0.1 N m * sin(rate(spin) / (1 rad/s))");
  for (std::size_t i = 1; i < m.joints.size(); ++i)
    m.joints[i] = dampened(m.joints[i], 0.1);
  validate(m);
  SolveOptions options;
  options.details = false;
  options.start = {{"hinge1", tilt}};
  const Solution s = Analysis(m).solve(options);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK(std::abs(std::remainder(speed(s, "spin") - std::numbers::pi, 2 * std::numbers::pi)) < 1e-10);
}

TEST_CASE("what a minimum at given speeds proves needs torques that fall with these alone",
          "[torque][kinks]") {
  SECTION("shafts alone, more than eight") {
    Mechanism m;
    for (int i = 0; i < 10; ++i) {
      const std::string n = std::to_string(i);
      m.bodies.push_back(body("r" + n, 1, {1. * i, 0, 0}, {1, 1, 1}));
      m.joints.push_back(torque_driven(revolute("s" + n, "ground", "r" + n, {1. * i, 0, 0}, {0, 0, 1}), 1,
                                       "1 N m - 0.3 N m s * rate(s" + n + ")"));
    }
    validate(m);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    CHECK_THAT(speed(s, "s9"), WithinRel(10. / 3, 1e-12));
  }
  SECTION("where eigenvalues leave it open: balls that swing against each other without damping") {
    Mechanism m;
    m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1}), body("right", 1, {0.5, 0, -0.3}, {0, 0, 0}),
                body("left", 1, {-0.5, 0, -0.3}, {0, 0, 0})};
    m.joints = {torque_driven(revolute("spin", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), 4,
                              "2 N m - 0.4 N m s * rate(spin)"),
                revolute("a", "rotor", "right", {0.2, 0, 0}, {0, 1, 0}),
                revolute("b", "rotor", "left", {-0.2, 0, 0}, {0, 1, 0})};
    validate(m);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(5., 1e-12));
    REQUIRE(s.eigenvalues);
    CHECK(std::ranges::any_of(
        *s.eigenvalues, [](std::complex<double> x) { return std::abs(x.real()) < 1e-9 && x.imag() > 1; }));
    CHECK(s.stable == true);
    CHECK(s.stability_reason == StabilityReason::minimum);
  }
  SECTION("kinks of torque and load together: no side alone tells") {
    const int count = GENERATE(4, 9, 20);
    Mechanism m = sprung_chain(count);
    m.joints[0] = torque_driven(m.joints[0], 2.5, "-0.3 N m s * abs(rate(spin) - 3 rad/s)",
                                "0.1 N m s * abs(rate(spin) - 3 rad/s)");
    validate(m);
    const Solution s = Analysis(m).solve();
    CAPTURE(count, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(3., 1e-9));
    CHECK(s.stable != true); // below 3 rad/s it is braked more and more
  }
  SECTION("a torque by the rate of what stands") {
    const bool details = GENERATE(false, true);
    const int count = GENERATE(9, 20);
    Mechanism m = sprung_chain(count);
    m.joints[0] =
        torque_driven(m.joints[0], 2.5, "0.9 N m - 0.1 N m s * rate(spin) + 50 N m s * rate(hinge1)",
                      "0.2 N m s * rate(spin)");
    validate(m);
    SolveOptions options;
    options.details = details;
    const Solution s = Analysis(m).solve(options);
    CAPTURE(count, details, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stability_reason != StabilityReason::minimum);
    CHECK(s.stable == false); // by eigenvalues
  }
}

namespace {

// Two sprung arms with dampers on a shaft, a rotor on one of them, and a shaft beside that a slipping clutch
// drags along: three drives by torques of their own and each other's rates and of the arms' angles.
Mechanism coupled_drives(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto any = [&](double from, double to) {
    return from + (to - from) * (static_cast<double>(random()) / 4294967296.);
  };
  const auto axis = [&] { return Vec3(any(-1, 1), any(-1, 1), any(-1, 1)).normalized(); };
  const auto place = [&] { return Vec3(any(-0.3, 0.3), any(-0.5, 0), any(-0.3, 0.3)); };
  const auto law = [](double x, const std::string& rest) { return "(" + number_text(x) + ") * 1 " + rest; };
  Mechanism m;
  m.bodies = {body("A", 1.5, {0, 0, 0}, {0.1, 0.1, 0.1}), body("C", 1, {1, 0, 0}, {0.05, 0.05, 0.05})};
  const double slip = any(0.1, 0.4);
  m.joints = {
      dampened(torque_driven(revolute("a", "ground", "A", {0, 0, 0}, {0, 1, 0}), any(2, 8),
                             law(any(0.5, 2), "N m") + " - " + law(any(0.05, 0.2), "N m s * rate(a)") +
                                 " + " + law(any(-1, 1), "N m * coordinate(p)") + " - " +
                                 law(slip, "N m s * (rate(a) - rate(c))")),
               0.02),
      torque_driven(revolute("c", "ground", "C", {1, 0, 0}, {0, 1, 0}), any(1, 5),
                    law(slip, "N m s * (rate(a) - rate(c))"), law(any(0.1, 0.3), "N m s * rate(c)"))};
  for (const char* name : {"p", "q"}) {
    const Vec3 at = place();
    m.bodies.push_back(body(name, any(0.2, 0.6), at + any(0.05, 0.15) * axis(), {0.01, 0.012, 0.014}));
    const Joint arm = dampened(revolute(name, "A", name, at, axis()), any(0.2, 0.4));
    m.joints.push_back(sprung(arm, any(8, 15), any(-0.2, 0.2)));
  }
  const Vec3 on_arm = m.bodies[2].position;
  const Vec3 about = axis();
  m.bodies.push_back(body("rotor", 0.15, on_arm, {0.005, 0.005, 0.008}));
  m.bodies.back().rotation = Quat::FromTwoVectors(Vec3::UnitZ(), about);
  m.joints.push_back(torque_driven(revolute("b", "p", "rotor", on_arm, about), any(20, 50),
                                   "table(rate(b), [0, 1.2 N m], [50, 0.4 N m], [150, 0 N m])",
                                   law(any(0.002, 0.004), "N m s * rate(b)") + " + " +
                                       law(any(-0.01, 0.01), "N m * sin(coordinate(q))")));
  validate(m);
  return m;
}

} // namespace

TEST_CASE("a branch begins at the answer that solving gives, not where Newton-Raphson goes past it",
          "[torque][branches]") {
  const Mechanism m = arm_on_a_shaft("3 N m");
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  const double w = speed(s, "m"), q = value(s, "p");
  CHECK_THAT(w * w * (0.05 + 0.3 * std::sin(q)) * std::cos(q), WithinRel(9.80665 * std::sin(q), 1e-9));
  CHECK_THAT(5 - 3 * q, WithinRel(0.3 * w + 0.01 * w * w, 1e-9));
  const ResponseDiagram d = follow_branches(m, "joints.p.damping", 0.08, 0.04);
  const auto begins_there = [&](const ResponseBranch& branch) {
    return branch.connected &&
           std::ranges::any_of(branch.points.front().coordinates, [&](const CoordinateSolution& c) {
             return c.joint == "p" && std::abs(c.value - q) < 1e-9;
           });
  };
  CHECK(std::ranges::any_of(d.branches, begins_there));
}

TEST_CASE("a far state is left for the nearest stable one where the state that it went past hunts",
          "[torque]") {
  const Mechanism m = arm_on_a_shaft("3.1 N m"); // beyond the Hopf point at 3.012 N m
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK(std::abs(value(s, "p")) < 2);
  expect_same_motion(m, s, "m", 100, 1);
}

TEST_CASE("curves of hunting go through the branch of the present state, too", "[torque][hopf]") {
  // Where the range begins the state hunts, and solving answers with another.
  Mechanism m = arm_on_a_shaft("3 N m");
  m.joints[1].coordinates[0].damping = 0.09;
  const PlaneCurves found = hopf_curves(m, {"joints.p.damping", 0.002, 0.3}, {"bodies.ball.mass", 1.1, 1.3});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1);
  // By the characteristic polynomial of the three equations of motion, in extended precision.
  CHECK(std::ranges::any_of(found.curves[0].points, [](const PlanePoint& p) {
    return std::abs(p.y - 1.2) < 1e-12 && std::abs(p.x - 0.07927815972081996) < 1e-9;
  }));
}

TEST_CASE("random mechanisms with three coupled drives end where solving says", "[torque][random]") {
  int followed = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const Mechanism m = coupled_drives(seed);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    if (s.stable != true) continue;
    double slowest = 1e9;
    for (const std::complex<double> x : *s.eigenvalues)
      slowest = std::min(slowest, -x.real());
    SimulationOptions run;
    run.duration = std::log(1e7) / slowest;
    run.rate = 0;
    run.tolerance = 1e-8;
    const Run motion = simulate(m, run);
    REQUIRE(motion.status == RunStatus::completed);
    ++followed;
    const std::size_t last = motion.time.size() - 1;
    CHECK(distance_from(motion, last, s) < 1e-4);
    for (const char* shaft : {"a", "b", "c"}) {
      const auto track = std::ranges::find(motion.coordinates, shaft, &CoordinateTrack::joint);
      CHECK_THAT(track->rate[last], WithinRel(speed(s, shaft), 1e-4));
    }
  }
  CAPTURE(followed);
  CHECK(followed > 40);
}

// A shaft with an eccentric mass across gravity, prescribed, and one by torque that a spring ties to it: they
// turn together, wherever the search for the second one's speed begins.
TEST_CASE("the torque of a drive that another goes along with ranges over a turn of both", "[torque]") {
  const double guess = GENERATE(8., 10.);
  const double mass = 2, eccentricity = 0.05;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("a", mass, {eccentricity, 0, 0}, {0.1, 0.1, 0.1}),
              body("b", 1, {0, 0, 0.5}, {0.1, 0.1, 0.1})};
  m.joints = {driven(revolute("p", "ground", "a", {0, 0, 0}, {0, 0, 1}), 10),
              torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), guess,
                            "5 N m - 0.4 N m s * rate(q)")};
  m.forces = {point_spring("tie", "a", "b", {0.1, 0, 0.25}, {0.1, 0, 0.25}, 2000, 0)};
  validate(m);
  const Solution s = Analysis(m).solve();
  CAPTURE(guess, s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "q"), WithinRel(10, 1e-12));
  const auto torque = std::ranges::find(s.drive_torques, "p", &DriveTorque::joint);
  REQUIRE(torque != s.drive_torques.end());
  REQUIRE(torque->varying);
  REQUIRE(torque->range.has_value());
  const double weight = mass * standard_gravity * eccentricity;
  CHECK_THAT(torque->range->mean, WithinRel(-1, 1e-9));
  CHECK_THAT(torque->range->least, WithinRel(-1 - weight, 1e-9));
  CHECK_THAT(torque->range->most, WithinRel(-1 + weight, 1e-9));
}

TEST_CASE("a thin rod that turns about itself has no mode there", "[torque]") {
  // On a shaft that a torque turns: its damper and spring alone tell the rate, -k / c. Its inertia about its
  // own axis is rounding.
  std::mt19937 random(5);
  for (int i = 0; i < 30; ++i) {
    const auto number = [&] { return uniform(random, -1, 1); };
    const Vec3 e = Vec3(number(), number(), number()).normalized();
    Mechanism m;
    m.bodies = {body("hub", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("rod", 0.8, 0.3 * e)};
    const Mat3 inertia = 0.01 * (Mat3::Identity() - e * e.transpose());
    m.bodies[1].inertia = {inertia(0, 0), inertia(1, 1), inertia(2, 2),
                           inertia(0, 1), inertia(0, 2), inertia(1, 2)};
    m.joints = {torque_driven(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0}), 5,
                              "2 N m - 0.2 N m s * rate(spin)"),
                dampened(revolute("roll", "hub", "rod", {0, 0, 0}, e), 0.3)};
    m.joints[1].coordinates[0].spring = CoordinateSpring{5, 0};
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(i << ": " << s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    REQUIRE(s.eigenvalues);
    CHECK(std::ranges::any_of(*s.eigenvalues,
                              [](std::complex<double> x) { return std::abs(x + 5 / 0.3) < 1e-6; }));
    CHECK(std::ranges::none_of(*s.eigenvalues, [](std::complex<double> x) { return std::abs(x) > 1e3; }));
  }
}
