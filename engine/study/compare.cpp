#include "engine/study/compare.hpp"

#include "engine/dynamics/simulator.hpp"
#include "engine/dynamics/watch.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/messages.hpp"
#include "engine/study/direct_solution.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace flyball {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// What one run may take of the whole time, and from which part on it is not repeated.
constexpr double longest_run = 0.1, longest_repeated = 0.01;

// The clock and whether anybody still waits.
struct Time {
  Watch watch;
  double limit; // s, for everything

  bool is_long(double seconds) const { return seconds > longest_repeated * limit || watch.over(); }
};

// Median of the time that one call takes, over batches long enough for the clock.
template <class Work>
double time_of(int repeats, const Time& time, Work work) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [&](int count) {
    const auto begin = Clock::now();
    for (int i = 0; i < count; ++i)
      work();
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  int count = 1;
  double spent = seconds(1);
  if (time.is_long(spent)) return spent;
  for (; spent < 1e-3 && count < 1 << 20; spent = seconds(count))
    count *= 2;
  std::vector<double> times;
  for (int i = 0; i < repeats && !(i > 0 && time.watch.over()); ++i)
    times.push_back(seconds(count) / count);
  return median(std::move(times));
}

// Long enough for the slowest motion about the steady state to shrink to 1e-2, 1e-4 ... 1e-10; s.
std::vector<double> natural_durations(const Solution& steady, const Mechanism& mechanism) {
  double slowest = std::numeric_limits<double>::infinity();
  double fastest = 0;
  if (steady.eigenvalues)
    for (const std::complex<double>& rate : *steady.eigenvalues) {
      fastest = std::max(fastest, std::abs(rate));
      if (rate.real() < -1e-9 * std::abs(rate)) slowest = std::min(slowest, -rate.real());
    }
  std::vector<double> out;
  if (std::isfinite(slowest) && slowest > 1e-9 * fastest) {
    for (int digits : {2, 4, 6, 8, 10}) {
      const double exact = digits * std::numbers::ln10 / slowest;
      const double unit = std::pow(10., std::floor(std::log10(exact)) - 1);
      out.push_back(std::ceil(exact / unit) * unit);
    }
  } else {
    for (double part : {0.25, 0.5, 1., 2., 4.})
      out.push_back(part * mechanism.simulation.duration);
  }
  return out;
}

// In radians or of the reach: what a motion ends farther away from it has not come to.
constexpr double comes_near = 1e-2;

// Leaves the message with what there is to say where no motion is one to compare with.
void find_best(Comparison& c) {
  const auto distance = [](const MotionMark& p) { return std::max(p.error, p.goes_on); };
  std::optional<std::pair<double, double>> nearest; // how far it is, or goes on, and after how long
  for (const MotionCurve& curve : c.motion)
    for (const MotionMark& p : curve.points) {
      if (p.status != RunStatus::completed) continue;
      if (!nearest || distance(p) < nearest->first) nearest = {distance(p), curve.duration};
      if (!(distance(p) <= comes_near) || (c.best && p.error >= c.best->error)) continue;
      c.best = {curve.method, curve.duration, p.tolerance, p.error, p.run_time_s, c.answer.run_time_s};
    }
  if (!nearest) return;
  if (!c.best) {
    if (c.complete) // else a longer one was not reached
      c.message += " No motion comes to stand at this steady state: the nearest ends, or swings on, " +
                   rounded_text(nearest->first, 2) +
                   " from it (in radians, and slides as parts of the mechanism's size), after " +
                   rounded_text(nearest->second, 4) +
                   " s simulated; it may need longer, or settle in another one.";
    return;
  }
  // The first iteration that comes as near; where a fallback was needed, the answer.
  for (const DirectMark& mark : c.direct)
    if (mark.iterations > 0 && mark.error <= c.best->error) {
      c.best->direct_s = mark.run_time_s;
      return;
    }
}

// The integrators look at the flag themselves, and nothing may be thrown through them.
Run simulated(const Mechanism& mechanism, const SimulationOptions& options) {
  const Uninterrupted scope;
  return simulate(mechanism, options);
}

