// Plates and blades in the air, in wind and in air that turns with a body, against closed forms and motions
// that settle.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
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
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double g = 9.80665, rho = 1.225;

Force vane(const std::string& name, const std::string& on, const Vec3& at, double area, const Vec3& normal,
           double cn, double cd) {
  Force f;
  f.name = name;
  f.type = ForceType::vane;
  f.body = on;
  f.at = at;
  f.area = area;
  f.normal = normal;
  f.cn = cn;
  f.cd = cd;
  return f;
}

Force linear_drag(const std::string& name, const std::string& on, const Vec3& at, double linear) {
  Force f;
  f.name = name;
  f.type = ForceType::drag;
  f.body = on;
  f.at = at;
  f.linear = linear;
  return f;
}

Joint by_torque(Joint j, double torque, double guess) {
  Drive& drive = j.coordinates[0].drive.emplace();
  drive.speed = guess;
  drive.torque = torque;
  return j;
}

Body disc(const std::string& name, double inertia) {
  return body(name, 1, {0, 0, 0}, {inertia, inertia, 2 * inertia});
}

double speed(const Solution& s, std::string_view joint) {
  INFO(s.message);
  return coordinate(s, joint).speed.value();
}

// A shaft about z, at its rim vanes square to their motion.
Mechanism fan(int vanes, double torque) {
  Mechanism m;
  m.bodies = {disc("shaft", 0.02)};
  m.joints = {by_torque(revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 0, 1}), torque, 5)};
  for (int i = 0; i < vanes; ++i) {
    const double angle = 2 * std::numbers::pi * i / vanes;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    m.forces.push_back(
        vane("vane" + std::to_string(i), "shaft", 0.3 * out, 0.04, Vec3(-out.y(), out.x(), 0), 1.1, 0.1));
  }
  return m;
}

// A plate that hangs on a hinge, square to a wind along x.
Mechanism hung_plate(double wind) {
  Mechanism m;
  m.gravity = {0, 0, -g};
  m.air.wind = {wind, 0, 0};
  m.bodies = {body("plate", 0.5, {0, 0, -0.4}, {0.01, 0.01, 0.01})};
  m.joints = {revolute("hinge", "ground", "plate", {0, 0, 0}, {0, -1, 0})};
  m.forces = {vane("plate", "plate", {0, 0, -0.4}, 0.06, {1, 0, 0}, 1.2, 0.05)};
  return m;
}

// A weight on an arm that a shaft turns, and in its place in the air a vane.
Mechanism turning_arm(bool in_air) {
  Mechanism m;
  m.gravity = {0, 0, -g};
  m.bodies = {disc("spindle", 0.02), body("ball", 1, {0.3, 0, -0.3}, {0.001, 0.001, 0.001})};
  m.joints = {driven(revolute("spin", "ground", "spindle", {0, 0, 0}, {0, 0, 1}), 8),
              dampened(revolute("arm", "spindle", "ball", {0, 0, 0}, {0, -1, 0}), 0.2)};
  if (in_air) m.forces = {vane("vane", "ball", {0.3, 0, -0.3}, 0.1, {1, 2, 0.5}, 1.2, 0.3)};
  return m;
}

} // namespace

