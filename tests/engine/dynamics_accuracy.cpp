// Orders of convergence, what a tolerance buys, and stiff motions.
#include "tests/engine/dynamics_runs.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// Of the last sample from a reference's, all coordinates.
double end_error(const Run& run, const Run& reference) {
  double worst = 0;
  for (std::size_t k = 0; k < run.coordinates.size(); ++k)
    worst =
        std::max(worst, std::abs(run.coordinates[k].value.back() - reference.coordinates[k].value.back()));
  return worst;
}

SimulationOptions ends_only(double duration, Integrator method, double tolerance) {
  SimulationOptions o = lasting(duration, method, tolerance);
  o.rate = 0;
  return o;
}

// Two blocks on springs, the second held to the first by a hard spring and a damper: the difference dies out
// at `fast` 1/s, the sum swings at about 1 rad/s.
Mechanism stiff_pair(double fast, bool with_damper) {
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}), body("b", 1, {1, 0, 0})};
  m.joints = {sprung(prismatic("x", "ground", "a", {0, 0, 0}, {1, 0, 0}), 2, 0.1),
              sprung(prismatic("y", "a", "b", {1, 0, 0}, {1, 0, 0}), fast * fast / 4, 0)};
  if (with_damper) m.joints[1] = dampened(m.joints[1], fast / 2);
  return m;
}

} // namespace

TEST_CASE("the Runge-Kutta method is of order eight") {
  Mechanism wide = conical(0.7, 0.2, 4, 1.5);
  wide.name = "conical";
  for (const Mechanism& m : {shipped("conical_pendulum"), wide}) {
    CAPTURE(m.name);
    const double duration = 4;
    const auto run = [&](SimulationOptions o) { return simulate(m, kicked(undamped(o), "swing", 2)); };
    const Run reference = run(ends_only(duration, Integrator::runge_kutta, 1e-14));
    std::vector<double> errors;
    for (int steps : {36, 72, 144}) { // errors above rounding
      SimulationOptions o = ends_only(duration, Integrator::runge_kutta, 1e-10);
      o.fixed_step = duration / steps;
      const Run fixed = run(o);
      CHECK(fixed.statistics.steps == steps);
      errors.push_back(end_error(fixed, reference));
    }
    CAPTURE(errors);
    const double order = std::log2(errors[0] / errors[1]);
    CHECK(order > 7.5);
    CHECK(order < 9.5);
    CHECK(errors[2] < errors[1] / 200);
  }
}

TEST_CASE("errors fall with the tolerance, in proportion") {
  for (const std::string name : {"conical_pendulum", "governor", "pendulum"}) {
    const Mechanism m = shipped(name);
    const Run reference = simulate(m, ends_only(1, Integrator::runge_kutta, 1e-14));
    for (const Integrator method : all_integrators) {
      std::vector<double> errors, tolerances;
      for (double tolerance = 1e-3; tolerance > 3e-12; tolerance /= 10) {
        tolerances.push_back(tolerance);
        errors.push_back(end_error(simulate(m, ends_only(1, method, tolerance)), reference));
      }
      CAPTURE(name, word(method), errors);
      // The slope of a straight line through the logarithms; a single tolerance may be lucky.
      double sx = 0, sy = 0, sxx = 0, sxy = 0;
      const auto n = static_cast<double>(errors.size());
      for (std::size_t i = 0; i < errors.size(); ++i) {
        const double x = std::log10(tolerances[i]), y = std::log10(errors[i] + 1e-16);
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
        CHECK(errors[i] < 1e3 * tolerances[i]);
      }
      const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
      CHECK(slope > 0.6);
      CHECK(slope < 1.4);
    }
  }
}

TEST_CASE("stiffness up to 1e12 costs BDF nothing") {
  for (const double fast : {1e2, 1e4, 1e6, 1e9, 1e12}) {
    CAPTURE(fast);
    SimulationOptions o = lasting(10, Integrator::automatic, 1e-8);
    o.max_steps = 100000;
    const Run run = simulate(stiff_pair(fast, true), o);
    check_sound(run, 1e-4); // what the tolerance leaves over ten seconds
    CHECK(run.method == Integrator::bdf);
    CHECK_THAT(run.method_reason, ContainsSubstring("BDF"));
    CHECK(run.statistics.steps < 20000);
    if (fast < 1e4) continue;
    // As one body of 2 kg; the second hangs back by what its own acceleration asks for.
    for (std::size_t i = 0; i < run.time.size(); ++i) {
      CHECK(std::abs(track(run, "x").value[i] - 0.1 * (1 - std::cos(run.time[i]))) < 1e-5);
      CHECK(std::abs(track(run, "y").value[i]) < 1 / (fast * fast) + 1e-6);
    }
  }
}

TEST_CASE("a fast oscillation that nothing damps is followed, or given up with the reason") {
  SimulationOptions o = lasting(0.1, Integrator::automatic, 1e-8);
  const Run slow = simulate(stiff_pair(1e3, false), o);
  check_sound(slow, 1e-6);
  o.duration = 10;
  o.max_steps = 10000;
  const Run fast = simulate(stiff_pair(1e9, false), kicked(o, "y", 1));
  CHECK(fast.status == RunStatus::diverged);
  CHECK_THAT(fast.message, ContainsSubstring("steps"));
  check_whole(fast);
}

TEST_CASE("the method is chosen by the motion") {
  CHECK(simulate(shipped("pendulum"), undamped(lasting(0.05))).method == Integrator::runge_kutta);
  Mechanism m = shipped("governor");
  set_parameter(m, "joints.slide.damping", 1e6);
  const Run run = simulate(m, lasting(0.5));
  check_sound(run);
  CHECK(run.method == Integrator::bdf);
}
