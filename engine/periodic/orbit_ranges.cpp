#include "engine/periodic/orbit_ranges.hpp"

#include "engine/dynamics/motion_model.hpp"
#include "engine/linear/golden_section.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

namespace flyball {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double near_enough = 1e-4; // of the span: the end joins the beginning
constexpr double rounding = 4096 * std::numeric_limits<double>::epsilon(); // of the steps of a period

// Every `stride`-th of the values at even distances over a period, as they are or upside down.
struct PeriodSamples {
  std::span<const double> values; // the last one that of the first again
  std::size_t stride = 1;
  double sign = 1;

  std::size_t count() const { return (values.size() - 1) / stride; }
  // The k-th on from the i-th, -count() <= k.
  double at(std::size_t i, int k = 0) const {
    const std::size_t n = count();
    return sign * values[(i + n + static_cast<std::size_t>(k + static_cast<int>(n))) % n * stride];
  }
  // The polynomial through the seven samples about the i-th, x samples on, -1 <= x <= 1.
  double near(std::size_t i, double x) const {
    double sum = 0;
    for (int k = -3; k <= 3; ++k) {
      double weight = 1;
      for (int j = -3; j <= 3; ++j)
        if (j != k) weight *= (x - j) / (k - j);
      sum += weight * at(i, k);
    }
    return sum;
  }
};

// The square of the size of a vector likewise: it is smooth where the size has a kink at zero.
struct SquareSamples {
  std::array<PeriodSamples, 3> components;
  double sign = 1;

  std::size_t count() const { return components[0].count(); }
  double at(std::size_t i, int k = 0) const {
    double sum = 0;
    for (const PeriodSamples& c : components)
      sum += c.at(i, k) * c.at(i, k);
    return sign * sum;
  }
  double near(std::size_t i, double x) const {
    double sum = 0;
    for (const PeriodSamples& c : components) {
      const double value = c.near(i, x);
      sum += value * value;
    }
    return sign * sum;
  }
};

constexpr std::size_t fewest = 7; // samples that make a polynomial

// The greatest value near a sample, no further than the next ones.
template <class Samples>
double crest_about(const Samples& period, std::size_t at) {
  if (period.count() < fewest) return period.at(at);
  const auto polynomial = [&](double x) { return period.near(at, x); };
  return std::max(golden_section(-1, 1, 1e-9, polynomial).value, period.at(at));
}

// The highest crest. That need not be the one with the highest sample: of several that are nearly as high
// samples hit some better than others.
template <class Samples>
double highest_crest(const Samples& period) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < period.count(); ++i)
    if (period.at(i) > period.at(best)) best = i;
  double most = crest_about(period, best);
  for (std::size_t i = 0; i < period.count(); ++i) {
    const double before = period.at(i, -1), here = period.at(i), after = period.at(i, 1);
    if (here < before || here <= after) continue;
    // What a parabola rises above the sample, twice, and some more where it is one of its highest: a bound.
    const double bend = 2 * here - before - after, slope = after - before;
    if (here + slope * slope / (4 * bend) + bend / 64 > most) most = std::max(most, crest_about(period, i));
  }
  return most;
}

PeriodicRange range_with(std::span<const double> values, std::size_t stride) {
  PeriodicRange out;
  const std::size_t n = (values.size() - 1) / stride;
  for (std::size_t i = 0; i < n; ++i)
    out.mean += values[i * stride];
  out.mean /= static_cast<double>(n);
  out.least = -highest_crest(PeriodSamples{values, stride, -1});
  out.most = highest_crest(PeriodSamples{values, stride, 1});
  return out;
}

// The integral of the size from a sample to the next, over their distance, by five points of Gauss in each of
// `parts`.
double size_beyond(const SquareSamples& squares, std::size_t at, int parts) {
  constexpr std::array<double, 3> place{0, 0.5384693101056831, 0.9061798459386640},
      weight{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  double sum = 0;
  for (int part = 0; part < parts; ++part)
    for (int k = -2; k <= 2; ++k) {
      const auto of = static_cast<std::size_t>(std::abs(k));
      const double x = (part + (1 + (k < 0 ? -place[of] : place[of])) / 2) / parts;
      sum += weight[of] / 2 * std::sqrt(std::max(0., squares.near(at, x)));
    }
  return sum / parts;
}

// By the trapezoidal rule, or where the size vanishes at a few places or nearly so, and turns in kinks, by
// Gauss's with shorter steps there.
double mean_size(const SquareSamples& squares) {
  const std::size_t n = squares.count();
  std::vector<double> size(n + 1);
  for (std::size_t i = 0; i <= n; ++i)
    size[i] = std::sqrt(squares.at(i % n));
  double step = 0;
  for (std::size_t i = 0; i < n; ++i)
    step = std::max(step, std::abs(size[i + 1] - size[i]));
  std::size_t small = 0;
  for (std::size_t i = 0; i < n; ++i)
    small += std::min(size[i], size[i + 1]) < step;
  const bool smooth = *std::ranges::min_element(size) > 8 * step, rough = small > n / 4; // rounding
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i)
    sum += smooth || rough || n < fewest
               ? size[i]
               : size_beyond(squares, i, std::min(size[i], size[i + 1]) < step ? 64 : 1);
  return sum / static_cast<double>(n);
}

