#include "engine/periodic/measured_orbit.hpp"

#include "engine/dynamics/joined.hpp"
#include "engine/periodic/open_loads.hpp"
#include "engine/periodic/orbit_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace flyball {
namespace {

constexpr int samples_a_turn = 64, least_samples = 256, most_samples = 16384;
constexpr double fine_enough = 1e-6; // of the largest rates: half of the samples tell the same
constexpr double gains = 4;          // times: what less is gained by twice the samples are kinks
constexpr double coarse_gaps = 10, coarse_steps = 100; // times the tolerance, of what tells the errors

// At first, by the turns of the fastest drive.
int first_samples(const Orbit& orbit, double rate) {
  const int turns = std::max(1, static_cast<int>(std::lround(rate * orbit.period / (2 * std::numbers::pi))));
  int n = least_samples;
  while (n < std::min(samples_a_turn * turns, most_samples))
    n *= 2;
  return n;
}

// A period of the orbit, segment by segment, for an unstable one would be left. It begins `lead` (s) after
// the nodes.
Run recorded(Flow& flow, const Orbit& orbit, int wanted, double tolerance, double lead) {
  const auto m = static_cast<int>(orbit.nodes.size());
  const int each = 2 * ((wanted + 2 * m - 1) / (2 * m)); // even, so that every second one counts as well
  Run whole;
  for (const StateChart& node : orbit.nodes) {
    const auto led = lead > 0 ? flow.pass(node.base(), lead, tolerance) : std::nullopt;
    if (lead > 0 && !led) return {};
    const Run part = flow.record(led ? led->to : node.base(), orbit.period / m, each, tolerance);
    if (part.time.empty()) return {};
    whole = whole.time.empty() ? part : joined(whole, whole.time.size() - 1, part);
  }
  return whole;
}

// Not where a sample would have fallen right on a singular position and was taken a little later.
bool is_sampled_evenly(const Run& run) {
  const auto last = static_cast<double>(run.time.size() - 1);
  const double begin = run.time.front(), apart = (run.time.back() - begin) / last;
  for (std::size_t i = 0; i < run.time.size(); ++i)
    if (std::abs(run.time[i] - begin - static_cast<double>(i) * apart) > 1e-9 * apart) return false;
  return true;
}

// What goes on is told less its advance since the first node: so of a run that begins `lead` after it.
void count_from_nodes(double lead, double period, PeriodicState& told) {
  for (PeriodicCoordinate& c : told.coordinates)
    for (double* value : {&c.range.mean, &c.range.least, &c.range.most})
      *value -= c.advance * lead / period;
}

// The largest error of the rates' ranges that the samples leave, as a part of the fastest.
double uncertainty(const PeriodicState& told, double length) {
  double out = 0;
  for (const bool angle : {false, true}) {
    double fastest = 0, error = 0;
    for (const PeriodicCoordinate& c : told.coordinates) {
      if (c.angle != angle || !std::isfinite(c.rate.error)) continue;
      fastest = std::max({fastest, std::abs(c.rate.least), std::abs(c.rate.most)});
      error = std::max(error, c.rate.error);
    }
    // Rounding has no scale to be compared with.
    const double unit = angle ? 1 : length;
    if (fastest > 1e-9 * unit) out = std::max(out, error / fastest);
  }
  return out;
}

} // namespace

bool measure_orbit(Flow& flow, const Orbit& orbit, const ShootingOptions& how, double rate,
                   PeriodicState& out) {
  const double length = flow.model().parameters.length;
  const auto other = orbit_beside(flow, orbit, how, coarse_gaps);
  std::shared_ptr<Run> run;
  PeriodicState told;
  double unsure = std::numeric_limits<double>::infinity();
  int count = first_samples(orbit, rate);
  double lead = 0;
  for (;; count *= 2) { // what moves faster than the drives takes more
    run = std::make_shared<Run>(recorded(flow, orbit, count, how.tolerance, lead));
    if (lead == 0 && (run->time.empty() || !is_sampled_evenly(*run))) {
      // Samples fall beside singular positions, which are passed at even parts of a turn as a rule.
      const double later = 0.382 * orbit.period / count;
      Run beside = recorded(flow, orbit, count, how.tolerance, later);
      if (!beside.time.empty()) {
        lead = later;
        beside.statistics.singular_positions =
            std::max(beside.statistics.singular_positions, run->statistics.singular_positions);
        *run = std::move(beside);
      }
    }
    if (run->time.empty()) return false;
    told = {};
    fill_ranges(*run, told);
    const double before = std::exchange(unsure, uncertainty(told, length));
    if (unsure <= fine_enough || unsure > before / gains || 2 * count > most_samples) break;
  }
  count_from_nodes(lead, orbit.period, told);
  out.coordinates = std::move(told.coordinates);
  out.drive_torques = std::move(told.drive_torques);
  out.reactions = std::move(told.reactions);
  out.bearings = std::move(told.bearings);
  out.gears = std::move(told.gears);
  out.springs = std::move(told.springs);
  out.measures = std::move(told.measures);
  mark_open_loads(*run, out);
  fill_unique_sizes(*run, out, out);
  PeriodicState beside;
  if (other) {
    out.period_error = std::abs(other->period - orbit.period);
    const Run also = recorded(flow, *other, count, coarse_steps * how.tolerance, lead);
    if (!also.time.empty()) {
      fill_ranges(also, beside);
      count_from_nodes(lead, other->period, beside);
      fill_unique_sizes(also, out, beside);
    }
  }
  const bool known = beside.coordinates.size() == out.coordinates.size() &&
                     beside.drive_torques.size() == out.drive_torques.size();
  compare_ranges(known ? &beside : nullptr, out);
  for (PeriodicCoordinate& coordinate : out.coordinates)
    coordinate.range.error += orbit.residual * (coordinate.angle ? 1 : length);
  out.motion = std::move(run);
  return true;
}

} // namespace flyball
