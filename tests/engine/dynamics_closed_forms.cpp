// Motions that have a formula.
#include "tests/engine/dynamics_runs.hpp"

#include <complex>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double pi = std::numbers::pi;

// A point mass on a massless rod about a fixed axis, hanging; the label is the angle from hanging.
Mechanism simple_pendulum(double length, double angle) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("bob", 2, {length * std::sin(angle), -length * std::cos(angle), 0})};
  m.joints = {revolute("swing", "ground", "bob", {0, 0, 0}, {0, 0, 1})};
  m.joints[0].coordinates[0].drawn = angle;
  return m;
}

Mechanism oscillator(double mass, double stiffness, double damping, double free) {
  Mechanism m;
  m.bodies = {body("block", mass, {0, 0, 0})};
  m.joints = {
      dampened(sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), stiffness, free), damping)};
  return m;
}

// Quarter period of the pendulum by the arithmetic-geometric mean: T = 2 pi / (w agm(1, cos(angle / 2))).
double pendulum_period(double length, double angle) {
  double a = 1, b = std::cos(angle / 2);
  for (int i = 0; i < 10; ++i)
    std::tie(a, b) = std::pair((a + b) / 2, std::sqrt(a * b));
  return 2 * pi * std::sqrt(length / standard_gravity) / a;
}

// A sledge of 3 kg on a smooth rail, and on it a disc of 1 kg with its mass centre e beside its axis.
Mechanism free_sledge(double speed, double e) {
  Mechanism m;
  m.bodies = {body("sledge", 3), body("disc", 1, {e, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {prismatic("rail", "ground", "sledge", {0, 0, 0}, {1, 0, 0}),
              driven(revolute("spin", "sledge", "disc", {0, 0, 0}, {0, 0, 1}), speed)};
  return m;
}

} // namespace

TEST_CASE("what the time alone pushes moves within the tolerance, by any integrator and in long steps") {
  const double speed = 5, e = 0.02;
  for (const Integrator method : {Integrator::runge_kutta, Integrator::adams, Integrator::bdf})
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
      SimulationOptions options = lasting(20, method, tolerance);
      options.rate = 0.05; // few samples to land on
      const Run run = simulate(free_sledge(speed, e), options);
      CAPTURE(run.message, tolerance, static_cast<int>(method));
      REQUIRE(run.time.size() == 2);
      // 4 x'' = 1 e w^2 cos w t, from rest
      const double wanted = e / 4 * (1 - std::cos(speed * 20));
      CHECK(std::abs(track(run, "rail").value.back() - wanted) < 1e4 * tolerance * e + 1e-13);
    }
}

TEST_CASE("a pendulum's period, at small and at large swings") {
  for (const double angle : {0.01, 1., 2.5, 3.1})
    for (const Integrator method : all_integrators) {
      CAPTURE(angle, word(method));
      const double period = pendulum_period(0.7, angle);
      SimulationOptions o = lasting(3 * period, method, 1e-12);
      o.rate = 2 / period; // at the turning points alone
      const Run run = simulate(simple_pendulum(0.7, angle), o);
      check_sound(run, method == Integrator::runge_kutta ? 1e-10 : 1e-7);
      const std::vector<double>& x = track(run, "swing").value;
      REQUIRE(x.size() == 7);
      for (std::size_t i = 0; i < x.size(); ++i)
        CHECK(std::abs(x[i] - (i % 2 == 0 ? angle : -angle)) < 1e-7);
    }
}

TEST_CASE("a damped oscillator below, at and above critical damping") {
  const double mass = 0.5, stiffness = 200, free = 0.3;
  for (const double damping : {0., 2., 20., 300.})
    for (const Integrator method : all_integrators) {
      CAPTURE(damping, word(method));
      const Run run = simulate(oscillator(mass, stiffness, damping, free), lasting(2, method, 1e-11));
      check_sound(run);
      const std::complex<double> root =
          std::sqrt(std::complex<double>(damping * damping / (4 * mass * mass) - stiffness / mass));
      const double decay = damping / (2 * mass);
      const std::vector<double>& x = track(run, "x").value;
      double worst = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double t = run.time[i];
        const std::complex<double> z = root * t;
        const std::complex<double> shape = std::abs(root) < 1e-6 ? std::complex<double>(1 + decay * t)
                                                                 : std::cosh(z) + decay * std::sinh(z) / root;
        worst = std::max(worst, std::abs(x[i] - free * (1 - (std::exp(-decay * t) * shape).real())));
      }
      CHECK(worst < 1e-8);
      // What the spring held is in the damper and the motion.
      CHECK(std::abs(run.energy.kinetic.back() + run.energy.potential.back() + run.energy.dissipated.back() -
                     stiffness * free * free / 2) < 1e-6);
    }
}