TEST_CASE("a fan holds a shaft at the root of its torque", "[air]") {
  const Mechanism m = fan(4, 0.7);
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double k = 4 * 0.5 * rho * 0.04 * (1.1 + 0.1) * std::pow(0.3, 3), w = std::sqrt(0.7 / k);
  CHECK_THAT(speed(s, "spin"), WithinRel(w, 1e-13));
  CHECK(s.stable == true);
  REQUIRE(s.eigenvalues->size() == 1);
  CHECK_THAT((*s.eigenvalues)[0].real(), WithinRel(-2 * k * w / 0.04, 1e-12));
  SimulationOptions run;
  run.duration = 20 * 0.04 / (2 * k * w);
  run.rate = 1 / run.duration;
  const Run motion = simulate(m, run);
  REQUIRE(motion.status == RunStatus::completed);
  CHECK_THAT(motion.coordinates.at(0).rate.back(), WithinRel(w, 1e-8));
  // The density is a number like others: w goes with its power of -1/2.
  Mechanism slid = m;
  slid.sliders = {{"air.density", 0.5, 2, SliderScale::linear, ""},
                  {"forces.vane0.area", 0.01, 0.1, SliderScale::linear, ""}};
  const Solution with_rates = Analysis(slid).solve();
  REQUIRE(with_rates.sensitivities.size() == 2);
  CHECK_THAT(with_rates.sensitivities[0].rates.at(0).value, WithinRel(-0.5 * w / rho, 1e-11));
  CHECK_THAT(with_rates.sensitivities[1].rates.at(0).value, WithinRel(-0.125 * w / 0.04, 1e-11));
}

TEST_CASE("a plate hangs in the wind at the angle of its weight", "[air]") {
  for (const double wind : {0.5, 3., 9., -4.}) {
    CAPTURE(wind);
    const Mechanism m = hung_plate(wind);
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    // Both parts of the force have the cosine of the angle at the arm.
    const double push = 0.5 * rho * 0.06 * wind * std::abs(wind) * (1.2 + 0.05);
    CHECK_THAT(coordinate(s, "hinge").value, WithinRel(std::atan(push / (0.5 * g)), 1e-13));
    CHECK(s.stable == true);
    SimulationOptions run;
    run.duration = 400;
    run.rate = 0.01;
    if (wind != 9) continue; // others die out too slowly
    const Run motion = simulate(m, run);
    REQUIRE(motion.status == RunStatus::completed);
    CHECK_THAT(motion.coordinates.at(0).value.back(), WithinRel(coordinate(s, "hinge").value, 1e-6));
  }
}

TEST_CASE("a plate in still air swings on and on as far as the linear motion tells", "[air]") {
  const Solution s = Analysis(hung_plate(0)).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(!s.stable);
  CHECK(s.stability_reason == StabilityReason::marginal);
  CHECK_THAT(s.message, ContainsSubstring("the linear motion does not show whether it dies out"));
}

TEST_CASE("a weather vane stands along the wind, and nowhere else stably", "[air]") {
  Mechanism m;
  m.air.wind = {6, 0, 0};
  m.bodies = {body("vane", 0.3, {0.2, 0, 0}, {0.002, 0.002, 0.002})};
  m.joints = {revolute("post", "ground", "vane", {0, 0, 0}, {0, 0, 1})};
  m.forces = {vane("blade", "vane", {0.25, 0, 0}, 0.02, {0, 1, 0}, 3.5, 0)};
  m.forces[0].chord = Vec3(1, 0, 0);
  validate(m);
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(coordinate(s, "post").value, WithinAbs(0, 1e-14));
  CHECK(s.stable == true);
  // J x^2 + C x + K = 0 with the slope of lift cn.
  const double b = 0.5 * rho * 0.02 * 3.5, j = 0.002 + 0.3 * 0.04, c = b * 6 * 0.25 * 0.25, k = b * 36 * 0.25;
  REQUIRE(s.eigenvalues->size() == 2);
  CHECK_THAT((*s.eigenvalues)[0].real(), WithinRel(-c / (2 * j), 1e-12));
  CHECK_THAT(std::abs((*s.eigenvalues)[0].imag()), WithinRel(std::sqrt(k / j - c * c / (4 * j * j)), 1e-12));
  m.joints[0].coordinates[0].drawn = 0;
  m.air.wind = {-6, 0, 0};
  SolveOptions nearest;
  nearest.nearest = true;
  const Solution against = Analysis(m).solve(nearest);
  REQUIRE(against.status == Status::converged);
  CHECK_THAT(coordinate(against, "post").value, WithinAbs(0, 1e-14));
  CHECK(against.stable == false);
}