PeriodicRange size_with(const std::array<std::vector<double>, 3>& components, std::size_t stride) {
  SquareSamples squares;
  for (std::size_t c = 0; c < components.size(); ++c)
    squares.components[c] = {components[c], stride};
  PeriodicRange out;
  out.mean = mean_size(squares);
  out.most = std::sqrt(std::max(0., highest_crest(squares)));
  squares.sign = -1;
  out.least = std::sqrt(std::max(0., -highest_crest(squares)));
  return out;
}

double largest_difference(const PeriodicRange& a, const PeriodicRange& b) {
  return std::max({std::abs(a.mean - b.mean), std::abs(a.least - b.least), std::abs(a.most - b.most)});
}

// Of values that go on by `advance` over the period, less their even share of it.
PeriodicRange range_without(std::vector<double> values, double advance) {
  const double share = advance / static_cast<double>(values.size() - 1);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] -= share * static_cast<double>(i);
  return range_over_period(values);
}

// By how much a track goes on; what comes back does so but for rounding and the steps' errors.
double advance_of(const CoordinateTrack& track) {
  const double advance = track.value.back() - track.value.front();
  return std::abs(advance) > 1e-6 * (track.scale + std::abs(track.value.front())) ? advance : 0;
}

// Whether the end joins the beginning. What wheels measure that have no part in the period does not;
// rounding, which changes its direction all the time, is taken to, and what is less than `small`.
bool comes_back(std::span<const double> values, double small) {
  const auto [least, most] = std::ranges::minmax(values);
  if (!(std::abs(values.back() - values.front()) > std::max(small, near_enough * (most - least))))
    return true;
  double moved = 0, bent = 0;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    moved += std::abs(values[i + 1] - values[i]);
    bent += std::abs(values[i + 1] - 2 * values[i] + values[i - 1]);
  }
  return bent > 0.5 * moved;
}

// N, moments by the reach (m): of all that joints, bearings and gears bear.
double largest_load(const Run& run, double reach) {
  double largest = 0;
  const auto take = [&](const auto& tracks) {
    for (const auto& track : tracks)
      for (std::size_t i = 0; i < track.force.size(); ++i)
        largest = std::max({largest, track.force[i].norm(), track.torque[i].norm() / reach});
  };
  take(run.reactions);
  take(run.bearings);
  return largest;
}

// Ranges of loads, whose rounding (N) is a part of the largest.
class LoadRanges {
 public:
  LoadRanges(const Run& run, double reach) : largest_(largest_load(run, reach)), reach_(reach) {}

  bool come_back(std::span<const double> values, bool moment) const {
    return comes_back(values, small(moment));
  }

  PeriodicRange of(std::span<const double> values, bool moment) const {
    if (!come_back(values, moment)) return {unknown, unknown, unknown, unknown};
    return rounded(range_over_period(values), moment);
  }

  PeriodicVector of(const std::vector<Vec3>& values, bool moment) const {
    std::array<std::vector<double>, 3> components;
    PeriodicVector out;
    for (std::size_t c = 0; c < components.size(); ++c) {
      for (const Vec3& value : values)
        components[c].push_back(value[static_cast<Eigen::Index>(c)]);
      out.component[c] = of(components[c], moment);
    }
    out.size = size(components, moment);
    return out;
  }

  // Of what components that are not open make, where there are some of both.
  std::optional<PeriodicRange> unique_size(const std::vector<Vec3>& values, const std::array<bool, 3>& open,
                                           bool moment) const {
    const auto count = std::ranges::count(open, true);
    if (count == 0 || count == 3) return std::nullopt;
    std::array<std::vector<double>, 3> components;
    for (std::size_t c = 0; c < components.size(); ++c)
      for (const Vec3& value : values)
        components[c].push_back(open[c] ? 0 : value[static_cast<Eigen::Index>(c)]);
    return size(components, moment);
  }

