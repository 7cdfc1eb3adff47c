// Periodic steady states against exact ones.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/sampled_later.hpp"

#include "engine/periodic/periodic_state.hpp"

#include "tests/catch.hpp"

#include <complex>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using std::numbers::pi;

namespace {

const PeriodicCoordinate& coordinate(const PeriodicState& s, const std::string& joint, int index = 0) {
  const auto found = std::ranges::find_if(
      s.coordinates, [&](const PeriodicCoordinate& c) { return c.joint == joint && c.index == index; });
  REQUIRE(found != s.coordinates.end());
  return *found;
}

// A bearing block that slides in x and y on springs and dampers, and in it a disc that turns about z with its
// mass centre `e` beside the axis: Jeffcott's rotor. Weight acts along -y.
Mechanism jeffcott(double speed, double e = 1e-3, double damping = 40, double stiffness = 1e4,
                   double mass = 4) {
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("across", 0), body("block", 0), body("disc", mass, {e, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {dampened(sprung(prismatic("x", "ground", "across", {0, 0, 0}, {1, 0, 0}), stiffness), damping),
              dampened(sprung(prismatic("y", "across", "block", {0, 0, 0}, {0, 1, 0}), stiffness), damping),
              driven(revolute("spin", "block", "disc", {0, 0, 0}, {0, 0, 1}), speed)};
  return m;
}

} // namespace

TEST_CASE("Jeffcott's rotor whirls as the closed form says, below and above its critical speed") {
  const double k = 1e4, mass = 4, damping = 40, e = 1e-3;
  const double natural = std::sqrt(k / mass), zeta = damping / (2 * mass * natural);
  for (const double n : {0.3, 0.9, 1., 1.2, 3.}) {
    CAPTURE(n);
    const PeriodicState s = find_periodic_state(jeffcott(n * natural, e, damping, k, mass));
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const double r = e * n * n / std::hypot(1 - n * n, 2 * zeta * n), sag = mass * 9.81 / k;
    const PeriodicCoordinate &x = coordinate(s, "x"), &y = coordinate(s, "y");
    CHECK_THAT(s.period, WithinRel(2 * pi / (n * natural), 1e-14));
    CHECK_THAT(x.range.mean, WithinAbs(0, 1e-11));
    CHECK_THAT(y.range.mean, WithinAbs(-sag, 1e-11));
    CHECK_THAT(x.range.most, WithinAbs(r, 1e-9 * r + 1e-12));
    CHECK_THAT(x.range.least, WithinAbs(-r, 1e-9 * r + 1e-12));
    CHECK_THAT(y.range.most, WithinAbs(r - sag, 1e-9 * r + 1e-12));
    CHECK(std::abs(x.range.most - r) <= x.range.error + 1e-14 * r);
    CHECK(x.range.error < 1e-7 * r);
    CHECK(s.stable == true);
    // exp((-zeta +- i sqrt(1 - zeta^2)) natural T), twice each.
    const std::complex<double> rate(-zeta * natural, natural * std::sqrt(1 - zeta * zeta)),
        mu = std::exp(rate * s.period);
    REQUIRE(s.floquet.multipliers.size() == 4);
    for (const auto& found : s.floquet.multipliers)
      CHECK(std::min(std::abs(found - mu), std::abs(found - std::conj(mu))) <
            std::min(1e-7, 3 * s.floquet.error));
    // What the drive gives on the average is what the dampers take.
    CHECK_THAT(s.drive_torques.at(0).range.mean * n * natural,
               WithinRel(damping * std::pow(n * natural * r, 2), 1e-8));
  }
}

namespace {

// A crank of radius r about z that moves a yoke along `axis` by r cos(speed t): a pin in a block that slides
// across the yoke.
Mechanism scotch_yoke(double radius, double speed, const Vec3& along) {
  const Vec3 across = Vec3::UnitZ().cross(along), pin = radius * along;
  Mechanism m;
  m.bodies = {body("crank", 1), body("yoke", 1, pin), body("block", 0, pin)};
  m.joints = {driven(revolute("spin", "ground", "crank", {0, 0, 0}), speed),
              prismatic("stroke", "ground", "yoke", pin, along),
              prismatic("slot", "yoke", "block", pin, across), revolute("pin", "crank", "block", pin)};
  return m;
}

// A pendulum, drawn at `angle` from hanging, whose pivot goes up and down by r cos(speed t).
Mechanism shaken_pendulum(double radius, double speed, double length, double damping, double angle) {
  Mechanism m = scotch_yoke(radius, speed, Vec3::UnitY());
  m.gravity = {0, -9.81, 0};
  const Vec3 pivot(0, radius, 0);
  m.bodies.push_back(body("bob", 1, pivot + length * Vec3(std::sin(angle), -std::cos(angle), 0)));
  m.joints.push_back(dampened(revolute("swing", "yoke", "bob", pivot), damping));
  m.joints.back().coordinates[0].drawn = angle;
  return m;
}

// Multipliers of p'' + d p' + (g cos(angle) - r w^2 cos(angle) cos(w t)) / l p = 0, that pendulum about a
// straight position: by Runge and Kutta's method with many steps.
std::array<std::complex<double>, 2> mathieu_multipliers(double radius, double speed, double length,
                                                        double damping, double angle) {
  Eigen::Matrix2d x = Eigen::Matrix2d::Identity();
  const int steps = 40000;
  const double h = 2 * pi / speed / steps;
  const auto rate = [&](double t, const Eigen::Matrix2d& y) -> Eigen::Matrix2d {
    Eigen::Matrix2d a;
    const double stiffness = std::cos(angle) * (9.81 - radius * speed * speed * std::cos(speed * t)) / length;
    a << 0, 1, -stiffness, -damping / (length * length);
    return a * y;
  };
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Eigen::Matrix2d k1 = rate(t, x), k2 = rate(t + h / 2, x + h / 2 * k1),
                          k3 = rate(t + h / 2, x + h / 2 * k2), k4 = rate(t + h, x + h * k3);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const std::complex<double> half = x.trace() / 2,
                             root = std::sqrt(half * half - std::complex<double>(x.determinant()));
  return {half + root, half - root};
}

void check_multipliers(const PeriodicState& s, const std::array<std::complex<double>, 2>& exact,
                       double within) {
  REQUIRE(s.floquet.multipliers.size() == 2);
  for (const auto& mu : s.floquet.multipliers)
    CHECK(std::min(std::abs(mu - exact[0]), std::abs(mu - exact[1])) <
          within * std::max(1., std::abs(exact[0])));
}

} // namespace

TEST_CASE("An oscillator on a Scotch yoke answers as the closed form says") {
  const double r = 0.05, k = 300, mass = 3, damping = 6, natural = std::sqrt(k / mass),
               zeta = damping / (2 * mass * natural);
  for (const double n : {0.5, 1., 2.5}) {
    CAPTURE(n);
    Mechanism m = scotch_yoke(r, n * natural, Vec3::UnitX());
    m.bodies.push_back(body("load", mass, {r, 0, 0}));
    m.joints.push_back(
        dampened(sprung(prismatic("shift", "yoke", "load", {r, 0, 0}, {1, 0, 0}), k), damping));
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const double amplitude = r * n * n / std::hypot(1 - n * n, 2 * zeta * n);
    CHECK_THAT(coordinate(s, "shift").range.most, WithinRel(amplitude, 1e-9));
    CHECK_THAT(coordinate(s, "shift").range.least, WithinRel(-amplitude, 1e-9));
    CHECK_THAT(coordinate(s, "stroke").range.most - coordinate(s, "stroke").range.least,
               WithinRel(2 * r, 1e-9));
    CHECK(s.stable == true);
    REQUIRE(s.floquet.multipliers.size() == 2);
  }
}

TEST_CASE("Multipliers of a shaken pendulum are Mathieu's") {
  const double length = 0.4, damping = 0.02;
  for (const double angle : {0., pi})
    for (const double radius : {0.005, 0.04})
      for (const double speed : {7., 11., 60., 300.}) {
        CAPTURE(angle, radius, speed);
        PeriodicOptions nearest;
        nearest.nearest = true;
        const PeriodicState s =
            find_periodic_state(shaken_pendulum(radius, speed, length, damping, angle), nearest);
        CAPTURE(s.message);
        REQUIRE(s.status == PeriodicStatus::found);
        const auto exact = mathieu_multipliers(radius, speed, length, damping, angle);
        check_multipliers(s, exact, 1e-7);
        check_multipliers(s, exact, 3 * s.floquet.error + 1e-11);
        const double size = std::max(std::abs(exact[0]), std::abs(exact[1]));
        if (std::abs(size - 1) > 1e-4) CHECK(s.stable == (size < 1));
      }
}

TEST_CASE("An upright pendulum stands beyond Kapitza's limit and is found below it, too") {
  const double length = 0.4, radius = 0.01, damping = 0.01, angle = pi;
  const double limit = std::sqrt(2 * 9.81 * length) / radius; // to first order in radius / length
  // Beyond it, drawn a little aside.
  const PeriodicState above =
      find_periodic_state(shaken_pendulum(radius, 1.1 * limit, length, damping, angle - 0.05));
  REQUIRE(above.status == PeriodicStatus::found);
  CHECK(above.stable == true);
  CHECK_THAT(std::abs(coordinate(above, "swing").range.mean), WithinAbs(pi, 1e-7));
  // Below it the upright one is found, unstable, and it falls into the hanging one.
  const Mechanism slow = shaken_pendulum(radius, 0.9 * limit, length, damping, angle - 0.05);
  PeriodicOptions nearest;
  nearest.nearest = true;
  const PeriodicState below = find_periodic_state(slow, nearest);
  REQUIRE(below.status == PeriodicStatus::found);
  CHECK(below.stable == false);
  CHECK_THAT(std::abs(coordinate(below, "swing").range.mean), WithinAbs(pi, 1e-7));
  // The limit itself, where the multiplier passes 1, is the reference's.
  const auto at = [&](double part) {
    const auto mu = mathieu_multipliers(radius, part * limit, length, damping, angle);
    return std::max(std::abs(mu[0]), std::abs(mu[1]));
  };
  CHECK(at(0.9) > 1);
  CHECK(at(1.1) < 1);
}

TEST_CASE("A slow unstable motion keeps its digits in segments") {
  // Upright at 1 rad/s it grows a billion times in a turn.
  const PeriodicState s = [] {
    PeriodicOptions nearest;
    nearest.nearest = true;
    return find_periodic_state(shaken_pendulum(0.1, 1.5, 0.4, 0.02, pi), nearest);
  }();
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.segments > 1);
  CHECK(s.stable == false);
  const auto exact = mathieu_multipliers(0.1, 1.5, 0.4, 0.02, pi);
  CHECK_THAT(std::abs(s.floquet.multipliers.front()),
             WithinRel(std::max(std::abs(exact[0]), std::abs(exact[1])), 1e-6));
}

TEST_CASE("A pendulum that the drive pumps up swings with twice its period") {
  const double length = 0.4, radius = 0.03, speed = 2 * std::sqrt(9.81 / length);
  const Mechanism m = shaken_pendulum(radius, speed, length, 0.01, 0.02);
  PeriodicOptions nearest;
  nearest.nearest = true;
  const PeriodicState hanging = find_periodic_state(m, nearest);
  REQUIRE(hanging.status == PeriodicStatus::found);
  CHECK(hanging.stable == false);
  CHECK(hanging.floquet.multipliers.front().real() < -1);
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.drive_periods == 2);
  CHECK(s.stable == true);
  CHECK(coordinate(s, "swing").range.most > 0.1);
  CHECK_THAT(coordinate(s, "swing").range.most, WithinRel(-coordinate(s, "swing").range.least, 1e-6));
}