TEST_CASE("a windmill without load turns so that the flow runs along its blades", "[air]") {
  // Blades alone: along the span flow does nothing, and drag is none.
  const double pitch = 0.4, radius = 1.5, wind = 7;
  Mechanism m;
  m.air.wind = {0, 0, wind};
  m.bodies = {disc("rotor", 2)};
  m.joints = {by_torque(revolute("spin", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), 0, 1)};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    const Vec3 out(std::cos(angle), std::sin(angle), 0), round(-out.y(), out.x(), 0);
    m.forces.push_back(vane("blade" + std::to_string(i), "rotor", radius * out, 0.2,
                            std::cos(pitch) * round + std::sin(pitch) * Vec3::UnitZ(), 5, 0));
    m.forces.back().chord = Vec3(std::cos(pitch) * Vec3::UnitZ() - std::sin(pitch) * round);
  }
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "spin"), WithinRel(wind * std::tan(pitch) / radius, 1e-12));
  CHECK(s.stable == true);
}

TEST_CASE("a wind across what turns leaves no steady state, one along it does", "[air]") {
  Mechanism m = turning_arm(true);
  m.forces[0].name = "sail";
  for (const ForceType type : {ForceType::vane, ForceType::drag}) {
    m.forces[0].type = type;
    m.forces[0].linear = 0.2;
    m.forces[0].quadratic = 0.1;
    CAPTURE(type_name(type));
    m.air.wind = {0, 0, 2};
    const Solution along = Analysis(m).solve();
    INFO(along.message);
    CHECK(along.status == Status::converged);
    m.air.wind = {0.5, 0, 2};
    const Solution across = Analysis(m).solve();
    CHECK(across.status == Status::no_steady_state);
    CHECK_THAT(across.message, ContainsSubstring("the " + std::string(type_name(type)) + " sail"));
  }
}

TEST_CASE("air that turns with the frame is still in it", "[air]") {
  Mechanism in_air = turning_arm(true);
  in_air.air.turns_with = "spindle";
  validate(in_air);
  const Solution without = Analysis(turning_arm(false)).solve(), with = Analysis(in_air).solve(),
                 still = Analysis(turning_arm(true)).solve();
  REQUIRE(with.status == Status::converged);
  CHECK_THAT(coordinate(with, "arm").value, WithinRel(coordinate(without, "arm").value, 1e-14));
  CHECK_THAT(with.drive_torques.at(0).value, WithinAbs(0, 1e-13));
  CHECK(with.stability_reason == without.stability_reason); // there is a potential
  CHECK(std::abs(coordinate(still, "arm").value - coordinate(without, "arm").value) > 1e-3);
  CHECK(still.drive_torques.at(0).value > 0.1);
  // What solved in still air finds what turns it now.
  Analysis analysis(turning_arm(true));
  analysis.solve();
  analysis.update(in_air);
  CHECK_THAT(coordinate(analysis.solve(), "arm").value, WithinRel(coordinate(with, "arm").value, 1e-13));
  // The motion on the way there is held back by it.
  SimulationOptions run;
  run.duration = 60;
  run.rate = 0.05;
  const Run motion = simulate(in_air, run);
  REQUIRE(motion.status == RunStatus::completed);
  for (const CoordinateTrack& track : motion.coordinates)
    if (track.joint == "arm") CHECK_THAT(track.value.back(), WithinRel(coordinate(with, "arm").value, 1e-7));
}

