#include "engine/dynamics/settled.hpp"

#include "engine/dynamics/motion_model.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
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

// What of a sample is farthest from a steady state.
struct Farthest {
  double scaled = 0; // see distance_from()
  const CoordinateTrack* track = nullptr;
  double away = 0; // rad or m; of a speed a second
  bool speed = false;
};

Farthest farthest_from(const Run& run, std::size_t sample, const Solution& steady) {
  const Farthest unlike{.scaled = std::numeric_limits<double>::infinity()};
  if (run.segments.empty() || steady.coordinates.size() != run.coordinates.size()) return unlike;
  Farthest worst;
  const auto take = [&](const CoordinateTrack& track, double away, double size, bool speed) {
    if (away > 0 && !(away / size <= worst.scaled)) worst = {away / size, &track, away, speed};
  };
  for (std::size_t i = 0; i < run.coordinates.size(); ++i) {
    const CoordinateTrack& track = run.coordinates[i];
    const CoordinateSolution& there = steady.coordinates[i];
    if (track.joint != there.joint || track.index != there.index) return unlike;
    if (there.speed && !track.driven)
      take(track, std::abs(track.rate[sample] - *there.speed),
           std::max(std::abs(*there.speed), largest_rate(track)), true);
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
      take(track, log_rotation<double>(turn).norm(), 1, false);
      i += 2;
      continue;
    }
    double away = track.value[sample] - there.value;
    if (track.turns) away = std::remainder(away, 2 * std::numbers::pi);
    take(track, std::abs(away), track.scale, false);
  }
  return worst;
}

std::string words(const Farthest& farthest) {
  if (!farthest.track) return "it is the direct solution";
  const std::string name =
      farthest.track->rotation ? farthest.track->joint : coordinate_label(*farthest.track);
  const std::string unit = (farthest.track->angle ? "rad" : "m") + std::string(farthest.speed ? "/s" : "");
  return name + " is " + rounded_text(farthest.away, 2) + " " + unit + " from the direct solution";
}

std::optional<FarCoordinate> coordinate_of(const Farthest& farthest) {
  if (!farthest.track) return std::nullopt;
  const CoordinateTrack& track = *farthest.track;
  FarCoordinate out{track.joint, track.index, track.count, track.angle, farthest.speed, farthest.away};
  if (track.rotation) out.index = 0, out.count = 1;
  return out;
}

} // namespace

double distance_from(const Run& run, std::size_t sample, const Solution& steady) {
  return farthest_from(run, sample, steady).scaled;
}

bool runs_into(const Run& run, const Solution& steady, const Solution& other) {
  constexpr double near = 0.05, by_far = 0.1, same = 1e-3;
  if (run.time.empty() || other.status != Status::converged || other.stable == false) return false;
  const std::size_t last = run.time.size() - 1;
  const double away = distance_from(run, last, other), from_steady = distance_from(run, last, steady);
  if (!std::isfinite(from_steady)) return false; // of another mechanism
  return away < near && away < by_far * from_steady && from_steady > same;
}

Settled find_settled(const Run& run, const Solution& steady, double within) {
  Settled out;
  out.within = within;
  if (run.time.empty() || steady.status != Status::converged) {
    out.message = "There is no steady state to settle in.";
    return out;
  }
  const Farthest farthest = farthest_from(run, run.time.size() - 1, steady);
  out.distance = farthest.scaled;
  out.farthest = coordinate_of(farthest);
  std::size_t first = run.time.size();
  while (first > 0) {
    const double away = distance_from(run, first - 1, steady);
    if (!(away <= within)) break;
    --first;
  }
  const std::string distance = words(farthest);
  if (first == run.time.size() && is_held(run)) {
    out.held = true;
    out.message = "Friction holds it where it has come to rest: " + distance + ".";
    return out;
  }
  if (first == run.time.size()) {
    out.message =
        "Not settled after " + rounded_text(run.time.back() - run.time.front(), 4) + " s: " + distance + ".";
    return out;
  }
  out.time = run.time[first] - run.time.front();
  out.message = "Settled after " + rounded_text(*out.time, 4) + " s; at the end " + distance + ".";
  return out;
}

} // namespace flyball