TEST_CASE("A swing that is seen to come back after four periods is told the two that it takes") {
  // Its pivot goes up and down by r sin(speed t).
  const Vec3 pin(0.1, 0, 0);
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("crank", 1, {0, 0, 0}, {0.01, 0.01, 0.01}), body("block", 0.1, pin), body("yoke", 0.5),
              body("bob", 1.3, {0, -0.4, 0}, {0.02, 0.02, 0.02})};
  m.joints = {driven(revolute("spin", "ground", "crank", {0, 0, 0}), 10),
              prismatic("up", "ground", "yoke", {0, 0, 0}, Vec3::UnitY()),
              prismatic("slot", "yoke", "block", pin, Vec3::UnitX()), revolute("pin", "crank", "block", pin),
              dampened(revolute("swing", "yoke", "bob", {0, 0, 0}), 0.15)};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.drive_periods == 2);
  CHECK_THAT(s.period, WithinRel(4 * pi / 10, 1e-12));
  CHECK(s.stable == true);
  // Worked out by shooting with an integrator of eighth order.
  CHECK_THAT(coordinate(s, "swing").range.most, WithinRel(1.42775904004, 1e-8));
}

TEST_CASE(
    "A resonance without damping has no periodic motion, and beside it one that neither grows nor dies") {
  const double natural = std::sqrt(1e4 / 4);
  const PeriodicState at = find_periodic_state(jeffcott(natural, 1e-3, 0));
  CHECK(at.status == PeriodicStatus::not_periodic);
  CHECK_THAT(at.message, ContainsSubstring("damp"));
  const PeriodicState beside = find_periodic_state(jeffcott(0.8 * natural, 1e-3, 0));
  REQUIRE(beside.status == PeriodicStatus::found);
  CHECK(beside.stable != false);
  CHECK_THAT(coordinate(beside, "x").range.most, WithinRel(1e-3 * 0.64 / 0.36, 1e-8));
}

