// A film of the damped motion beside the steady state, drawn frame by frame: for the window, between its own
// frames, and for the command line.
#pragma once

#include "app/render/movie.hpp"
#include "app/viewport/view_renderer.hpp"
#include "engine/dynamics/simulation.hpp"
#include "engine/report/analysis.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Which part of a run, how fast, and into what.
struct MovieTiming {
  double from = 0, to = 0; // s of the run, clipped to it
  double rate = 30;        // frames a second
  double factor = 1;       // seconds of the run shown a second; below one is slow motion
};

// The moments of the run (s) that frames show. At most most_movie_frames + 1.
std::vector<double> movie_times(const Run& run, const MovieTiming& timing);

// What is seen. Owns all of it, so that the window may go on to other things.
class RunScene {
 public:
  // `steady` is the steady state to show; nothing where there is none: then the motion is shown solid. Throws
  // SceneError.
  RunScene(std::shared_ptr<const Mechanism> mechanism, std::shared_ptr<const Run> run,
           const std::optional<Solution>& steady);

  // At a moment (s) of the run, looked at as `look` says; refers to this until it is asked again.
  ViewFrame frame(double time, const ViewFrame& look);
  // Of all that is seen at these times.
  Bounds bounds(const std::vector<double>& times);

 private:
  std::shared_ptr<const Mechanism> mechanism_;
  std::shared_ptr<const Run> run_;
  std::optional<Analysis> analysis_; // that stands at the steady state
  std::vector<std::string> cut_joints_;
  std::vector<Pose> steady_, motion_;
};

class RunMovie {
 public:
  // format.frames is that of the times. Of `look` count the camera, the colours, the options and the ghost
  // (see RunScene). Throws SceneError.
  RunMovie(RunScene scene, std::vector<double> times, const std::filesystem::path& file,
           const MovieFormat& format, const ViewFrame& look, int samples);

  // Draws the next frame, or has the film finished, waiting at most `seconds` for ffmpeg; whether it is all
  // done. Needs a current OpenGL context, always the same. Throws SceneError.
  bool step(ViewRenderer& renderer, double seconds);
  std::size_t drawn() const { return drawn_; }
  std::size_t frames() const { return times_.size(); }

 private:
  RunScene scene_;
  std::vector<double> times_;
  MovieFormat format_;
  ViewFrame look_;
  std::vector<Pose> ghost_;
  int samples_;
  std::size_t drawn_ = 0;
  std::optional<Framebuffer> target_;
  MovieWriter writer_;
};

} // namespace flyball
