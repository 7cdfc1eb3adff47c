// Floquet multipliers against the motion itself, which knows nothing of linearised matrices: sampled once a
// period, any coordinate of a small motion obeys the recurrence that the characteristic polynomial of the
// monodromy matrix gives (Cayley and Hamilton).
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/support/dice.hpp"

#include "engine/dynamics/simulation.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/stability/floquet.hpp"

#include <complex>

using namespace flyball;
using namespace flyball::test;

namespace {

using Complex = std::complex<double>;

// A rotor with three different principal moments, or arms with masses, driven in a frame that springs and
// dampers hold about two or three axes; seen from the frame its inertia turns.
Mechanism unround_rotor(unsigned seed) {
  Dice any(seed);
  Mechanism m;
  m.name = "rotor " + std::to_string(seed);
  const double height = any.between(0.1, 0.4);
  m.bodies.push_back(
      body("frame", any.between(0.1, 1), Vec3(0, 0, any.between(0, 0.2)), Vec3(0.02, 0.02, 0.02)));
  const double a = any.between(0.02, 0.05), b = any.between(0.02, 0.05);
  m.bodies.push_back(body("rotor", any.between(0.5, 3), Vec3(0, 0, height),
                          Vec3(a, b, any.between(std::abs(a - b), a + b))));
  Joint hang = joint(JointType::universal, "hang", "ground", "frame", Vec3::Zero());
  hang.axis = Vec3::UnitX();
  hang.axis2 = Vec3::UnitY();
  for (Coordinate& c : hang.coordinates) {
    c.spring = CoordinateSpring{any.between(20, 80), 0};
    c.damping = any.between(0.001, 0.01);
  }
  m.joints.push_back(hang);
  Joint drive = revolute("drive", "frame", "rotor", Vec3(0, 0, height), Vec3::UnitZ());
  drive.coordinates[0].drive = Drive{any.between(5, 40)};
  m.joints.push_back(drive);
  if (seed % 3 == 0) { // and a pendulum across the spin axis on the rotor, its hinge through the axis
    m.bodies.push_back(
        body("arm", any.between(0.1, 0.5), Vec3(0, 0, height + 0.1), Vec3(0.001, 0.002, 0.0015)));
    Joint hinge = revolute("hinge", "rotor", "arm", Vec3(0, 0, height), Vec3::UnitX());
    hinge.coordinates[0].spring = CoordinateSpring{any.between(20, 60), 0};
    hinge.coordinates[0].damping = any.between(0.001, 0.02);
    m.joints.push_back(hinge);
  }
  return m;
}

// Coefficients of the polynomial with these roots, the highest power last.
std::vector<Complex> polynomial(const std::vector<Complex>& roots) {
  std::vector<Complex> c{1};
  for (const Complex root : roots) {
    c.push_back(0);
    for (std::size_t i = c.size() - 1; i > 0; --i)
      c[i] = c[i - 1] - root * c[i];
    c[0] *= -root;
  }
  return c;
}

} // namespace

TEST_CASE("Floquet: simulated motions obey the multipliers", "[floquet]") {
  int judged = 0, unstable = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    Mechanism m = unround_rotor(seed);
    Solution s = solve(m, nearest());
    // Every other one at a speed at which it grows, if there is one.
    for (double speed = 8; seed % 2 == 0 && speed < 40 && s.stable != false; speed += 0.5) {
      set_parameter(m, "joints.drive.drive.speed", speed);
      s = solve(m, nearest());
    }
    INFO(m.name << ": " << s.message);
    REQUIRE(s.status == Status::converged);
    if (!s.floquet) continue;
    ++judged;
    unstable += s.stable == false;
    const std::vector<Complex> c = polynomial(s.floquet->multipliers);
    const std::size_t order = c.size() - 1;
    SimulationOptions options;
    options.start = Start::equilibrium;
    options.kick = {{"hang.0", 1e-3}, {"hang.1", -2e-3}};
    options.rate = 1 / s.floquet->period;
    options.duration = static_cast<double>(order + 4) * s.floquet->period * (1 + 1e-9);
    options.tolerance = 1e-13;
    const Run run = simulate(m, options);
    REQUIRE(run.status == RunStatus::completed);
    for (const CoordinateTrack& track : run.coordinates) {
      if (track.driven) continue;
      REQUIRE(track.value.size() > order + 3);
      for (std::size_t k = 0; k < 3; ++k) {
        Complex sum = 0;
        double size = 0;
        for (std::size_t j = 0; j <= order; ++j) {
          sum += c[j] * track.value[k + j];
          size += std::abs(c[j] * track.value[k + j]);
        }
        CHECK(std::abs(sum) <= 1e-4 * size);
      }
    }
  }
  CHECK(judged >= 20);
  CHECK(unstable >= 1);
}

TEST_CASE("multipliers within their error of the unit circle tell of stability in Hamilton's motions alone") {
  const auto pair = [](double size) {
    const Complex mu = std::polar(size, 0.9);
    return std::vector{mu, std::conj(mu)};
  };
  const double error = 1e-7;
  for (const bool has_hamiltonian : {true, false}) {
    CHECK(stable_by_multipliers(pair(1 - 1e-5), error, 0, has_hamiltonian) == true);
    CHECK(stable_by_multipliers(pair(1 + 1e-5), error, 0, has_hamiltonian) == false);
    for (const double size : {1 - 3e-7, 1., 1 + 3e-7})
      CHECK(stable_by_multipliers(pair(size), error, 0, has_hamiltonian).has_value() == has_hamiltonian);
  }
}