namespace {

// A sledge of 3 kg on a smooth rail, at `tilt` to the level, and on it a disc of 1 kg that turns at `speed`,
// its mass centre `e` beside its axis, drawn at `phase` from the rail.
Mechanism sledge(double speed, double e, double phase, double tilt) {
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("sledge", 3), body("disc", 1, e * Vec3(std::cos(tilt + phase), std::sin(tilt + phase), 0),
                                      {0.01, 0.01, 0.02})};
  m.joints = {prismatic("rail", "ground", "sledge", {0, 0, 0}, {std::cos(tilt), std::sin(tilt), 0}),
              driven(revolute("spin", "sledge", "disc", {0, 0, 0}, {0, 0, 1}), speed)};
  return m;
}

} // namespace

TEST_CASE("A free sledge goes to and fro by the unbalance of its disc, at any place of the rail") {
  const double e = 0.02;
  for (const double speed : {5., 30., 200.})
    for (const double phase : {0., 0.7, 2.}) {
      CAPTURE(speed, phase);
      const PeriodicState s = find_periodic_state(sledge(speed, e, phase, 0));
      CAPTURE(s.message);
      REQUIRE(s.status == PeriodicStatus::found);
      // 4 x'' = 1 e w^2 cos(w t + phase), and no push on the average.
      const PeriodicRange& x = coordinate(s, "rail").range;
      CHECK_THAT(x.most - x.least, WithinRel(2 * e / 4, 1e-9));
      CHECK_THAT(s.message, ContainsSubstring("others lie beside it"));
      CHECK(s.stability_reason == StabilityReason::neutral);
      CHECK(!s.stable);
    }
}

