#include "app/ui/studies/modes/mode_movie.hpp"

#include "app/session/modes.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace flyball {

namespace {

Analysis standing_at(std::shared_ptr<const Mechanism> mechanism, const Solution& steady) {
  std::optional<Analysis> found = analysis_at(std::move(mechanism), steady);
  if (!found) throw SceneError("", "the steady state of the mode was not found again");
  return std::move(*found);
}

} // namespace

std::vector<double> swing_phases(const VibrationMode& mode, double rate, int swings) {
  // Whole frames a swing, so that a film that begins again goes on.
  const double wanted = std::max(2., std::round(shown_period(mode) * rate));
  const double most = std::min(wanted * swings, static_cast<double>(most_movie_frames) + 1);
  std::vector<double> phases;
  for (std::size_t i = 0; static_cast<double>(i) < most; ++i)
    phases.push_back(2 * std::numbers::pi * static_cast<double>(i) / wanted);
  return phases;
}

ModeScene::ModeScene(std::shared_ptr<const Mechanism> mechanism, const Solution& steady, VibrationMode mode,
                     double amplitude, double time)
    : mechanism_(std::move(mechanism)), analysis_(standing_at(mechanism_, steady)), mode_(std::move(mode)),
      amplitude_(amplitude), time_(time), cut_joints_(analysis_.summary().cut_joints),
      steady_(analysis_.poses_at(time)) {}

ViewFrame ModeScene::frame(double moment, const ViewFrame& look) {
  ViewFrame frame = look;
  frame.mechanism = mechanism_.get();
  frame.cut_joints = cut_joints_;
  frame.ghost = {};
  frame.poses = steady_;
  swung_ = analysis_.mode_poses(mode_, amplitude_, moment, time_);
  frame.motion = swung_;
  return frame;
}

} // namespace flyball
