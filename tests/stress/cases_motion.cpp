// Motions with stiffness ratios up to 1e12, light beside heavy, damping from none to overdamped: held to a
// closed form and to the balance of energy, or refused with the reason.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

#include "engine/dynamics/simulator.hpp"

#include <complex>

namespace flyball::stress {
namespace {

using namespace flyball::test;
using Complex = std::complex<long double>;

// Relative to the amplitude, at a tolerance of a step of 1e-9: what a person who plots the motion would take
// for exact.
constexpr double allowed = 1e-5;

double largest(const std::vector<double>& values) {
  double worst = 0;
  for (const double x : values)
    if (!(std::abs(x) <= worst)) worst = std::abs(x);
  return worst;
}

// By coordinate and time, where it is known.
using Exact = std::function<std::optional<long double>(std::size_t coordinate, long double time)>;

Verdict judge_motion(const Mechanism& mechanism, double duration, double amplitude, bool must,
                     const Exact& exact, const std::atomic<bool>& cancel) {
  Verdict out;
  SimulationOptions options;
  options.duration = duration;
  options.rate = 50 / duration;
  options.tolerance = 1e-9;
  options.max_steps = 100'000; // what takes more is refused, in words
  options.cancel = &cancel;
  const Run run = simulate(mechanism, options);
  out.time_s = run.statistics.run_time_s;
  out.iterations = static_cast<int>(run.statistics.steps);
  out.net = std::string(word(run.method));
  for (const CoordinateTrack& c : run.coordinates)
    for (const std::vector<double>* values : {&c.value, &c.rate})
      if (!std::isfinite(largest(*values))) {
        out.remark = "not everything is finite";
        return out;
      }
  if (run.message.empty()) {
    out.remark = "no message";
    return out;
  }
  if (run.status != RunStatus::completed) {
    out.remark = std::string(word(run.status)) + ": " + run.message;
    if (!must) out.outcome = Outcome::refused;
    return out;
  }
  out.outcome = Outcome::solved;
  const EnergyTracks& e = run.energy;
  double energy = 1e-300;
  for (const std::vector<double>* track : {&e.kinetic, &e.potential, &e.dissipated, &e.delivered})
    energy = std::max(energy, largest(*track));
  const double drift = largest(e.balance) / energy;
  if (!(drift <= allowed)) {
    out.outcome = Outcome::failed;
    out.remark = "the balance of energy is off by " + digits(drift);
  }
  if (exact) {
    std::size_t free = 0;
    for (const CoordinateTrack& c : run.coordinates) {
      if (c.driven) continue;
      for (std::size_t i = 0; i < run.time.size(); ++i)
        if (const std::optional<long double> known = exact(free, run.time[i]))
          out.true_error = std::max(out.true_error, std::abs(static_cast<double>(c.value[i] - *known)));
      ++free;
    }
    if (!(out.true_error <= allowed * amplitude)) {
      out.outcome = Outcome::failed;
      out.remark += "off the closed form by " + digits(out.true_error);
    }
  }
  return out;
}

// Two blocks in a row, each held to what comes before by a spring and a damper; drawn at rest, the first
// spring pulled by 0.1.
Mechanism two_blocks(double m1, double m2, double k1, double k2, double c1, double c2) {
  Mechanism m;
  m.bodies = {body("first", m1, {1, 0, 0}), body("second", m2, {2, 0, 0})};
  m.joints = {dampened(sprung(prismatic("x1", "ground", "first", {1, 0, 0}, {1, 0, 0}), k1, 0.1), c1),
              dampened(sprung(prismatic("x2", "first", "second", {2, 0, 0}, {1, 0, 0}), k2, 0), c2)};
  return m;
}

// Its motion without dampers, by modes: squares of frequencies are the roots of
// m1 m2 s^2 - (k1 m2 + k2 (m1 + m2)) s + k1 k2.
Exact undamped_blocks(long double m1, long double m2, long double k1, long double k2) {
  const long double half = (k1 * m2 + k2 * (m1 + m2)) / 2;
  const long double fast = (half + std::sqrt(half * half - m1 * m2 * k1 * k2)) / (m1 * m2),
                    slow = k1 * k2 / (m1 * m2 * fast);
  // (k2 - m2 s) x2 = m2 s x1 in a mode; at the start x1 is 0.1 short of its rest, x2 at it.
  const auto ratio = [=](long double s) { return m2 * s / (k2 - m2 * s); };
  const long double rs = ratio(slow), rf = ratio(fast);
  const long double a_fast = -0.1L * rs / (rs - rf), a_slow = -0.1L - a_fast;
  return [=](std::size_t coordinate, long double t) {
    const long double s = a_slow * std::cos(std::sqrt(slow) * t), f = a_fast * std::cos(std::sqrt(fast) * t);
    return coordinate == 0 ? 0.1L + s + f : rs * s + rf * f;
  };
}

// One block from a pull of 0.1, by the roots of m r^2 + c r + k.
Exact damped_block(long double m, long double k, long double c) {
  const Complex root = std::sqrt(Complex(c * c / (4 * m * m) - k / m));
  const Complex far = -c / (2 * m) - root, near = far == Complex(0) ? Complex(0) : k / m / far;
  return [=](std::size_t, long double t) {
    if (std::abs(far - near) < 1e-9L * std::abs(far))
      return 0.1L * (1 - (std::exp(far * t) * (1.0L - far * t)).real());
    return 0.1L * (1 - ((far * std::exp(near * t) - near * std::exp(far * t)) / (far - near)).real());
  };
}

} // namespace

void add_motion_cases(const CaseChoice& choice, Cases& cases) {
  const auto add = [&](const std::string& name, Mechanism m, double duration, double amplitude, bool must,
                       Exact exact) {
    cases.push_back({"motion", name,
                     [m = std::move(m), duration, amplitude, must,
                      exact = std::move(exact)](const std::atomic<bool>& cancel) {
                       return judge_motion(m, duration, amplitude, must, exact, cancel);
                     }});
  };
  for (const double ratio : decades(0, 12, 1, choice.thinned)) {
    add("blocks, stiffness ratio " + digits(ratio), two_blocks(1, 1, 1, ratio, 0, 0), 10, 0.1, ratio <= 1e6,
        undamped_blocks(1, 1, 1, ratio));
    // Each damped critically, so that the stiff one is still as soon as it is touched.
    const double stiff = 2 * std::sqrt(ratio);
    add("damped blocks, stiffness ratio " + digits(ratio), two_blocks(1, 1, 1, ratio, 2, stiff), 40, 0.1,
        true, [](std::size_t coordinate, long double time) -> std::optional<long double> {
          if (time < 39.9L) return {};
          return coordinate == 0 ? 0.1L : 0.L; // at rest
        });
  }
  for (const double mass : decades(-12, 12, 2, choice.thinned)) {
    const double period = 2 * std::numbers::pi * std::sqrt(1 + mass);
    add("blocks, mass ratio " + digits(mass), two_blocks(1, mass, 1, 1, 0, 0), 2 * period, 0.1,
        mass > 1e-7 && mass < 1e7, undamped_blocks(1, mass, 1, 1));
  }
  for (const double k : {1e-9, 1., 1e6, 1e12})
    for (const double share : {0., 1e-6, 1., 1e3, 1e6}) { // of critical damping
      Mechanism m;
      m.bodies = {body("block", 1, {0, 0, 0})};
      const double c = 2 * std::sqrt(k) * share;
      m.joints = {dampened(sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), k, 0.1), c)};
      add("block k " + digits(k) + " damped " + digits(share) + " of critical", m, 20 / std::sqrt(k), 0.1,
          true, damped_block(1, k, c));
    }
  for (const NamedScene& scene : shipped_scenes())
    for (const double factor : {1e3, 1e6, 1e9}) {
      if (!has_springs(scene.mechanism)) continue;
      Mechanism m = scene.mechanism;
      each_stiffness(m, [&](double& x) { x *= factor; });
      each_damping(m, [&](double& x) { x *= std::sqrt(factor); });
      add(scene.name + " springs " + digits(factor) + " times", m, 1, 1, false, {});
    }
}

} // namespace flyball::stress
