#include "engine/dynamics/settled.hpp"

#include "engine/dynamics/motion_model.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

// Of the run, rad/s or m/s: what a speed of zero is small beside.
double largest_rate(const CoordinateTrack& track) {
  double largest = 0;
  for (const double rate : track.rate)
    largest = std::max(largest, std::abs(rate));
  return largest;
}

// Whether at the last sample nothing moves that no drive does, and friction may be what holds it.
bool is_held(const Run& run) {
  if (run.segments.empty() || !has_friction(run.segments.back().model->mechanism)) return false;
  return std::ranges::all_of(run.coordinates, [](const CoordinateTrack& track) {
    return track.driven || std::abs(track.rate.back()) <= 1e-9 * std::max(largest_rate(track), 1e-3);
  });
}

} // namespace

double distance_from(const Run& run, std::size_t sample, const Solution& steady) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (run.segments.empty() || steady.coordinates.size() != run.coordinates.size()) return infinity;
  double worst = 0;
  for (std::size_t i = 0; i < run.coordinates.size(); ++i) {
    const CoordinateTrack& track = run.coordinates[i];
    const CoordinateSolution& there = steady.coordinates[i];
    if (track.joint != there.joint || track.index != there.index) return infinity;
    if (there.speed && !track.driven) {
      const double away = std::abs(track.rate[sample] - *there.speed);
      if (away > 0) worst = std::max(worst, away / std::max(std::abs(*there.speed), largest_rate(track)));
    }
    if (track.driven || there.driven ||
        std::ranges::find(steady.neutral, track.joint) != steady.neutral.end())
      continue;
    if (track.rotation) { // three components together, as the turn between the two
      Vec3 a, b;
      for (std::size_t k = 0; k < 3; ++k) {
        a[static_cast<Eigen::Index>(k)] = run.coordinates[i + k].value[sample];
        b[static_cast<Eigen::Index>(k)] = steady.coordinates[i + k].value;
      }
      const Quat turn = exp_rotation<double>(a) * exp_rotation<double>(b).conjugate();
      worst = std::max(worst, log_rotation<double>(turn).norm());
      i += 2;
      continue;
    }
    double away = track.value[sample] - there.value;
    if (track.turns) away = std::remainder(away, 2 * std::numbers::pi);
    worst = std::max(worst, std::abs(away) / track.scale);
  }
  return worst;
}

Settled find_settled(const Run& run, const Solution& steady, double within) {
  Settled out;
  out.within = within;
  if (run.time.empty() || steady.status != Status::converged) {
    out.message = "There is no steady state to settle in.";
    return out;
  }
  std::size_t first = run.time.size();
  while (first > 0) {
    const double away = distance_from(run, first - 1, steady);
    if (first == run.time.size()) out.distance = away;
    if (!(away <= within)) break;
    --first;
  }
  const std::string distance =
      rounded_text(out.distance, 2) + " (rad, or parts of the reach) from the direct solution";
  if (first == run.time.size() && is_held(run)) {
    out.message = "Friction holds it where it has come to rest, " + distance + ".";
    return out;
  }
  if (first == run.time.size()) {
    out.message =
        "Not settled after " + rounded_text(run.time.back() - run.time.front(), 4) + " s: " + distance + ".";
    return out;
  }
  out.time = run.time[first] - run.time.front();
  out.message = "Settled after " + rounded_text(*out.time, 4) + " s, " + distance + ".";
  return out;
}

} // namespace flyball