TEST_CASE("A sledge down a smooth slope has no periodic motion, for its weight pulls on and on") {
  for (const double phase : {0., 0.7}) {
    const PeriodicState s = find_periodic_state(sledge(30, 0.02, phase, 0.1));
    CHECK(s.status == PeriodicStatus::not_periodic);
    CHECK_THAT(s.message, ContainsSubstring("pulls on and on along rail"));
  }
  // And a push in step with what swings does not.
  const PeriodicState pumped = find_periodic_state(jeffcott(std::sqrt(1e4 / 4), 1e-3, 0));
  CHECK(pumped.status == PeriodicStatus::not_periodic);
  CHECK_THAT(pumped.message, ContainsSubstring("push in step"));
}

TEST_CASE("Growth within the error of the multipliers is not told") {
  const double k = 300, mass = 3, speed = 2.5 * std::sqrt(k / mass), period = 2 * pi / speed;
  const auto with_damping = [&](double part) { // of the motion that is lost in a period
    Mechanism m = scotch_yoke(0.05, speed, Vec3::UnitX());
    m.bodies.push_back(body("load", mass, {0.05, 0, 0}));
    m.joints.push_back(dampened(sprung(prismatic("shift", "yoke", "load", {0.05, 0, 0}, {1, 0, 0}), k),
                                part * 2 * mass / period));
    return find_periodic_state(m);
  };
  for (const double part : {1e-10, -1e-10}) {
    CAPTURE(part);
    const PeriodicState s = with_damping(part);
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    CHECK(!s.stable);
    CHECK_THAT(s.message, ContainsSubstring("too close to tell"));
  }
  CHECK(with_damping(0).stable == true); // as Krein says
  CHECK(with_damping(1e-6).stable == true);
  CHECK(with_damping(-1e-6).stable == false);
}

TEST_CASE("What turns evenly in a Scotch yoke is known to stay beside its even turn but for rounding") {
  const double r = 0.15, speed = 10;
  Mechanism m;
  m.bodies = {body("crank", 1, {0, 0, 0}, {0.01, 0.01, 0.01}), body("block", 1, {r, 0, 0}),
              body("yoke", 1, {r, 0, 0})};
  m.joints = {driven(revolute("crankshaft", "ground", "crank", {0, 0, 0}), speed),
              revolute("pin", "crank", "block", {r, 0, 0}),
              prismatic("slot", "block", "yoke", {r, 0, 0}, {0, 1, 0}),
              prismatic("slide", "ground", "yoke", {r, 0.3, 0}, {1, 0, 0})};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  const PeriodicCoordinate& pin = coordinate(s, "pin");
  CHECK_THAT(pin.advance, WithinAbs(-2 * pi, 1e-11));
  CHECK(pin.range.error < 1e-9);
  for (const double exact_zero : {pin.range.mean, pin.range.least, pin.range.most})
    CHECK(std::abs(exact_zero) <= pin.range.error);
  CHECK_THAT(coordinate(s, "slide").range.least, WithinAbs(-2 * r, 1e-9));
}