TEST_CASE("driven coordinates go as they are told, to the last digit") {
  for (const std::string& name : shipped_names) {
    CAPTURE(name);
    const Run run = simulate(shipped(name), lasting(0.5));
    for (const CoordinateTrack& t : run.coordinates) {
      if (!t.driven) continue;
      for (std::size_t i = 0; i < run.time.size(); ++i) {
        CHECK(t.value[i] == t.value[0] + t.rate[0] * run.time[i]);
        CHECK(t.rate[i] == t.rate[0]);
      }
    }
  }
}

TEST_CASE("a ring in the plane flies off straight from a turntable") {
  // Nothing acts but the turntable's constraint; along the radius r'' = w^2 r.
  Mechanism m;
  m.bodies = {spindle(), body("ring", 0.3, {0.2, 0, 0})};
  m.joints = {spin(3), prismatic("r", "spindle", "ring", {0.2, 0, 0}, {1, 0, 0})};
  m.joints[1].coordinates[0].drawn = 0.2;
  const Run run = simulate(m, lasting(2, Integrator::runge_kutta, 1e-12));
  check_sound(run, 1e-10);
  const std::vector<double>& r = track(run, "r").value;
  for (std::size_t i = 0; i < r.size(); ++i)
    CHECK(std::abs(r[i] / (0.2 * std::cosh(3 * run.time[i])) - 1) < 1e-9);
  // The drive gives the angular momentum: d/dt (m r^2 w) = 2 m r r' w.
  const double t = run.time.back();
  const double torque = 2 * 0.3 * 0.2 * std::cosh(3 * t) * 0.2 * 3 * std::sinh(3 * t) * 3;
  CHECK(std::abs(run.drives.at(0).torque.back() / torque - 1) < 1e-8);
}

namespace {

// A symmetric body that turns freely about its centre, its axis y.
Mechanism free_top(double axial, double across) {
  Mechanism m;
  m.bodies = {body("top", 1, {0, 0, 0}, {across, axial, across})};
  m.joints = {joint(JointType::spherical, "ball", "ground", "top", {0, 0, 0})};
  return m;
}

Quat rotation_of(const Run& run, double t) {
  return poses_at(run, t).at(0).rotation;
}

} // namespace

TEST_CASE("a free symmetric top precesses about its angular momentum") {
  const double axial = 0.3, across = 0.1, spin_rate = 5, tilt_rate = 2;
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    SimulationOptions o = lasting(3, method, 1e-12);
    o.kick = {{"ball.0", tilt_rate}, {"ball.1", spin_rate}};
    const Run run = simulate(free_top(axial, across), o);
    check_sound(run);
    // The axis turns about L at |L| / I_across; the body turns about its axis at (1 - I_axial/I_across)
    // w_axial.
    const Vec3 momentum{across * tilt_rate, axial * spin_rate, 0};
    for (const double t : {0.5, 1.7, 3.}) {
      const Quat round(Eigen::AngleAxisd(momentum.norm() / across * t, momentum.normalized()));
      const Quat own(Eigen::AngleAxisd((1 - axial / across) * spin_rate * t, Vec3::UnitY()));
      CHECK(rotation_of(run, t).angularDistance(round * own) < 2e-6);
    }
    const double end = run.time.back();
    const Quat round(Eigen::AngleAxisd(momentum.norm() / across * end, momentum.normalized()));
    const Quat own(Eigen::AngleAxisd((1 - axial / across) * spin_rate * end, Vec3::UnitY()));
    CHECK(rotation_of(run, end).angularDistance(round * own) < 1e-8);
  }
}