// 1/s: of the slowest motion about the steady state; 0 where it is not known.
double slowest_rate(const Solution& steady) {
  constexpr double null = 1e-5; // of the fastest: a double zero is known to half of the digits
  if (!steady.eigenvalues) return 0;
  double fastest = 0, slowest = std::numeric_limits<double>::infinity();
  for (const std::complex<double>& s : *steady.eigenvalues)
    fastest = std::max(fastest, std::abs(s));
  for (const std::complex<double>& s : *steady.eigenvalues)
    if (std::abs(s) > null * fastest) slowest = std::min(slowest, std::abs(s));
  return std::isfinite(slowest) ? slowest : 0;
}

struct RunEnd {
  Eigen::VectorXd q, rates; // of what nothing drives, scaled; 0 of what torques drive
  Eigen::VectorXd angles;   // by link, of what torques drive
};

// Where a run ended.
RunEnd end_of(const Run& run, const DirectSolution& direct) {
  const auto nq = static_cast<std::ptrdiff_t>(direct.system().nq);
  const auto sample =
      static_cast<std::ptrdiff_t>(run.states.size()) - (nq + static_cast<std::ptrdiff_t>(direct.system().nv));
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(run.states.data() + sample, nq);
  Eigen::VectorXd rates = Eigen::Map<const Eigen::VectorXd>(run.states.data() + sample + nq,
                                                            static_cast<Eigen::Index>(direct.system().nv))
                              .cwiseQuotient(direct.scaling().column);
  // What torques drive is compared by its speed; the motion's coordinates are in the same order.
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(direct.system().links.size()));
  for (std::size_t l = 0; l < direct.system().links.size(); ++l)
    if (const Link& link = direct.system().links[l]; finds_speed(link)) {
      angles[static_cast<Eigen::Index>(l)] = q[link.q];
      q[link.q] = run.states[static_cast<std::size_t>(sample + nq + link.v)];
      rates[link.v] = 0;
    }
  return {std::move(q), std::move(rates), std::move(angles)};
}

// One run and its repeats. Nothing where nobody waits for it any more.
std::optional<MotionMark> measure(const Mechanism& mechanism, const SimulationOptions& simulation,
                                  int repeats, const Time& time, DirectSolution& direct, double slowest) {
  MotionMark point;
  point.tolerance = simulation.tolerance;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const Run run = simulated(mechanism, simulation);
    if (time.watch.over()) break;
    times.push_back(run.statistics.run_time_s);
    if (i == 0) {
      point.error = std::numeric_limits<double>::quiet_NaN();
      if (run.status == RunStatus::completed) {
        const auto [q, rates, angles] = end_of(run, direct);
        point.error = std::max(direct.error_of(q), direct.take_angles(angles, simulation.duration));
        if (slowest > 0) point.goes_on = direct.size_of(rates) / slowest;
        point.measure_errors = direct.measure_errors(q);
      }
      point.steps = run.statistics.steps;
      point.evaluations = run.statistics.evaluations;
      point.status = run.status;
    }
    if (run.status != RunStatus::completed || time.is_long(times.back())) break; // once is enough
  }
  if (times.empty()) return {};
  point.run_time_s = median(std::move(times));
  return point;
}

// One curve a method and duration, into out.motion. False where it was broken off.
bool measure_motions(const Mechanism& mechanism, const CompareOptions& options,
                     const std::vector<double>& durations, const Time& time, DirectSolution& direct,
                     double slowest, Comparison& out) {
  const std::size_t all = options.integrators.size() * durations.size() * options.tolerances.size();
  std::size_t done = 0;
  for (Integrator method : options.integrators)
    for (double duration : durations) {
      MotionCurve& curve = out.motion.emplace_back(MotionCurve{method, duration, {}});
      bool too_long = false;
      for (double tolerance : options.tolerances) {
        if (!too_long) {
          SimulationOptions simulation;
          simulation.duration = duration;
          simulation.rate = 0;
          simulation.tolerance = tolerance;
          simulation.method = method;
          simulation.max_steps = options.max_steps;
          simulation.cancel = options.cancel;
          simulation.time_limit = longest_run * time.limit;
          const std::optional<MotionMark> point =
              measure(mechanism, simulation, options.repeats, time, direct, slowest);
          if (!point) return false;
          curve.points.push_back(*point);
          too_long = point->status == RunStatus::time_limit;
        }
        if (options.progress) options.progress(++done, all);
      }
    }
  return true;
}