TEST_CASE("A Hooke joint turns its shaft unevenly by the closed form") {
  const double angle = 0.5, inertia = 0.3, speed = 20;
  const Vec3 out(std::cos(angle), std::sin(angle), 0);
  Mechanism m;
  m.bodies = {body("drive", 1, {-0.2, 0, 0}, {0.01, 0.01, 0.01}),
              body("load", 1, 0.2 * out, {inertia, inertia, inertia})};
  Joint hooke = joint(JointType::universal, "hooke", "drive", "load", {0, 0, 0});
  hooke.axis = Vec3::UnitZ();
  hooke.axis2 = Vec3(-std::sin(angle), std::cos(angle), 0);
  m.joints = {driven(revolute("in", "ground", "drive", {-0.2, 0, 0}, Vec3::UnitX()), speed), hooke,
              revolute("out", "ground", "load", 0.2 * out, out)};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  const PeriodicCoordinate& turned = coordinate(s, "out");
  CHECK_THAT(std::abs(turned.advance), WithinAbs(2 * pi, 1e-11));
  const double swing = std::atan((1 - std::cos(angle)) / (2 * std::sqrt(std::cos(angle))));
  CHECK_THAT(turned.range.most - turned.range.least, WithinAbs(2 * swing, 1e-9));
  // Output angle b with tan b = tan a / cos(angle): the drive gives inertia b'' b' / speed.
  double most = 0;
  const double c = std::cos(angle);
  for (int i = 0; i < 100000; ++i) {
    const double a = 2 * pi * i / 100000, below = 1 - std::pow(std::sin(angle) * std::cos(a), 2),
                 ratio = c / below,
                 bent = -c * std::pow(std::sin(angle), 2) * std::sin(2 * a) / (below * below);
    most = std::max(most, inertia * ratio * bent * speed * speed);
  }
  CHECK_THAT(s.drive_torques.at(0).range.most, WithinRel(most, 1e-7));
  CHECK_THAT(s.drive_torques.at(0).range.mean, WithinAbs(0, 1e-9 * most));
}

TEST_CASE("Where the drives have no period, or friction sticks, it is refused with the reason") {
  Mechanism two = jeffcott(30);
  two.bodies.push_back(body("other", 1, {0.01, 0, 0}));
  two.joints.push_back(driven(revolute("second", "block", "other", {0, 0, 0}), 30 * std::sqrt(2.)));
  const PeriodicState never = find_periodic_state(two);
  CHECK(never.status == PeriodicStatus::not_periodic);
  CHECK_THAT(never.message, ContainsSubstring("quasi-periodic"));
  two.joints.back().coordinates[0].drive->speed = 30.01; // 3000 turns
  CHECK_THAT(find_periodic_state(two).message, ContainsSubstring("or comes back after more turns"));
  two.joints.back().coordinates[0].drive->speed = 20;
  const PeriodicState together = find_periodic_state(two);
  REQUIRE(together.status == PeriodicStatus::found);
  CHECK_THAT(together.period, WithinRel(2 * pi / 10, 1e-12));
  Mechanism still = jeffcott(30);
  still.joints[2].coordinates[0].drive->speed = 0;
  const PeriodicState none = find_periodic_state(still);
  CHECK(none.status == PeriodicStatus::not_periodic);
  CHECK_THAT(none.message, ContainsSubstring("Nothing is driven at a speed or by a torque"));
  Mechanism rubbing = jeffcott(30);
  rubbing.joints[0].coordinates[0].friction = Friction{.limit = 2};
  const PeriodicState stuck = find_periodic_state(rubbing);
  CHECK(stuck.status == PeriodicStatus::not_periodic);
  CHECK_THAT(stuck.message, ContainsSubstring("dry friction sticks and slips"));
}

TEST_CASE("A massless node between springs and a damper takes part as the closed form says") {
  // A load on a spring with a damper beside it, in series with another spring, on a Scotch yoke.
  const double r = 0.05, mass = 3, k = 400, c = 15, other = 900, speed = 12;
  Mechanism m = scotch_yoke(r, speed, Vec3::UnitX());
  m.bodies.push_back(body("node", 0, {r, 0, 0}));
  m.bodies.push_back(body("load", mass, {r, 0, 0}));
  m.joints.push_back(sprung(prismatic("near", "yoke", "node", {r, 0, 0}, {1, 0, 0}), other));
  m.joints.push_back(dampened(sprung(prismatic("far", "node", "load", {r, 0, 0}, {1, 0, 0}), k), c));
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  using Complex = std::complex<double>;
  const Complex soft(k, speed * c), both = 1. / (1. / other + 1. / soft),
                                    shift = mass * r * speed * speed / (both - mass * speed * speed);
  CHECK_THAT(coordinate(s, "near").range.most, WithinRel(std::abs(both * shift / other), 1e-8));
  CHECK_THAT(coordinate(s, "far").range.most, WithinRel(std::abs(both * shift / soft), 1e-8));
  CHECK(s.stable == true);
}