TEST_CASE("a rate gyro nutates at its own frequency about its steady tilt") {
  // Rotor about x in a gimbal about z on a turntable about y: small motions of the gimbal at
  // sqrt((k + C w_s W + ...) / I), from the eigenvalues, which system tests hold to formulas.
  const Mechanism m = shipped("rate_gyro");
  const Solution steady = solve(m);
  REQUIRE(steady.eigenvalues.has_value());
  std::complex<double> nutation = 0;
  for (const std::complex<double> x : *steady.eigenvalues)
    if (x.imag() > nutation.imag()) nutation = x;
  const std::string joint = [&] {
    for (const CoordinateSolution& c : steady.coordinates)
      if (!c.driven) return c.joint;
    return std::string();
  }();
  const double place = value(steady, joint), rate = 1e-5 * nutation.imag();
  SimulationOptions o =
      kicked(lasting(2 * pi / nutation.imag(), Integrator::runge_kutta, 1e-13), joint, rate);
  o.start = Start::equilibrium;
  o.rate = 50 / o.duration;
  const Run run = simulate(m, o);
  check_sound(run);
  double worst = 0;
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    const double t = run.time[i];
    const double linear =
        rate / nutation.imag() * std::exp(nutation.real() * t) * std::sin(nutation.imag() * t);
    worst = std::max(worst, std::abs(track(run, joint).value[i] - place - linear));
  }
  CHECK(worst < 1e-9); // of second order in the swing of 1e-5
}

TEST_CASE("a weight on a stop bounces with all its energy") {
  // Free fall from h, half an oscillation in the stop about its own sag.
  const double mass = 0.8, height = 0.2, stiffness = 5000, g = standard_gravity;
  Mechanism m;
  m.gravity = {0, -g, 0};
  m.bodies = {body("weight", mass, {0, height, 0})};
  m.joints = {prismatic("y", "ground", "weight", {0, height, 0}, {0, 1, 0})};
  m.joints[0].coordinates[0].drawn = height;
  m.joints[0].coordinates[0].stop = Stop{0., {}, stiffness};
  const double fall = std::sqrt(2 * height / g), speed = g * fall, w = std::sqrt(stiffness / mass),
               sag = g / (w * w);
  const double contact = 2 * (pi - std::atan2(speed / w, sag)) / w;
  const double period = 2 * fall + contact;
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    SimulationOptions o = lasting(5 * period, method, 1e-12);
    o.rate = 40 / period;
    const Run run = simulate(m, o);
    check_sound(run, 1e-8);
    REQUIRE(run.stops.size() == 10);
    for (std::size_t i = 0; i < 10; ++i) {
      CHECK(run.stops[i].joint == "y");
      CHECK_FALSE(run.stops[i].upper);
      CHECK(run.stops[i].touching == (i % 2 == 0));
      const double expected = static_cast<double>(i / 2) * period + fall + (i % 2 == 0 ? 0 : contact);
      CHECK(std::abs(run.stops[i].time - expected) < 1e-7);
    }
    const std::vector<double>& y = track(run, "y").value;
    CHECK(std::abs(y.back() - height) < 1e-7);
    CHECK(std::abs(*std::ranges::min_element(y) - (-sag - std::sqrt(sag * sag + speed * speed / (w * w)))) <
          1e-4);
  }
}

TEST_CASE("a weight drawn right on its stop sinks in and swings") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("weight", 0.8, {0, 0, 0})};
  m.joints = {prismatic("y", "ground", "weight", {0, 0, 0}, {0, 1, 0})};
  m.joints[0].coordinates[0].stop = Stop{0., {}, 5000};
  const double w = std::sqrt(5000 / 0.8), sag = standard_gravity / (w * w);
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    // It comes back to the limit at every period, just so.
    const Run run = simulate(m, lasting(0.5, method, 1e-11));
    check_sound(run, 1e-6);
    double worst = 0;
    for (std::size_t i = 0; i < run.time.size(); ++i)
      worst = std::max(worst, std::abs(track(run, "y").value[i] + sag * (1 - std::cos(w * run.time[i]))));
    CHECK(worst < 1e-7);
  }
}
