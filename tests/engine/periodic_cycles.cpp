// Limit cycles: motions with a period of their own.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/sampled_later.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/periodic/limit_cycle.hpp"
#include "engine/periodic/orbit_ranges.hpp"
#include "engine/periodic/periodic_state.hpp"
#include "tests/catch.hpp"

#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using std::numbers::pi;

namespace {

const PeriodicCoordinate& of(const PeriodicState& s, const std::string& joint) {
  const auto found = std::ranges::find(s.coordinates, joint, &PeriodicCoordinate::joint);
  REQUIRE(found != s.coordinates.end());
  return *found;
}

PeriodicState hunting(double damping) {
  return find_periodic_state(shipped("governor_engine", {{"joints.slide.damping", damping}}));
}

} // namespace

TEST_CASE("the search for a periodic motion tells what it does, one after the other") {
  std::vector<std::string> phases;
  PeriodicOptions options;
  options.progress = [&](const Progress& now) {
    CHECK(now.part < 0); // nobody knows how long it takes
    if (phases.empty() || phases.back() != now.phase) phases.emplace_back(now.phase);
  };
  SECTION("of a limit cycle") {
    const PeriodicState s =
        find_periodic_state(shipped("governor_engine", {{"joints.slide.damping", 15.}}), options);
    CHECK(s.status == PeriodicStatus::found);
    CHECK(phases == std::vector<std::string>{"swings about the steady state", "following a motion",
                                             "closing a period", "motions beside it",
                                             "ranges over a period"});
  }
  SECTION("of a rotor that its drive turns") {
    const PeriodicState s = find_periodic_state(shipped("horizontal_rotor"), options);
    CHECK(s.status == PeriodicStatus::found);
    CHECK(phases ==
          std::vector<std::string>{"closing a period", "motions beside it", "ranges over a period"});
  }
}

TEST_CASE("Haug's governor hunts in a limit cycle below 21.54 N s/m, as its motion does") {
  const Mechanism m = shipped("governor_engine", {{"joints.slide.damping", 15.}});
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.drive_periods == 0);
  CHECK(s.period_error < 1e-6 * s.period);
  const PeriodicCoordinate &slide = of(s, "slide"), &spin = of(s, "spin");
  CHECK(slide.range.most - slide.range.least > 1e-3);
  CHECK(spin.goes_on());
  CHECK_THAT(spin.rate.mean, WithinRel(spin.advance / s.period, 1e-9));
  // The shaft's torque is 7500 N (s - 0.15 m): on the average nothing.
  CHECK_THAT(slide.range.mean, WithinAbs(0.15, 1e-7));
  // It has lost its stability hard: the arms swing through straight.
  CHECK(of(s, "arm1").range.most > pi / 2);
  CHECK(s.stable == true);
  // A motion beside it comes to it.
  SimulationOptions options = lasting(120, Integrator::automatic, 1e-11);
  options.start = Start::state;
  options.state = s.start;
  for (StateCoordinate& c : options.state.coordinates)
    if (c.joint == "slide") c.rate += 0.05;
  const Run run = sampled_later(m, options, 115);
  const auto [least, most] = std::ranges::minmax(track(run, "slide").value);
  CHECK_THAT(least, WithinAbs(slide.range.least, 1e-5));
  CHECK_THAT(most, WithinAbs(slide.range.most, 1e-5));
}