void compare_through(const Mechanism& mechanism, const CompareOptions& options, const Time& time,
                     Comparison& out) {
  const auto broken_off = [&] {
    out.complete = false;
    out.message = !time.watch.out_of_time() ? "Cancelled."
                                            : "The time limit of " + rounded_text(options.time_limit, 4) +
                                                  " s was reached before all was measured.";
  };
  SolveOptions solve;
  solve.cancel = options.cancel;
  const Solution steady = Analysis(mechanism).solve(solve);
  out.status = steady.frictions.empty() ? steady.status : Status::no_steady_state;
  out.message = steady.frictions.empty() ? steady.message
                                         : rests_on_friction(steady, "Ways of finding it are compared");
  if (time.watch.over()) broken_off();
  if (out.status != Status::converged || !out.complete) return;
  DirectSolution direct(mechanism, options.cancel);
  Unknowns answer;
  if (!direct.answer(answer)) { // found above, unless it is all too long
    broken_off();
    return;
  }
  direct.settle_reference(answer, out);
  if (!direct.determines_anything()) {
    out.complete = false;
    out.message = "Nothing resists any coordinate of its steady state, so there is no error to compare.";
    return;
  }
  out.answer = {direct.iterations(), direct.error_of(answer.q),
                time_of(options.repeats, time, [&] { direct.answer(answer); }),
                direct.measure_errors(answer.q)};
  for (std::size_t i = 0; i < mechanism.measures.size(); ++i) {
    MeasureSolution& measure = out.measures.emplace_back();
    measure.name = mechanism.measures[i].name;
    measure.unit = mechanism.measures[i].unit;
    const double value = direct.measured()[static_cast<Eigen::Index>(i)];
    if (std::isfinite(value)) measure.value = value;
  }
  // Where the angles are looked for, too, there is no one line of iterations.
  for (int i = 0; i <= 30 && !direct.turned() && !time.watch.over(); ++i) {
    Unknowns z;
    const bool converged = direct.iterate(i, z);
    const double error = direct.error_of(z.q);
    std::vector<double> measure_errors = direct.measure_errors(z.q);
    out.direct.push_back(
        {i, error, time_of(options.repeats, time, [&] { direct.iterate(i, z); }), std::move(measure_errors)});
    if (converged) break;
  }
  if (out.direct.empty() || !(out.direct.back().error < 1e-6)) out.direct.clear();

  const std::vector<double> durations =
      options.durations.empty() ? natural_durations(steady, mechanism) : options.durations;
  if (!measure_motions(mechanism, options, durations, time, direct, slowest_rate(steady), out)) broken_off();
  find_best(out);
  const bool any_end = std::ranges::any_of(out.motion, [](const MotionCurve& curve) {
    return std::ranges::any_of(curve.points,
                               [](const MotionMark& p) { return p.status == RunStatus::completed; });
  });
  if (out.complete && !any_end) {
    out.complete = false;
    out.message = "No motion went on to its end, so there is nothing to compare with.";
  }
}

} // namespace

Comparison compare(const Mechanism& mechanism, const CompareOptions& options) {
  Comparison out;
  Time time{Watch(options.cancel), options.time_limit};
  time.watch.allow(options.time_limit);
  const Interruptible scope(options.cancel);
  try {
    compare_through(mechanism, options, time, out);
  } catch (const Interrupted&) {
    out.complete = false;
    out.message = "Cancelled.";
    std::erase_if(out.motion, [](const MotionCurve& curve) { return curve.points.empty(); });
  }
  return out;
}

} // namespace flyball
