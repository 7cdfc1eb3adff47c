// A mode swinging about the steady state, for a film.
#pragma once

#include "app/ui/studies/film.hpp"
#include "engine/stability/modes.hpp"

#include <memory>
#include <string>
#include <vector>

namespace flyball {

// The phases (rad) that frames show, `rate` of them a second as long as the mode is shown to swing, see
// shown_period(); the frame after the last would be the first again. At most most_movie_frames + 1.
std::vector<double> swing_phases(const VibrationMode& mode, double rate, int swings);

// Moments are phases of the mode. The steady state is solid, the mode amber.
class ModeScene : public FilmedScene {
 public:
  // `amplitude` as of Analysis::mode_poses(); the drives stand `time` (s) on. Throws SceneError, also where
  // the steady state is not found again.
  ModeScene(std::shared_ptr<const Mechanism> mechanism, const Solution& steady, VibrationMode mode,
            double amplitude, double time);

  ViewFrame frame(double moment, const ViewFrame& look) override;

 private:
  std::shared_ptr<const Mechanism> mechanism_;
  Analysis analysis_;
  VibrationMode mode_;
  double amplitude_, time_;
  std::vector<std::string> cut_joints_;
  std::vector<Pose> steady_, swung_;
};

} // namespace flyball
