// Drives that give a torque: their steady speeds against closed forms, against the same state at prescribed
// speed and against motions that settle; their stability against characteristic polynomials.
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/hopf_curve.hpp"
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <complex>
#include <optional>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

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
    const HaugGovernor closed = HaugGovernor::at_collar(row.collar);
    CHECK_THAT(closed.speed(), WithinRel(row.speed, 1e-13));
    for (const Complex x : *s.eigenvalues) {
      const auto p = closed.characteristic(30, 7500);
      CHECK(std::abs(cubic(p, x)) < 1e-9 * std::abs(p[1]) * std::norm(x));
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

TEST_CASE("a speed has the sign that it was looked for with where its mirror image balances, too",
          "[torque]") {
  const auto damper = [&](double d, double gain) {
    Mechanism m = stored_case("governor_steps_over_standstill");
    set_parameter(m, "parameters.d", d);
    set_parameter(m, "parameters.gain", gain);
    return m;
  };
  for (const double gain : {7500., 12000.}) {
    CAPTURE(gain);
    const Solution s = Analysis(damper(25, gain)).solve();
    REQUIRE(s.status == Status::converged);
    const double w = speed(s, "spin");
    CHECK(w > 0);
    CHECK(s.stable == (gain < 10000));
    // The balance of the shaft, whose load goes with the square of the speed.
    const double height = 0.2 - value(s, "slide");
    CHECK_THAT(gain * (0.0506 - height), WithinRel(0.02 * w * w, 1e-9));
  }
  // Beside what really turns back, too.
  Mechanism with_fan = damper(25, 7500);
  Body blades;
  blades.name = "fan";
  blades.mass = 1;
  blades.inertia = {1, 1, 1};
  with_fan.bodies.push_back(blades);
  Joint fan;
  fan.name = "fan bearing";
  fan.type = JointType::revolute;
  fan.bodies = {"ground", "fan"};
  fan.axis = Vec3::UnitZ();
  fan.coordinates.resize(1);
  fan.coordinates[0].damping = 1;
  fan.coordinates[0].drive = Drive{.speed = 3, .torque = -5};
  with_fan.joints.push_back(fan);
  const Solution both = Analysis(with_fan).solve();
  REQUIRE(both.status == Status::converged);
  CHECK(speed(both, "spin") > 0);
  CHECK_THAT(speed(both, "fan bearing"), WithinRel(-5., 1e-12));
  // Hunting is crossed by that state alone; its eigenvalues say on which sides.
  const ResponseDiagram d = follow_branches(damper(25, 7500), "parameters.d", 15, 60);
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::hopf);
  const double limit = d.special[0].at.parameter;
  CHECK(Analysis(damper(limit * 0.999, 7500)).solve().stable == false);
  CHECK(Analysis(damper(limit * 1.001, 7500)).solve().stable == true);
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
  const auto p = HaugGovernor::at_collar(0.15).characteristic(1, 1);
  CHECK_THAT(hopf("joints.slide.damping", 60, 5), WithinRel(7500 * p[3] * p[0] / (p[1] * p[2]), 1e-9));
  CHECK_THAT(hopf("parameters.gain", 5000, 15000), WithinRel(30 * p[1] * p[2] / (p[3] * p[0]), 1e-9));

  // Vyshnegradsky's diagram over the load, which moves the collar.
  const PlaneCurves plane = hopf_curves(shipped("governor_engine"), {"joints.slide.damping", 5, 60},
                                        {"joints.spin.drive.load", -25, 25});
  REQUIRE(plane.curves.size() == 1);
  CHECK(plane.curves[0].points.size() > 20);
  for (const PlanePoint& at : plane.curves[0].points) {
    const auto there = HaugGovernor::at_collar(0.15 + at.y / 7500).characteristic(1, 7500);
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

TEST_CASE("a balance whose terms all vanish is found like any other", "[torque]") {
  // A cart by a law that names what rides on it, where no weight acts: what rides is free of force.
  for (const double free : {0., 0.02})
    for (const double start : {4., 5., -3.})
      for (const std::string stiffness : {"200", "1", "1e6"}) {
        CAPTURE(free, start, stiffness);
        Mechanism m;
        m.bodies = {body("cart", 2, {0, 0, 0}), body("rider", 0.5, {0, 0.2, 0})};
        m.joints = {torque_driven(prismatic("p", "ground", "cart", {0, 0, 0}, {1, 0, 0}), start,
                                  "6 N - 1.2 N s/m*rate(p) - 0.5 N/m*coordinate(s)"),
                    dampened(sprung(prismatic("s", "cart", "rider", {0, 0.2, 0}, {0, 1, 0}),
                                    std::stod(stiffness), free),
                             5)};
        validate(m);
        const Solution s = Analysis(m).solve();
        INFO(s.message);
        REQUIRE(s.status == Status::converged);
        CHECK(s.stable == true);
        CHECK_THAT(speed(s, "p"), WithinRel((6 - 0.5 * free) / 1.2, 1e-14));
        CHECK(std::abs(value(s, "s") - free) <= 1e-16);
        CHECK(s.iterations < 10);
      }
  // Wheels on a rack, and rest as the answer.
  Mechanism m;
  m.bodies = {body("cart", 1, {0, 0, 0}), body("wheel", 1, {0, -0.2, 0}, {0.1, 0.1, 0.1}),
              body("rider", 1, {0, 0, 0}, {0.1, 0.1, 0.1})};
  Joint rack = gear("rack", "roll", "p", 0);
  rack.kind = GearKind::rack;
  rack.radii = {0.2, 1};
  m.joints = {torque_driven(prismatic("p", "ground", "cart", {0, 0, 0}, {1, 0, 0}), 4,
                            "6 N - 0.01 N/rad*coordinate(s)"),
              dampened(sprung(revolute("s", "cart", "rider", {0, 0, 0}, {0, 1, 0}), 10), 0.1),
              dampened(revolute("roll", "cart", "wheel", {0, -0.2, 0}, {0, 0, 1}), 0.2), rack};
  validate(m);
  const Solution rolling = Analysis(m).solve();
  CHECK_THAT(speed(rolling, "p"), WithinRel(1.2, 1e-13));
  CHECK_THAT(speed(rolling, "roll"), WithinRel(6, 1e-13));
  Mechanism slow;
  slow.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
  slow.joints = {torque_driven(revolute("a", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 4,
                               "table(rate(a), [-1e6, 1 N m], [1e6, -1 N m])")};
  const Solution rest = Analysis(slow).solve();
  REQUIRE(rest.status == Status::converged);
  CHECK(std::abs(speed(rest, "a")) < 1e-9); // the table's ends round by that
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

TEST_CASE("a pendulum drawn hanging on a shaft swings out as the motion from beside there does", "[torque]") {
  // The slow motion must not step backwards along what falls.
  const auto [length, law] = GENERATE(std::pair<double, const char*>(2, "60 N m - 20 N m s * rate(spin)"),
                                      std::pair<double, const char*>(1.2, "6 N m - 2 N m s * rate(spin)"));
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1, Vec3::Zero(), {0.1, 0.1, 0.1}),
              body("bob", 1, {0, -length, 0}, {0.01, 0.01, 0.01})};
  m.joints = {torque_driven(revolute("spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()), 3, law),
              dampened(revolute("hinge", "hub", "bob", Vec3::Zero(), Vec3::UnitZ()), 0.1)};
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK(s.fallback == Fallback::slow_motion);
  CHECK_THAT(std::cos(s.coordinates[1].value), WithinRel(standard_gravity / (9 * length), 1e-12));
}

TEST_CASE("where the slow motion leads does not depend on the unit of time", "[torque]") {
  // The pendulum above, in seconds of another length.
  std::optional<int> iterations;
  for (const double second : {1., 0x1p-20, 0x1p-10, 0x1p-5, 0x1p5, 0x1p10, 0x1p20}) {
    CAPTURE(second);
    const double square = second * second;
    Mechanism m;
    m.gravity = {0, -standard_gravity / square, 0};
    m.bodies = {body("hub", 1, Vec3::Zero(), {0.1, 0.1, 0.1}),
                body("bob", 1, {0, -2, 0}, {0.01, 0.01, 0.01})};
    m.joints = {torque_driven(revolute("spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()), 3 / second,
                              number_text(60 / square) + " N m - " + number_text(20 / second) +
                                  " N m s * rate(spin)"),
                dampened(revolute("hinge", "hub", "bob", Vec3::Zero(), Vec3::UnitZ()), 0.1 / second)};
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK(s.fallback == Fallback::slow_motion);
    CHECK_THAT(std::cos(s.coordinates[1].value), WithinRel(standard_gravity / 18, 1e-12));
    if (!iterations) iterations = s.iterations;
    CHECK(s.iterations == *iterations);
  }
}

TEST_CASE("where the slow motion of many links leads does not depend on the unit of time", "[torque]") {
  // A chain hung on a shaft beside its axis: beyond the dense matrices.
  constexpr int links = 12;
  std::optional<int> iterations;
  std::vector<double> angles;
  for (const double second : {1., 1e-6, 1e-3, 1e2, 1e5}) {
    CAPTURE(second);
    const double square = second * second;
    Mechanism m;
    m.gravity = {0, -standard_gravity / square, 0};
    m.bodies = {body("hub", 1, Vec3::Zero(), {0.1, 0.1, 0.1})};
    m.joints = {torque_driven(revolute("spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()), 1 / second,
                              number_text(60 / square) + " N m - " + number_text(20 / second) +
                                  " N m s * rate(spin)")};
    for (int i = 0; i < links; ++i) {
      const std::string name = "link" + std::to_string(i), before = i ? m.bodies.back().name : "hub";
      m.bodies.push_back(body(name, 0.1, {0, -0.2 * i - 0.2, 0}, {1e-4, 1e-4, 1e-4}));
      m.joints.push_back(
          dampened(revolute("hinge" + std::to_string(i), before, name, {0, -0.2 * i, 0}), 0.1 / second));
    }
    REQUIRE(compile_for_drives(m).kkt_form == KktForm::tree);
    const Solution s = Analysis(m).solve();
    CAPTURE(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.fallback == Fallback::slow_motion);
    if (!iterations) iterations = s.iterations;
    CHECK(s.iterations == *iterations);
    for (int i = 0; i < links; ++i) {
      const double angle = s.coordinates[static_cast<std::size_t>(i) + 1].value;
      if (angles.size() < links) angles.push_back(angle);
      CHECK_THAT(angle, Catch::Matchers::WithinAbs(angles[static_cast<std::size_t>(i)], 1e-9));
    }
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