  // Of a force that acts at all.
  std::optional<PeriodicRange> of_part(const std::vector<double>& values, bool moment) const {
    if (std::ranges::all_of(values, [](double v) { return v == 0; })) return std::nullopt;
    return of(values, moment);
  }

 private:
  PeriodicRange size(const std::array<std::vector<double>, 3>& components, bool moment) const {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < components[0].size(); ++i)
      sizes.push_back(std::hypot(components[0][i], components[1][i], components[2][i]));
    const bool finite = std::ranges::all_of(sizes, [](double v) { return std::isfinite(v); });
    if (finite && std::ranges::all_of(components, [&](const auto& c) { return come_back(c, moment); }))
      return rounded(size_over_period(components), moment);
    return of(sizes, moment); // of what turns with a drive that has no part in the period it may come back
  }
  double small(bool moment) const { return 1e-9 * largest_ * (moment ? reach_ : 1); }
  PeriodicRange rounded(PeriodicRange range, bool moment) const {
    range.error += rounding * largest_ * (moment ? reach_ : 1);
    return range;
  }

  double largest_, reach_; // N, m
};

PeriodicSpring spring_of(const SpringTrack& track, const LoadRanges& ranges) {
  PeriodicSpring out{track.joint, track.index, track.count, track.between_points, track.angle, {},
                     {},          {},          {}};
  out.spring = ranges.of_part(track.spring, track.angle);
  out.damper = ranges.of_part(track.damper, track.angle);
  out.stop = ranges.of_part(track.stop, track.angle);
  if (out.spring.has_value() + out.damper.has_value() + out.stop.has_value() < 2) return out;
  std::vector<double> sum = track.spring;
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] += track.damper[i] + track.stop[i];
  out.sum = ranges.of(sum, track.angle);
  return out;
}

// Of a drive: its torque times the rate of its coordinate, W.
std::vector<double> power_of(const Run& run, const DriveTrack& drive) {
  std::vector<double> out(drive.torque.size(), unknown);
  const auto turning = std::ranges::find_if(run.coordinates, [&](const CoordinateTrack& track) {
    return track.joint == drive.joint && track.index == drive.index;
  });
  if (turning == run.coordinates.end()) return out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = drive.torque[i] * turning->rate[i];
  return out;
}

void fill_loads(const Run& run, PeriodicState& out) {
  const double reach = run.segments.empty() ? 1 : run.segments.front().model->parameters.length;
  const LoadRanges ranges(run, reach);
  for (const DriveTrack& track : run.drives) {
    const bool known = ranges.come_back(track.torque, track.angle);
    const PeriodicRange none{unknown, unknown, unknown, unknown};
    out.drive_torques.push_back({track.joint, track.index, track.count, track.angle,
                                 known ? range_over_period(track.torque) : none,
                                 known ? range_over_period(power_of(run, track)) : none});
  }
  for (const ReactionTrack& track : run.reactions)
    out.reactions.push_back({track.joint, ranges.of(track.force, false), ranges.of(track.torque, true)});
  for (const BearingTrack& track : run.bearings)
    out.bearings.push_back({track.bearing, ranges.of(track.force, false), ranges.of(track.torque, true)});
  for (const GearTrack& track : run.gears)
    out.gears.push_back({track.joint, track.angle_a, track.angle_b, ranges.of(track.a, track.angle_a),
                         ranges.of(track.b, track.angle_b)});
  for (const SpringTrack& track : run.springs)
    if (PeriodicSpring spring = spring_of(track, ranges); spring.spring || spring.damper || spring.stop)
      out.springs.push_back(std::move(spring));
}

// What a measure is compared with is not known, so its own size is: one that stays where it is may drift by
// what steps leave.
PeriodicRange range_of_measure(std::span<const double> values) {
  double size = 0;
  for (const double value : values)
    size = std::max(size, std::abs(value));
  if (!comes_back(values, 1e-6 * size)) return {unknown, unknown, unknown, unknown};
  PeriodicRange out = range_over_period(values);
  out.error += std::abs(values.back() - values.front());
  return out;
}

bool jumps(const CoordinateTrack& track) { // a rotation vector that turns over
  for (std::size_t i = 1; track.rotation && i < track.value.size(); ++i)
    if (std::abs(track.value[i] - track.value[i - 1]) > 3) return true;
  return false;
}

} // namespace

PeriodicRange range_over_period(std::span<const double> values) {
  if (std::ranges::any_of(values, [](double v) { return !std::isfinite(v); }))
    return {unknown, unknown, unknown, unknown};
  PeriodicRange out = range_with(values, 1);
  const double size = std::max(std::abs(out.least), std::abs(out.most));
  out.error = largest_difference(out, range_with(values, 2)) + rounding * size;
  return out;
}