TEST_CASE("a housing drives a rotor by its air, and feels it", "[air]") {
  // Drag at two points of the rotor is 2 b r^2 (W - w), a load on its shaft is c w.
  const double b = 0.8, r = 0.5, c = 0.25, by_air = 2 * b * r * r;
  Mechanism m;
  m.bodies = {disc("housing", 0.5), disc("rotor", 0.1)};
  m.joints = {driven(revolute("outer", "ground", "housing", {0, 0, 0}, {0, 0, 1}), 20),
              dampened(by_torque(revolute("inner", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), 0, 3), c)};
  m.forces = {linear_drag("air1", "rotor", {r, 0, 0}, b), linear_drag("air2", "rotor", {-r, 0, 0}, b)};
  m.air.turns_with = "housing";
  SECTION("at a given speed") {
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const double w = by_air * 20 / (by_air + c);
    CHECK_THAT(speed(s, "inner"), WithinRel(w, 1e-13));
    CHECK_THAT(s.drive_torques.at(0).value, WithinRel(c * w, 1e-12));
    CHECK(s.stable == true);
  }
  SECTION("by a torque") {
    m.joints[0] = by_torque(revolute("outer", "ground", "housing", {0, 0, 0}, {0, 0, 1}), 3, 10);
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "inner"), WithinRel(3 / c, 1e-12));
    CHECK_THAT(speed(s, "outer"), WithinRel(3 / c + 3 / by_air, 1e-12));
    CHECK(s.stable == true);
    SimulationOptions run;
    run.duration = 300;
    run.rate = 0.01;
    const Run motion = simulate(m, run);
    INFO(motion.message);
    REQUIRE(motion.status == RunStatus::completed);
    for (const CoordinateTrack& track : motion.coordinates)
      CHECK_THAT(track.rate.back(), WithinRel(speed(s, track.joint), 1e-8));
    // What the drive gives is what damper and air take, less what is in the wheels.
    const double taken = motion.energy.dissipated.back(), kinetic = motion.energy.kinetic.back();
    CHECK_THAT(taken + kinetic - motion.energy.kinetic.front(),
               WithinRel(motion.energy.applied.back(), 1e-7));
  }
}

TEST_CASE("the fan governor's weight sets the speed by its root", "[air]") {
  Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/fan_governor.json");
  for (const double mass : {2.5, 7.}) {
    set_parameter(m, "bodies.weight.mass", mass);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const double k = 2 * 0.5 * rho * 0.012 * 1.2 * std::pow(0.13, 3), w = std::sqrt(mass * g * 0.03 / 12 / k);
    CHECK_THAT(speed(s, "fan"), WithinRel(w, 1e-12));
    CHECK_THAT(speed(s, "fall"), WithinRel(w / 12 * 0.03, 1e-12));
    CHECK(s.stable == true);
  }
}