TEST_CASE("Above the limit of hunting an unstable cycle bounds the pushes after which the governor settles") {
  // Its size grows with the square root of the distance from the limit.
  const double limit = 21.54;
  const auto size_of = [](const PeriodicState& s) {
    const PeriodicCoordinate& slide = of(s, "slide");
    return (slide.range.most - slide.range.least) / 2;
  };
  const PeriodicState a = hunting(limit + 0.15), b = hunting(limit + 0.6);
  CAPTURE(a.message, b.message);
  REQUIRE(a.status == PeriodicStatus::found);
  REQUIRE(b.status == PeriodicStatus::found);
  CHECK_THAT(std::pow(size_of(b) / size_of(a), 2), WithinRel(4., 0.1));
  CHECK(b.stable == false);
  CHECK(b.floquet.multipliers.front().real() > 1);
  // Inside it dies out, outside it grows.
  const Mechanism m = shipped("governor_engine", {{"joints.slide.damping", limit + 0.6}});
  const Solution steady = solve(m);
  for (const double part : {0.9, 1.1}) {
    SimulationOptions options = lasting(10 * b.period);
    options.start = Start::state;
    options.state = b.start;
    for (StateCoordinate& c : options.state.coordinates)
      for (const CoordinateSolution& at : steady.coordinates) {
        if (at.joint != c.joint) continue;
        if (at.speed) {
          c.rate = *at.speed + part * (c.rate - *at.speed);
        } else if (!at.driven) {
          c.value = at.value + part * (c.value - at.value);
          c.rate *= part;
        }
      }
    const Run run = simulate(m, options);
    const std::vector<double>& values = track(run, "slide").value;
    const auto one = static_cast<std::ptrdiff_t>(b.period * 100);
    const auto [least, most] = std::ranges::minmax(std::vector(values.begin(), values.begin() + one));
    const auto [later_least, later_most] = std::ranges::minmax(std::vector(values.end() - one, values.end()));
    CAPTURE(part);
    CHECK(((later_most - later_least) > (most - least)) == (part > 1));
  }
}

TEST_CASE("An eccentric wheel that a torque drives turns unevenly, with its exact period and multiplier") {
  // J a'' = T - b a' - m g e cos a, a from the horizontal.
  const double mass = 2, e = 0.1, inertia = 0.05, torque = 6, load = 0.6, g = 9.81;
  const double about = inertia + mass * e * e;
  Mechanism m;
  m.gravity = {0, -g, 0};
  m.bodies = {body("wheel", mass, {e, 0, 0}, {0.01, 0.01, inertia})};
  m.joints = {dampened(revolute("spin", "ground", "wheel", {0, 0, 0}), load)};
  m.joints[0].coordinates[0].drive = Drive{.speed = torque / load, .torque = torque};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  // By the angle: w' = (T - b w - m g e cos a) / (J w), to where it returns.
  double w = torque / load, period = 0;
  const int steps = 20000;
  const double h = 2 * pi / steps;
  for (int turns = 0; turns < 30; ++turns) {
    period = 0;
    for (int i = 0; i < steps; ++i) {
      const auto rate = [&](double a, double speed) {
        return (torque - load * speed - mass * g * e * std::cos(a)) / (about * speed);
      };
      const double a = i * h, k1 = rate(a, w), k2 = rate(a + h / 2, w + h / 2 * k1),
                   k3 = rate(a + h / 2, w + h / 2 * k2), k4 = rate(a + h, w + h * k3),
                   middle = w + h / 2 * (k1 + 2 * k2) / 3;
      const double before = w;
      w += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      period += h / 6 * (1 / before + 4 / middle + 1 / w);
    }
  }
  CHECK_THAT(s.period, WithinRel(period, 1e-6));
  CHECK_THAT(of(s, "spin").advance, WithinAbs(2 * pi, 1e-8));
  CHECK_THAT(of(s, "spin").rate.mean, WithinRel(2 * pi / period, 1e-6));
  CHECK(s.stable == true);
  REQUIRE(s.floquet.multipliers.size() == 1);
  CHECK_THAT(s.floquet.multipliers[0].real(), WithinAbs(std::exp(-load / about * period), 1e-6));
}

TEST_CASE(
    "What settles or turns evenly is told to do so, wheels that gears and belts tie together included") {
  // A fly that a weight turns, a mill, and two wheels behind a differential.
  for (const char* name : {"fan_governor", "windmill", "differential"}) {
    CAPTURE(name);
    const PeriodicState s = find_periodic_state(shipped(name));
    CHECK(s.status == PeriodicStatus::not_found);
    CHECK_THAT(s.message, ContainsSubstring("settles in a steady state, "));
    CHECK_THAT(s.message, ContainsSubstring(" rad/s"));
  }
}