PeriodicRange size_over_period(const std::array<std::vector<double>, 3>& components) {
  PeriodicRange out = size_with(components, 1);
  out.error = largest_difference(out, size_with(components, 2)) + rounding * out.most;
  return out;
}

void fill_ranges(const Run& run, PeriodicState& out) {
  for (const CoordinateTrack& track : run.coordinates) {
    if (track.driven) continue;
    PeriodicCoordinate c{track.joint, track.index, track.count, track.angle, track.dependent,
                         track.scale, 0,           {},          {}};
    if (jumps(track)) {
      c.range = c.rate = {unknown, unknown, unknown, unknown};
    } else {
      c.advance = advance_of(track);
      std::vector<double> values = track.value;
      if (c.goes_on() && c.angle) // from within half a turn on
        for (double& value : values)
          value -= track.value.front() - std::remainder(track.value.front(), 2 * std::numbers::pi);
      c.range = range_without(std::move(values), c.advance);
      c.range.error += rounding * std::abs(c.advance); // of what was taken off
      c.rate = range_over_period(track.rate);
    }
    out.coordinates.push_back(std::move(c));
  }
  fill_loads(run, out);
  for (const MeasureTrack& track : run.measures)
    out.measures.push_back({track.name, track.unit, range_of_measure(track.value)});
}

void fill_unique_sizes(const Run& run, const PeriodicState& open, PeriodicState& out) {
  if (std::ranges::none_of(open.reactions, &PeriodicReaction::nonunique)) return;
  const LoadRanges ranges(run, run.segments.front().model->parameters.length);
  for (std::size_t i = 0; i < out.reactions.size(); ++i) {
    const ReactionTrack& track = run.reactions[i];
    const PeriodicReaction& of = open.reactions[i];
    out.reactions[i].force.unique_size = ranges.unique_size(track.force, of.force.open, false);
    out.reactions[i].torque.unique_size = ranges.unique_size(track.torque, of.torque.open, true);
  }
}

void compare_ranges(const PeriodicState* other, PeriodicState& out) {
  const auto compare_all = [&](const auto& theirs, auto& ours, auto range) {
    for (std::size_t i = 0; i < ours.size(); ++i)
      std::invoke(range, ours[i]).error +=
          other ? largest_difference(std::invoke(range, theirs[i]), std::invoke(range, ours[i])) : unknown;
  };
  const PeriodicState none;
  const PeriodicState& there = other ? *other : none;
  compare_all(there.coordinates, out.coordinates, &PeriodicCoordinate::range);
  compare_all(there.coordinates, out.coordinates, &PeriodicCoordinate::rate);
  compare_all(there.drive_torques, out.drive_torques, &PeriodicTorque::range);
  compare_all(there.drive_torques, out.drive_torques, &PeriodicTorque::power);
  for (const auto list : {&PeriodicState::reactions, &PeriodicState::bearings})
    for (const auto vector : {&PeriodicReaction::force, &PeriodicReaction::torque}) {
      compare_all(
          there.*list, out.*list, [&](auto& of) -> auto& { return (of.*vector).size; });
      for (std::size_t c = 0; c < 3; ++c)
        compare_all(
            there.*list, out.*list, [&](auto& of) -> auto& { return (of.*vector).component[c]; });
    }
  compare_all(there.gears, out.gears, &PeriodicGear::a);
  compare_all(there.gears, out.gears, &PeriodicGear::b);
  compare_all(there.measures, out.measures, &PeriodicMeasure::range);
  // What does not act in the other one is zero there.
  const auto compare_parts = [&](const std::optional<PeriodicRange>& theirs,
                                 std::optional<PeriodicRange>& ours) {
    if (ours) ours->error += other ? largest_difference(theirs.value_or(PeriodicRange{}), *ours) : unknown;
  };
  for (std::size_t i = 0; i < out.reactions.size(); ++i)
    for (const auto vector : {&PeriodicReaction::force, &PeriodicReaction::torque})
      compare_parts(other ? (there.reactions[i].*vector).unique_size : std::nullopt,
                    (out.reactions[i].*vector).unique_size);
  for (PeriodicSpring& spring : out.springs) {
    const auto same = std::ranges::find_if(there.springs, [&](const PeriodicSpring& s) {
      return s.between_points == spring.between_points && s.joint == spring.joint && s.index == spring.index;
    });
    for (const auto part :
         {&PeriodicSpring::spring, &PeriodicSpring::damper, &PeriodicSpring::stop, &PeriodicSpring::sum})
      compare_parts(same != there.springs.end() ? (*same).*part : std::nullopt, spring.*part);
  }
}

} // namespace flyball