TEST_CASE("What a torque turns beside need not return with the drives") {
  // A balanced fan at 20 rad/s in the housing of a rotor at 30: its angle changes nothing.
  Mechanism m = jeffcott(30);
  m.bodies.push_back(body("fan", 0.5, {0, 0, 0}, {0.01, 0.01, 0.01}));
  m.joints.push_back(dampened(revolute("blow", "block", "fan", {0, 0, 0}), 0.1));
  m.joints.back().coordinates[0].drive = Drive{.speed = 15, .torque = 2.};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK_THAT(s.period, WithinRel(2 * pi / 30, 1e-12));
  CHECK_THAT(coordinate(s, "blow").rate.mean, WithinRel(20., 1e-9));
  CHECK_THAT(coordinate(s, "blow").advance, WithinRel(20 * s.period, 1e-9));
  CHECK(s.stable == true);
  CHECK(s.floquet.multipliers.size() == 5); // both ways and the fan's speed
}

TEST_CASE("A load that strikes a stop moves as it does in the end") {
  Mechanism m = scotch_yoke(0.05, 9, Vec3::UnitX());
  m.bodies.push_back(body("load", 3, {0.05, 0, 0}));
  Joint shift = dampened(sprung(prismatic("shift", "yoke", "load", {0.05, 0, 0}, {1, 0, 0}), 300), 6);
  shift.coordinates[0].stop = Stop{.lower = {}, .upper = 0.03, .stiffness = 2e4};
  m.joints.push_back(shift);
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  REQUIRE(s.stable == true);
  CHECK(coordinate(s, "shift").range.most > 0.03);
  SimulationOptions options = lasting(60 * s.period, Integrator::automatic, 1e-11);
  options.rate = 400 / s.period;
  const Run run = sampled_later(m, options, 59 * s.period);
  const auto [least, most] = std::ranges::minmax(track(run, "shift").value);
  CHECK_THAT(coordinate(s, "shift").range.least, WithinAbs(least, 1e-6));
  CHECK_THAT(coordinate(s, "shift").range.most, WithinAbs(most, 1e-6));
}

TEST_CASE("A steady state is periodic, too, with the multipliers that its eigenvalues make") {
  for (const char* name : {"governor", "watt_governor", "governor_parametric", "governor_bearing",
                           "governor_porter", "pendulum", "fourbar_turntable"}) {
    CAPTURE(name);
    const Mechanism m = shipped(name);
    const Solution steady = solve(m);
    PeriodicOptions nearest;
    nearest.nearest = true;
    const PeriodicState s = find_periodic_state(m, nearest);
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    REQUIRE(steady.eigenvalues);
    for (const CoordinateSolution& c : steady.coordinates) {
      if (c.driven) continue;
      const PeriodicCoordinate& at = coordinate(s, c.joint, c.index);
      CHECK_THAT(at.range.mean, WithinAbs(c.value, 1e-9));
      CHECK_THAT(at.range.most - at.range.least, WithinAbs(0, 1e-9));
    }
    for (const std::complex<double> rate : *steady.eigenvalues) {
      const std::complex<double> mu = std::exp(rate * s.period);
      double nearest_mu = 1;
      for (const auto& found : s.floquet.multipliers)
        nearest_mu = std::min(nearest_mu, std::abs(found - mu));
      CHECK(nearest_mu < std::min(1e-7, 10 * s.floquet.error));
    }
    CHECK(s.stable == true);
  }
}

namespace {

// A disc of mass m on springs k1 and k2 with dampers c, all in a frame that turns at w about z; its mass
// centre e beside the axis along the first of them. Weight acts along -y of the world.
struct TurningSprings {
  double k1 = 8000, k2 = 5000, c = 6, m = 2, e = 1e-3, w = 60, g = 9.80665;

  Mechanism mechanism() const {
    Mechanism out;
    out.gravity = {0, -g, 0};
    out.bodies = {body("frame", 0), body("between", 0), body("disc", m, {e, 0, 0}, {0.01, 0.01, 0.02})};
    out.joints = {driven(revolute("spin", "ground", "frame", {0, 0, 0}, {0, 0, 1}), w),
                  dampened(sprung(prismatic("x", "frame", "between", {0, 0, 0}, {1, 0, 0}), k1), c),
                  dampened(sprung(prismatic("y", "between", "disc", {0, 0, 0}, {0, 1, 0}), k2), c)};
    return out;
  }
  double mean() const { return m * w * w * e / (k1 - m * w * w); } // of x; of y none
  // m (x'' - 2 w y' - w^2 x) + c x' + k1 x = -m g sin w t, and y with -m g cos w t.
  Eigen::Vector2cd amplitudes() const {
    const std::complex<double> i(0, 1);
    Eigen::Matrix2cd a;
    a << k1 - 2 * m * w * w + c * i * w, -2 * m * w * i * w, 2 * m * w * i * w,
        k2 - 2 * m * w * w + c * i * w;
    return a.partialPivLu().solve(Eigen::Vector2cd(i * m * g, -m * g));
  }
};

} // namespace