TEST_CASE("Where the drawn pose leads nowhere the steady state is found, as a periodic motion") {
  PeriodicOptions options;
  options.patience = 2;
  const PeriodicState s = find_periodic_state(shipped("ball_on_string"), options);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.stability_reason == StabilityReason::neutral); // the ball turns about its string
  const Solution steady = solve(shipped("ball_on_string"));
  for (const CoordinateSolution& c : steady.coordinates)
    if (!c.driven && !c.angle) {
      const auto found = std::ranges::find_if(s.coordinates, [&](const PeriodicCoordinate& at) {
        return at.joint == c.joint && at.index == c.index;
      });
      REQUIRE(found != s.coordinates.end());
      CHECK_THAT(found->range.mean, WithinAbs(c.value, 1e-9));
    }
}

namespace {

// A block of 2 kg that slides on a spring and a damper, and on it an uneven wheel under its weight, which a
// torque drives.
Mechanism uneven_wheel_on_a_block() {
  Mechanism m;
  m.gravity = {0, -9.80665, 0};
  m.bodies = {body("block", 2, {0, 0, 0}, {0, 0, 0}), body("wheel", 1, {0.02, 0, 0}, {0.05, 0.05, 0.05})};
  m.joints = {dampened(sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), 3000), 20),
              dampened(revolute("spin", "block", "wheel", {0, 0, 0}), 0.2)};
  m.joints[1].coordinates[0].drive = Drive{.speed = 9, .torque = 2.};
  return m;
}

// The same with a wheel that turns at `speed` about an axis of the ground, its mass centre `e` beside that.
Mechanism with_rotor(Mechanism m, double speed, double e, const std::string& on = "ground") {
  m.bodies.push_back(body("rotor", 1, {e, 0, 0.5}, {0.05, 0.05, 0.05}));
  m.joints.push_back(driven(revolute("turn", on, "rotor", {0, 0, 0.5}), speed));
  return m;
}

} // namespace