TEST_CASE("the windmill turns where its blades give what the pump takes", "[air]") {
  const Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/windmill.json");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // By the angle of attack, and halving.
  const auto left = [](double w) {
    const double past = w * 0.8, flow = std::hypot(8, past), attack = std::atan2(8, past) - 0.35;
    const double lift = 4.5 * std::sin(attack) * std::cos(attack),
                 drag = 4.5 * std::pow(std::sin(attack), 2) + 0.02;
    const double round = (lift * 8 - drag * past) / flow;
    return 3 * 0.5 * rho * 0.12 * flow * flow * round * 0.8 - 0.15 * w * w;
  };
  double low = 0.1, high = 50;
  for (int i = 0; i < 200; ++i)
    (left((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  CHECK_THAT(speed(s, "axle"), WithinRel(low, 1e-12));
  CHECK(s.stable == true);
}

namespace {

// In place of cn and cd.
Force with_polar(Force blade, const std::string& lift, const std::string& drag) {
  blade.lift = blade.drag = 0;
  blade.formulas.push_back({"drag", drag});
  blade.formulas.push_back({"lift", lift});
  return blade;
}

// A shaft in a wind along it, with blades whose chords lie in the plane of the turn.
Mechanism blades(double wind, double radius, double area, const std::string& lift, const std::string& drag,
                 double torque, double guess) {
  Mechanism m;
  m.air.wind = {0, 0, wind};
  m.bodies = {disc("rotor", 2)};
  m.joints = {by_torque(revolute("spin", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), torque, guess)};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    const Vec3 out(std::cos(angle), std::sin(angle), 0), round(-out.y(), out.x(), 0);
    Force blade = vane("blade" + std::to_string(i), "rotor", radius * out, area, Vec3::UnitZ(), 0, 0);
    blade.chord = -round; // it moves along +round, so that the flow comes along the chord
    m.forces.push_back(with_polar(blade, lift, drag));
  }
  return m;
}

// Where f falls through zero.
template <class F>
double root(const F& f, double low, double high) {
  for (int i = 0; i < 200; ++i)
    (f((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low;
}

} // namespace

TEST_CASE("a plate's own polar is the plate", "[air]") {
  Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/windmill.json");
  const Solution by_plate = Analysis(m).solve();
  for (Force& f : m.forces)
    if (f.type == ForceType::vane)
      f = with_polar(f, "4.5*sin(incidence)*cos(incidence)", "4.5*sin(incidence)^2 + 0.02");
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "axle"), WithinRel(speed(by_plate, "axle"), 1e-13));
  REQUIRE(s.eigenvalues->size() == by_plate.eigenvalues->size());
  for (std::size_t i = 0; i < s.eigenvalues->size(); ++i)
    CHECK(std::abs((*s.eigenvalues)[i] - (*by_plate.eigenvalues)[i]) <=
          1e-11 * std::abs((*s.eigenvalues)[i]));
}

TEST_CASE("a rotor of airfoils turns at the speed of its polar", "[air]") {
  // Round the shaft: rho A / 2 |u|^2 r (cl sin a - cd cos a) with tan a = wind / (w r).
  const double wind = 6, radius = 1.2, area = 0.15, drag = 0.02;
  const auto moment = [&](double w, const auto& lift) {
    const double past = w * radius, a = std::atan2(wind, past);
    return 3 * 0.5 * rho * area * (wind * wind + past * past) * radius *
           (lift(a) * std::sin(a) - drag * std::cos(a));
  };
  SECTION("by an expression") {
    const auto lift = [](double a) { return 1.1 * std::sin(2 * a) + 0.05; };
    for (const double load : {0., 4., -3.}) {
      const Mechanism m = blades(wind, radius, area, "1.1*sin(2*incidence) + 0.05", "0.02", -load, 50);
      validate(m);
      const Solution s = Analysis(m).solve();
      INFO(s.message);
      REQUIRE(s.status == Status::converged);
      const double w = root([&](double at) { return moment(at, lift) - load; }, 5, 1000);
      CHECK_THAT(speed(s, "spin"), WithinRel(w, 1e-12));
      CHECK(s.stable == true);
      // J s = dM/dw.
      const double h = 1e-4 * w, slope = (moment(w + h, lift) - moment(w - h, lift)) / (2 * h);
      REQUIRE(s.eigenvalues->size() == 1);
      CHECK_THAT((*s.eigenvalues)[0].real(), WithinRel(slope / 4, 1e-6));
    }
  }
  SECTION("by a table, its coefficient that of a point of it") {
    // At 6 deg lift is 0.7: the load is chosen so that it turns there.
    const double a = 6 * std::numbers::pi / 180, w = wind / std::tan(a) / radius;
    const double load = moment(w, [](double) { return 0.7; });
    Mechanism m =
        blades(wind, radius, area,
               "table(incidence, [-180 deg, 0], [-90 deg, 0], [-12 deg, -1.1], [0, 0], [6 deg, 0.7], "
               "[9 deg, 1], [12 deg, 1.1], [90 deg, 0], [180 deg, 0])",
               "cd", -load, 50);
    m.parameters = {{"cd", "", drag, "", {}}};
    m.sliders = {{"parameters.cd", 0, 1, SliderScale::linear, ""}};
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(w, 1e-12));
    // By the drag's number: dM/dcd + dM/dw w' = 0, the slope by the eigenvalue.
    const double by_drag =
        -3 * 0.5 * rho * area * (wind * wind + w * w * radius * radius) * radius * std::cos(a);
    REQUIRE(s.sensitivities.size() == 1);
    CHECK_THAT(s.sensitivities[0].rates.at(0).value,
               WithinRel(-by_drag / (4 * (*s.eigenvalues)[0].real()), 1e-11));
  }
}

TEST_CASE("a weather vane by a polar swings by the slope of its lift", "[air]") {
  Mechanism m;
  m.air.wind = {6, 0, 0};
  m.bodies = {body("vane", 0.3, {0.2, 0, 0}, {0.002, 0.002, 0.002})};
  m.joints = {revolute("post", "ground", "vane", {0, 0, 0}, {0, 0, 1})};
  Force blade = vane("blade", "vane", {0.25, 0, 0}, 0.02, {0, 1, 0}, 0, 0);
  blade.chord = Vec3(1, 0, 0);
  m.forces = {with_polar(blade, "2*sin(2*incidence)", "0.3")};
  validate(m);
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(coordinate(s, "post").value, WithinAbs(0, 1e-14));
  CHECK(s.stable == true);
  // J x^2 + C x + K = 0: lift's slope and drag both bring it back, 4 + 0.3.
  const double b = 0.5 * rho * 0.02, j = 0.002 + 0.3 * 0.04, c = b * (4 + 0.3) * 6 * 0.25 * 0.25,
               k = b * (4 + 0.3) * 36 * 0.25;
  REQUIRE(s.eigenvalues->size() == 2);
  CHECK_THAT((*s.eigenvalues)[0].real(), WithinRel(-c / (2 * j), 1e-11));
  CHECK_THAT(std::abs((*s.eigenvalues)[0].imag()), WithinRel(std::sqrt(k / j - c * c / (4 * j * j)), 1e-11));
  // A lift at no incidence puts it where that is zero: lift cos q' = drag sin q', q' the angle to the wind.
  m.forces[0].formulas[1].text = "2*sin(2*incidence) + 0.5";
  const Solution cambered = Analysis(m).solve();
  INFO(cambered.message);
  REQUIRE(cambered.status == Status::converged);
  // At the angle q of the post the incidence is -q, and about the post lift has the arm cos a, drag sin a.
  const double q = coordinate(cambered, "post").value;
  CHECK(std::abs((2 * std::sin(-2 * q) + 0.5) * std::cos(q) - 0.3 * std::sin(q)) < 1e-13);
  CHECK(q > 0.05);
  CHECK(cambered.stable == true);
  // On a kink of its drag it says so.
  m.forces[0] = with_polar(blade, "2*sin(2*incidence)", "0.3 + 0.2*abs(incidence)");
  const Solution kink = Analysis(m).solve();
  INFO(kink.message);
  CHECK(!kink.stable);
  CHECK_THAT(kink.message, ContainsSubstring("The drag of blade stands on a kink of its law"));
}

TEST_CASE("what is wrong with a polar is said at its place", "[air]") {
  Mechanism m = turning_arm(true);
  m.forces[0].chord = Vec3(1, 0, -2);
  const auto mistake = [&](const std::string& lift, const std::string& drag) {
    Mechanism with = m;
    with.forces[0] = with_polar(with.forces[0], lift, drag);
    try {
      validate(with);
    } catch (const SceneError& error) {
      return error.where() + ": " + error.expected();
    }
    return std::string();
  };
  CHECK(mistake("sin(incidence)", "1 - cos(2*incidence)") == "");
  CHECK_THAT(
      mistake("sin(2*incidense)", "0"),
      ContainsSubstring("forces.vane.lift: \"=sin(2*incidense)\": there is no parameter \"incidense\"") &&
          ContainsSubstring("did you mean \"incidence\"?"));
  CHECK_THAT(mistake("1 m*incidence", "0"), ContainsSubstring("expected a number, found m"));
  CHECK_THAT(mistake("sin(incidence)", "sin(2*incidence)"),
             ContainsSubstring("forces.vane.drag: ") && ContainsSubstring("expected a drag of zero or more"));
  CHECK_THAT(mistake("1/incidence", "0"),
             ContainsSubstring("expected a finite coefficient at an incidence of 0 deg"));
  CHECK_THAT(mistake("table(incidence, [-10 deg, -0.9], [0, 0], [12 deg, 1.1])", "0"),
             ContainsSubstring("expected the same at incidences of -180 and 180 deg") &&
                 ContainsSubstring("it has to go all round"));
  m.forces[0].chord.reset();
  CHECK_THAT(mistake("sin(incidence)", "0"), ContainsSubstring("forces.vane.chord: missing"));
}

TEST_CASE("a polar is written as it is read, and stands for the other coefficients", "[air]") {
  const auto scene = [](const std::string& coefficients) {
    return R"({"flyball": 2, "name": "air", "parameters": {"c": {"value": 0.4}},
    "bodies": [{"name": "flag", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]}],
    "joints": [{"name": "pole", "type": "revolute", "bodies": ["ground", "flag"], "at": [0, 0, 0], "axis": [0, 1, 0]}],
    "forces": [{"name": "cloth", "type": "vane", "body": "flag", "at": [1, 0, 0], "area": 0.2, "normal": [0, 0, 1],
      "chord": [1, 0, 0], )" +
           coefficients + "}]}";
  };
  const Mechanism m = read_scene(scene(R"~("lift": "=c*sin(2*incidence)", "drag": 0.2)~"));
  REQUIRE(m.forces[0].lift);
  CHECK(m.forces[0].drag == 0.2);
  CHECK(read_scene(write_scene(m)) == m);
  CHECK_THAT(write_scene(m),
             ContainsSubstring("\"lift\": \"=c*sin(2*incidence)\"") && !ContainsSubstring("\"cn\""));
  CHECK(get_parameter(m, "forces.cloth.drag") == 0.2);
  for (const std::string other : {"cn", "cd"}) {
    try {
      read_scene(scene("\"lift\": \"=c*sin(2*incidence)\", \"" + other + "\": 1"));
      FAIL("two coefficients were taken");
    } catch (const SceneError& error) {
      CHECK(error.where() == "forces.cloth." + other);
      CHECK_THAT(error.expected(), ContainsSubstring("expected none beside `lift` and `drag`"));
    }
  }
}

TEST_CASE("what is said of the air is checked", "[air]") {
  const auto expect = [](const Mechanism& m, const std::string& where, const std::string& what) {
    try {
      validate(m);
      FAIL("nothing was said");
    } catch (const SceneError& error) {
      CHECK(error.where() == where);
      CHECK_THAT(error.expected(), ContainsSubstring(what));
    }
  };
  Mechanism m = turning_arm(true);
  m.air.turns_with = "spindel";
  expect(m, "air.turns_with", "spindle");
  m.air.turns_with = "ground";
  expect(m, "air.turns_with", "expected a body");
  m.air.turns_with = "spindle";
  m.air.wind = {1, 0, 0};
  expect(m, "air.wind", "turns at rest with it");
  m = turning_arm(true);
  m.air.density = -1;
  expect(m, "air.density", "zero or more");
  m.air.density = 1;
  m.forces[0].normal.setZero();
  expect(m, "forces.vane.normal", "not zero");
  m.forces[0].normal = {0, 2, 0};
  m.forces[0].chord = Vec3(0, -1, 0);
  expect(m, "forces.vane.chord", "not parallel");
}

TEST_CASE("air and vanes are written as they are read", "[air]") {
  const std::string text = R"({"flyball": 2, "name": "air",
    "air": {"density": 1.1, "wind": [0, "=3 m/s", 0]},
    "bodies": [{"name": "flag", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]}],
    "joints": [{"name": "pole", "type": "revolute", "bodies": ["ground", "flag"], "at": [0, 0, 0], "axis": [0, 1, 0]}],
    "forces": [{"name": "cloth", "type": "vane", "body": "flag", "at": [1, 0, 0], "area": "=4 m * 5 cm", "normal": [0, 0, 1], "chord": [1, 0, 0], "cd": 0.2}]})";
  const Mechanism m = read_scene(text);
  CHECK(m.air.density == 1.1);
  CHECK(m.air.wind == Vec3(0, 3, 0));
  CHECK_THAT(m.forces[0].area, WithinRel(0.2, 1e-15));
  CHECK(m.forces[0].cn == 1.2);
  CHECK(read_scene(write_scene(m)) == m);
}