TEST_CASE("A linear motion is found by one matrix, and its multipliers by differences over two steps") {
  const PeriodicState s = find_periodic_state(shipped("horizontal_rotor"));
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.evaluations < 33'000); // 38 219 where each step has a matrix, and a third difference follows
}

TEST_CASE("A linear motion many times as large as the mechanism is found in few steps") {
  for (const double e : {0., 1e-5, 1e-3})
    for (const double w : {52., 60., 70.}) {
      CAPTURE(e, w);
      const TurningSprings rotor{.e = e, .w = w};
      const PeriodicState s = find_periodic_state(rotor.mechanism());
      CAPTURE(s.message);
      REQUIRE(s.status == PeriodicStatus::found);
      CHECK(s.iterations <= 4);
      const Eigen::Vector2cd size = rotor.amplitudes();
      const PeriodicRange &x = coordinate(s, "x").range, &y = coordinate(s, "y").range;
      CHECK_THAT(x.most, WithinRel(rotor.mean() + std::abs(size[0]), 1e-8));
      CHECK_THAT(x.least, WithinRel(rotor.mean() - std::abs(size[0]), 1e-8));
      CHECK_THAT(y.most, WithinRel(std::abs(size[1]), 1e-8));
    }
}

TEST_CASE("Errors know what is nearly in step with the drives") {
  // At the speed at which weight shakes it most: what is off by little dies out in many thousand turns.
  for (const double c : {3e-5, 1e-4, 1e-3}) {
    CAPTURE(c);
    const TurningSprings rotor{.c = c, .e = 0, .w = std::sqrt(8000. * 5000 / (2 * 2 * 13000)), .g = 1e-4};
    const PeriodicState s = find_periodic_state(rotor.mechanism());
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const Eigen::Vector2cd size = rotor.amplitudes();
    const PeriodicRange &x = coordinate(s, "x").range, &y = coordinate(s, "y").range;
    CHECK(std::abs(x.most - std::abs(size[0])) <= x.error);
    CHECK(std::abs(y.most - std::abs(size[1])) <= y.error);
    CHECK(y.error < 1e-5 * y.most);
  }
}

TEST_CASE("The highest of many peaks is told, whichever the samples hit best") {
  // Two unbalances, and what a block of 5 kg in all on a spring answers to both.
  const double k = 2000, c = 5, mass = 5;
  const auto check = [&](double w1, double w2) {
    CAPTURE(w1, w2);
    Mechanism m;
    m.bodies = {body("block", 3), body("near", 1, {0.02, 0, 0}, {0.01, 0.01, 0.01}),
                body("far", 1, {0.03, 0, 0.2}, {0.01, 0.01, 0.01})};
    m.joints = {dampened(sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), k), c),
                driven(revolute("p", "block", "near", {0, 0, 0}, {0, 0, 1}), w1),
                driven(revolute("q", "block", "far", {0, 0, 0.2}, {0, 0, 1}), w2)};
    PeriodicOptions patient;
    patient.patience = 10;
    const PeriodicState s = find_periodic_state(m, patient);
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const auto answer = [&](double e, double w) {
      return e * w * w / std::complex<double>(k - mass * w * w, c * w);
    };
    const std::complex<double> a = answer(0.02, w1), b = answer(0.03, w2);
    const auto x = [&](double t) { return (a * std::polar(1., w1 * t) + b * std::polar(1., w2 * t)).real(); };
    double least = 0, most = 0;
    const int count = 2000000;
    for (int i = 0; i < count; ++i) {
      const double value = x(s.period * i / count);
      least = std::min(least, value);
      most = std::max(most, value);
    }
    const PeriodicRange& range = coordinate(s, "x").range;
    CHECK_THAT(range.most, WithinAbs(most, 3e-8 * most + range.error));
    CHECK_THAT(range.least, WithinAbs(least, 3e-8 * most + range.error));
    CHECK(range.error < 1e-8 * most);
  };
  check(10, 10.1);
  check(1, 20);
}

TEST_CASE("A measure that stays where it is has a range") {
  // The radius of a whirl, by the closed form.
  const double k = 1e4, mass = 4, damping = 40, e = 1e-3;
  for (double speed = 10; speed < 150; speed += 20) {
    CAPTURE(speed);
    Mechanism m = jeffcott(speed);
    m.measures = {{"radius", "", "sqrt(coordinate(x)^2 + (coordinate(y) + 4 * 9.81 / 1e4)^2)", "m"}};
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const double radius = mass * e * speed * speed / std::hypot(k - mass * speed * speed, damping * speed);
    const PeriodicRange& range = s.measures.at(0).range;
    CHECK(range.error < 1e-8 * radius);
    for (const double value : {range.mean, range.least, range.most})
      CHECK_THAT(value, WithinAbs(radius, range.error));
  }
}