TEST_CASE("An even rotor at a given speed, coupled to nothing, leaves a limit cycle as it is") {
  const PeriodicState alone = find_periodic_state(uneven_wheel_on_a_block());
  REQUIRE(alone.status == PeriodicStatus::found);
  for (const char* on : {"ground", "block"}) {
    const Mechanism m = uneven_wheel_on_a_block();
    Mechanism heavier = m;
    heavier.bodies[0].mass += std::string_view(on) == "block" ? 1 : 0; // the rotor goes along
    const PeriodicState like = find_periodic_state(heavier), s = find_periodic_state(with_rotor(m, 7, 0, on));
    CAPTURE(on, s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    CHECK(s.drive_periods == 0);
    CHECK_THAT(s.period, WithinRel(like.period, 1e-9));
    CHECK_THAT(of(s, "x").range.least, WithinRel(of(like, "x").range.least, 1e-8));
    CHECK_THAT(of(s, "x").range.most, WithinRel(of(like, "x").range.most, 1e-8));
    CHECK(s.stable == true);
  }
}

TEST_CASE("What turns by a torque beside an uneven rotor settles, and is not told to grow") {
  // Both turn on and on, each in its own time, and shake the block, which a spring holds.
  const PeriodicState s = find_periodic_state(with_rotor(uneven_wheel_on_a_block(), 18, 0.02, "block"));
  CAPTURE(s.message);
  CHECK(s.status == PeriodicStatus::not_found);
  CHECK_THAT(s.message, !ContainsSubstring("without end"));
}

TEST_CASE("A shaft that a torque cannot turn over comes to rest, and is told where") {
  // 1 kg at r beside a level axis: at rest m g r sin(angle from below) is the torque, if it comes to rest.
  const double weight = 9.80665 * 0.3;
  struct Stall {
    double torque, damping, speed;
  };
  for (const auto& [torque, damping, speed] : {Stall{0, 0.05, 1}, Stall{1, 0.05, 3}, Stall{0.5, 0.2, 3}}) {
    CAPTURE(torque, damping, speed);
    Mechanism m;
    m.gravity = {0, -9.80665, 0};
    m.bodies = {body("a", 1, {0.3, 0, 0}, {0.01, 0.01, 0.01})};
    m.joints = {dampened(revolute("p", "ground", "a", {0, 0, 0}), damping)};
    m.joints[0].coordinates[0].drive = Drive{.speed = speed, .torque = torque};
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(s.message);
    CHECK(s.status == PeriodicStatus::not_found);
    CHECK(s.evaluations < 100000);
    CHECK_THAT(s.message, ContainsSubstring("comes to rest: p at " +
                                            rounded_text(std::asin(torque / weight) - pi / 2, 6) + " rad"));
  }
}

TEST_CASE("A wheel that a gear carries round by no whole turns is no part of when a cycle returns") {
  const PeriodicState alone = find_periodic_state(uneven_wheel_on_a_block());
  REQUIRE(alone.status == PeriodicStatus::found);
  for (const double ratio : {0.5, 1.87, 2.}) {
    Mechanism m = uneven_wheel_on_a_block();
    m.bodies.push_back(body("even", 1, {1, 0, 0}, {0.05, 0.05, 0.05}));
    m.joints.push_back(dampened(revolute("behind", "ground", "even", {1, 0, 0}), 0.05));
    m.joints.push_back(gear("gear", "spin", "behind", ratio));
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(ratio, s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    CHECK_THAT(std::abs(of(s, "spin").advance), WithinRel(2 * pi, 1e-9)); // one turn, not two
    CHECK(s.stable == true);
  }
}

TEST_CASE("An even wheel that another torque turns fast has no part in when a cycle returns") {
  const PeriodicState alone = find_periodic_state(uneven_wheel_on_a_block());
  for (const double speed : {20., 40., 160.}) {
    Mechanism m = uneven_wheel_on_a_block();
    m.bodies.push_back(body("even", 1, {1, 0, 0}, {0.05, 0.05, 0.05}));
    m.joints.push_back(dampened(revolute("beside", "ground", "even", {1, 0, 0}), 0.05));
    m.joints.back().coordinates[0].drive = Drive{.speed = speed, .torque = 0.05 * speed};
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(speed, s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    CHECK_THAT(s.period, WithinRel(alone.period, 1e-8));
    CHECK_THAT(of(s, "beside").rate.mean, WithinRel(speed, 1e-8));
    CHECK(s.stable == true);
  }
}

namespace {

// Rayleigh's oscillator at 1 rad/s, a sprung slide whose damper feeds it while it is slow, beside an even
// wheel that a torque drives. By the energy of a cycle it swings by half the size to either side.
Mechanism rayleigh(double size) {
  Mechanism m;
  m.gravity.setZero();
  m.bodies = {body("wheel", 1, {0, 0, 0}, {1, 1, 1}), body("block", 1, {size, 0, 0}, {1, 1, 1})};
  m.joints = {dampened(revolute("turn", "ground", "wheel", {0, 0, 0}), 0.1),
              sprung(prismatic("slide", "ground", "block", {size, 0, 0}, {1, 0, 0}), 1, size / 2)};
  m.joints[0].coordinates[0].drive = Drive{.speed = 10, .torque = 1};
  Joint& slide = m.joints[1];
  slide.coordinates[0].damping_force = 0;
  slide.formulas = {
      {"damping_force", "-0.2 N s/m*rate + " + number_text(3.2 / 3 / (size * size)) + " N s^3/m^3*rate^3"}};
  return m;
}

} // namespace

TEST_CASE("The limit cycle of a slide is found in any size") {
  const double size = GENERATE(0.8e-6, 1., 100.);
  const PeriodicState s = find_limit_cycle(rayleigh(size));
  CAPTURE(size, s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK_THAT(s.period, WithinRel(2 * pi, 1e-2));
  const PeriodicRange& slide = of(s, "slide").range;
  CHECK_THAT(slide.most - slide.least, WithinRel(size, 0.02));
  CHECK_THAT(slide.mean, WithinRel(size / 2, 0.02));
}

TEST_CASE("A slide that goes on by little every period goes on") {
  const double size = GENERATE(1e-7, 1.);
  CAPTURE(size);
  Run run;
  CoordinateTrack track;
  track.joint = "slide";
  track.scale = size;
  track.value = {0, 1e-2 * size, 3e-2 * size, 4e-2 * size};
  track.rate = {1e-2 * size, 2e-2 * size, 2e-2 * size, 1e-2 * size};
  run.coordinates = {track};
  PeriodicState told;
  fill_ranges(run, told);
  REQUIRE(told.coordinates.size() == 1);
  CHECK(told.coordinates[0].goes_on());
}

namespace {

// The shipped differential with wheels out of balance (m, of 12 kg each).
Mechanism unbalanced_differential(double left, double right) {
  Mechanism m = shipped("differential");
  for (Body& body : m.bodies)
    if (body.name == "left" || body.name == "right") body.position.y() += body.name == "left" ? left : right;
  for (Joint& joint : m.joints)
    if (joint.name == "left" || joint.name == "right")
      joint.coordinates[0].damping = joint.name == "left" ? 5.3 : 1.7;
  return m;
}

} // namespace

TEST_CASE(
    "a differential with one wheel out of balance has a cycle at each of its turns, as its motion does") {
  const Mechanism m = unbalanced_differential(0, 0.02);
  const PeriodicState s = find_periodic_state(m);
  INFO(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.stable == true);
  const PeriodicCoordinate& right = of(s, "right");
  CHECK_THAT(right.advance, WithinAbs(2 * pi, 1e-9));
  const Run run = simulate(m, lasting(20, Integrator::automatic, 1e-11));
  for (const char* joint : {"case", "left", "right"}) {
    CAPTURE(joint);
    const std::vector<double>& rates = track(run, joint).rate;
    const auto [least, most] = std::ranges::minmax(std::vector(rates.end() - 500, rates.end()));
    CHECK_THAT(least, WithinRel(of(s, joint).rate.least, 1e-4));
    CHECK_THAT(most, WithinRel(of(s, joint).rate.most, 1e-4));
  }
}

TEST_CASE("with both wheels out of balance it is told as quasi-periodic, soon") {
  const PeriodicState s = find_periodic_state(unbalanced_differential(0.01, 0.02));
  INFO(s.message);
  CHECK(s.status != PeriodicStatus::found);
  CHECK_THAT(s.message, ContainsSubstring("is quasi-periodic unless"));
  CHECK(s.evaluations < 120'000); // 231 126 where it is followed as long as may be
}

TEST_CASE(
    "A limit cycle is found though the mechanism's solution is a steady state about which nothing swings") {
  // On a shaft that turns at 5 rad/s a bob whose damper drives it: I q'' + d(q') + m g s cos(q + p) - the
  // centrifugal moment = 0, d(v) = -mu v + 0.3 v^2 + 0.7 v^3, so that the pendulum as drawn leads to a
  // saddle. The amplitude follows a' = Re(s) a + w l1 a^3, by hand w l1 = -7.96053623329 / s at q =
  // 0.957692457804.
  Mechanism m;
  m.gravity = {0, -9.80665, 0};
  m.bodies = {body("hub", 1, {0, 0, 0}, {0, 0, 0}), body("bob", 1.3, {0.1, -0.69, 0.02}, {0.02, 0.01, 0.03})};
  m.joints = {driven(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0}), 5),
              revolute("swing", "hub", "bob", {0.05, 0, 0})};
  m.joints[1].coordinates[0].damping_force = 0;
  m.parameters = {{"mu", "", 0.001, "N m s", {}, {}}};
  m.joints[1].formulas = {{"damping_force", "-mu*rate + 0.3 N m s^2*rate^2 + 0.7 N m s^3*rate^3"}};
  const Solution saddle = solve(m);
  CHECK(saddle.stable == false);
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.drive_periods == 0);
  CHECK(s.stable == true);
  const double growth = 7.666595e-4, amplitude = std::sqrt(growth / 7.96053623329);
  const PeriodicRange& swing = of(s, "swing").range;
  CHECK_THAT((swing.most - swing.least) / 2, WithinRel(amplitude, 1e-3));
  CHECK_THAT(s.period, WithinRel(2 * pi / 4.44723671107, 1e-3));
}
