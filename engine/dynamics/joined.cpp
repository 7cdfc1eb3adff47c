#include "engine/dynamics/joined.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace flyball {
namespace {

// `to` with all but the first entry of `from` behind its first `count`; of what neither has, nothing.
template <class T>
void append(std::vector<T>& to, std::size_t count, const std::vector<T>& from) {
  to.resize(std::min(count, to.size()));
  if (!from.empty()) to.insert(to.end(), from.begin() + 1, from.end());
}
// The same with each raised by `by`.
void append(std::vector<double>& to, std::size_t count, const std::vector<double>& from, double by) {
  append(to, count, from);
  for (std::size_t i = count; i < to.size(); ++i)
    to[i] += by;
}

// An angle that is measured begins anew without the whole turns it has made.
double turns_made(const CoordinateTrack& before, std::size_t last, const CoordinateTrack& after) {
  if (!after.dependent || !after.turns) return 0;
  const double away = before.value[last] - after.value.front();
  return away - std::remainder(away, 2 * std::numbers::pi);
}

void append_energies(EnergyTracks& to, std::size_t last, const EnergyTracks& from) {
  const std::size_t count = last + 1;
  append(to.kinetic, count, from.kinetic);
  append(to.potential, count, from.potential);
  if (to.jacobi.empty() || from.jacobi.empty())
    to.jacobi.clear();
  else
    append(to.jacobi, count, from.jacobi);
  for (const auto track : {&EnergyTracks::dissipated, &EnergyTracks::delivered, &EnergyTracks::applied,
                           &EnergyTracks::balance}) {
    const double stood = (to.*track)[last];
    append(to.*track, count, from.*track, stood);
  }
}

bool gives_torque(const DriveTrack& drive) {
  return !drive.load.empty();
}

bool same_coordinates(const Run& a, const Run& b) {
  return std::ranges::equal(a.coordinates, b.coordinates,
                            [](const CoordinateTrack& x, const CoordinateTrack& y) {
                              return x.joint == y.joint && x.index == y.index;
                            }) &&
         std::ranges::equal(a.drives, b.drives, {}, gives_torque, gives_torque) &&
         a.reactions.size() == b.reactions.size() && a.bearings.size() == b.bearings.size() &&
         a.gears.size() == b.gears.size() &&
         std::ranges::equal(a.points, b.points, {}, &PointTrack::point, &PointTrack::point) &&
         std::ranges::equal(a.measures, b.measures, {}, &MeasureTrack::name, &MeasureTrack::name) &&
         std::ranges::equal(a.measures, b.measures, {}, &MeasureTrack::unit, &MeasureTrack::unit);
}

void add(RunStatistics& sum, const RunStatistics& part) {
  sum.steps += part.steps;
  sum.evaluations += part.evaluations;
  sum.jacobians += part.jacobians;
  sum.rejected += part.rejected;
  sum.restarts += part.restarts;
  sum.singular_positions += part.singular_positions;
  sum.run_time_s += part.run_time_s;
  sum.position_drift = std::max(sum.position_drift, part.position_drift);
  sum.velocity_drift = std::max(sum.velocity_drift, part.velocity_drift);
  sum.correction = std::max(sum.correction, part.correction);
}

} // namespace

std::size_t sample_before(const Run& run, double time) {
  const auto later = std::ranges::upper_bound(run.time, time);
  if (later == run.time.begin()) return 0;
  const auto next = static_cast<std::size_t>(later - run.time.begin());
  const bool at_next =
      next < run.time.size() && run.time[next] - time <= same_sample * (run.time[next] - run.time[next - 1]);
  return at_next ? next : next - 1;
}

Run joined(const Run& before, std::size_t last, const Run& after) {
  if (before.time.empty() || after.time.empty() || !same_coordinates(before, after)) return after;
  const std::size_t count = last + 1;
  Run out = before;
  out.status = after.status;
  out.message = after.message;
  out.damped = after.damped;
  out.method = after.method;
  out.method_reason = after.method_reason;
  out.notes = after.notes;
  for (std::size_t i = 0; i < out.coordinates.size(); ++i) {
    append(out.coordinates[i].value, count, after.coordinates[i].value,
           turns_made(before.coordinates[i], last, after.coordinates[i]));
    append(out.coordinates[i].rate, count, after.coordinates[i].rate);
    out.coordinates[i].turns = after.coordinates[i].turns;
  }
  for (std::size_t i = 0; i < out.drives.size(); ++i)
    for (const auto track : {&DriveTrack::torque, &DriveTrack::load})
      append(out.drives[i].*track, count, after.drives[i].*track);
  for (std::size_t i = 0; i < out.reactions.size(); ++i)
    for (const auto track : {&ReactionTrack::force, &ReactionTrack::torque})
      append(out.reactions[i].*track, count, after.reactions[i].*track);
  for (std::size_t i = 0; i < out.bearings.size(); ++i)
    for (const auto track : {&BearingTrack::force, &BearingTrack::torque})
      append(out.bearings[i].*track, count, after.bearings[i].*track);
  for (std::size_t i = 0; i < out.gears.size(); ++i)
    for (const auto track : {&GearTrack::a, &GearTrack::b})
      append(out.gears[i].*track, count, after.gears[i].*track);
  const auto which = [](const SpringTrack& s) { return std::tuple(s.joint, s.index, s.between_points); };
  if (!std::ranges::equal(out.springs, after.springs, {}, which, which))
    out.springs.clear(); // others from here on
  for (std::size_t i = 0; i < out.springs.size(); ++i)
    for (const auto track : {&SpringTrack::spring, &SpringTrack::damper, &SpringTrack::stop})
      append(out.springs[i].*track, count, after.springs[i].*track);
  for (std::size_t i = 0; i < out.measures.size(); ++i)
    append(out.measures[i].value, count, after.measures[i].value);
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    PointTrack& to = out.points[i];
    const PointTrack& from = after.points[i];
    append(to.position, count, from.position);
    append(to.velocity, count, from.velocity);
    if (to.acceleration.empty() || from.acceleration.empty())
      to.acceleration.clear();
    else
      append(to.acceleration, count, from.acceleration);
  }
  append_energies(out.energy, last, after.energy);
  append(out.time, count, after.time);
  std::erase_if(out.stops, [&](const StopEvent& stop) { return stop.time > before.time[last]; });
  out.stops.insert(out.stops.end(), after.stops.begin(), after.stops.end());
  std::erase_if(out.frictions, [&](const FrictionEvent& event) { return event.time > before.time[last]; });
  out.frictions.insert(out.frictions.end(), after.frictions.begin(), after.frictions.end());
  add(out.statistics, after.statistics);

  // A sample's state has the same length in both: the coordinates are the same.
  const std::size_t length = before.states.size() / before.time.size();
  std::erase_if(out.segments, [&](const Run::Segment& segment) { return segment.first > last; });
  for (const Run::Segment& segment : after.segments)
    out.segments.push_back({segment.first == 0 ? last : last + segment.first, segment.model});
  out.states.resize(last * length);
  out.states.insert(out.states.end(), after.states.begin(), after.states.end());
  return out;
}

} // namespace flyball