TEST_CASE("A balanced rotor at another speed has no part in the period") {
  for (const double speed : {7.3, 10.001, 31.4159}) {
    CAPTURE(speed);
    Mechanism m = jeffcott(10);
    m.bodies.push_back(body("even", 1, {0, 0, 0.5}, {0.05, 0.05, 0.05}));
    m.joints.push_back(driven(revolute("beside", "ground", "even", {0, 0, 0.5}), speed));
    m.points = {{"mark", {0.2, 0.2, 0.5}, {}}};
    m.measures = {{"at", "", "x(even@mark)", "m"}, {"shake", "", "x(block)", "m"}};
    const PeriodicState s = find_periodic_state(m), alone = find_periodic_state(jeffcott(10));
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    CHECK_THAT(s.period, WithinRel(2 * pi / 10, 1e-12));
    CHECK_THAT(coordinate(s, "x").range.most, WithinRel(coordinate(alone, "x").range.most, 1e-9));
    REQUIRE(s.measures.size() == 2);
    CHECK(std::isnan(s.measures[0].range.most)); // it comes back some other time
    CHECK_THAT(s.measures[1].range.most, WithinRel(coordinate(alone, "x").range.most, 1e-9));
    // Not so where it is uneven, and shakes the other one's block.
    m.bodies.back() = body("even", 1, {0.02, 0, 0.5}, {0.05, 0.05, 0.05});
    m.joints.back() = driven(revolute("beside", "block", "even", {0, 0, 0.5}), speed);
    const PeriodicState both = find_periodic_state(m);
    CHECK((both.status != PeriodicStatus::found || both.period > 60));
  }
}

TEST_CASE("a period is common to all drives whose torque depends on where they stand", "[periodic]") {
  // Two arms that weigh, and what swings beside them without feeling the slower one.
  const double weight = 2 * 9.81 * 0.1; // N m
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("a", 2, {0.1, 0, 0}, {0.01, 0.01, 0.01}), body("b", 2, {1.1, 0, 0}, {0.01, 0.01, 0.01})};
  m.joints = {driven(revolute("slow", "ground", "a", {0, 0, 0}, {0, 0, 1}), 5),
              driven(revolute("fast", "ground", "b", {1, 0, 0}, {0, 0, 1}), 10)};
  SECTION("nothing is free") {}
  SECTION("a rotor in springs has a part in the period of the fast one alone") {
    m.bodies.push_back(body("block", 3, {2, 0, 0}, {0.01, 0.01, 0.01}));
    m.bodies.push_back(body("disc", 1, {2.01, 0, 0}, {0.01, 0.01, 0.02}));
    m.joints.push_back(dampened(sprung(prismatic("x", "ground", "block", {2, 0, 0}, {1, 0, 0}), 1e3), 40));
    m.joints.push_back(driven(revolute("spin", "block", "disc", {2, 0, 0}, {0, 0, 1}), 10));
  }
  const PeriodicState s = find_periodic_state(m, {});
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK_THAT(s.period, WithinRel(2 * pi / 5, 1e-12));
  for (std::size_t i : {0U, 1U}) {
    const PeriodicRange& range = s.drive_torques[i].range;
    CHECK_THAT(range.mean, WithinAbs(0, 1e-9));
    CHECK_THAT(range.least, WithinAbs(-weight, 1e-9));
    CHECK_THAT(range.most, WithinAbs(weight, 1e-9));
  }
}

TEST_CASE("A disc that turns fast about its diameter on a table moves, though what is free hardly does") {
  Mechanism m;
  m.bodies = {body("table", 1, {0, 0, 0}, {1e-3, 1e-3, 1e-3}),
              body("frame", 0.2, {0, 0, 0}, {1e-3, 1e-3, 1e-3}),
              body("disc", 6, {0, 0, 0}, {0.03, 0.015, 0.015})};
  m.joints = {driven(revolute("turn", "ground", "table", {0, 0, 0}, {0, 1, 0}), 0.5),
              sprung(revolute("out", "table", "frame", {0, 0, 0}, {0, 0, 1}), 20),
              driven(revolute("spin", "frame", "disc", {0, 0, 0}, {0, 0, 1}), 628)};
  const PeriodicState s = find_periodic_state(m);
  REQUIRE(s.status == PeriodicStatus::found);
  CAPTURE(s.message);
  const PeriodicRange& out = coordinate(s, "out").range;
  CHECK(out.most - out.least < 1e-6);
  // The table's drive carries (I_xx - I_yy) times both speeds, at twice the disc's.
  for (const PeriodicTorque& drive : s.drive_torques)
    if (drive.joint == "turn") CHECK_THAT(drive.range.most, WithinRel(0.015 * 0.5 * 628, 1e-3));
  CHECK_THAT(s.message, ContainsSubstring("It moves periodically"));
}
