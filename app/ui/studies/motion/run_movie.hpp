// The damped motion beside the steady state, for a film.
#pragma once

#include "app/ui/studies/film.hpp"
#include "engine/dynamics/simulation.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Which part of a run, and how fast.
struct MovieTiming {
  double from = 0, to = 0; // s of the run, clipped to it
  double rate = 30;        // frames a second
  double factor = 1;       // seconds of the run shown a second; below one is slow motion
};

// The moments of the run (s) that frames show. At most most_movie_frames + 1.
std::vector<double> movie_times(const Run& run, const MovieTiming& timing);

// Moments are seconds of the run.
class RunScene : public FilmedScene {
 public:
  // `steady` is the steady state to show; nothing where there is none: then the motion is shown solid. Throws
  // SceneError.
  RunScene(std::shared_ptr<const Mechanism> mechanism, std::shared_ptr<const Run> run,
           const std::optional<Solution>& steady);

  ViewFrame frame(double moment, const ViewFrame& look) override;

 private:
  std::shared_ptr<const Mechanism> mechanism_;
  std::shared_ptr<const Run> run_;
  std::optional<Analysis> analysis_; // that stands at the steady state
  std::vector<std::string> cut_joints_;
  std::vector<Pose> steady_, motion_;
};

} // namespace flyball
