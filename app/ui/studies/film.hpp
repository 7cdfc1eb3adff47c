// What moves, drawn frame by frame into a film: for the window, between its own frames, and for the command
// line.
#pragma once

#include "app/render/movie.hpp"
#include "app/viewport/view_renderer.hpp"
#include "engine/report/analysis.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace flyball {

// What a film shows. Owns all of it, so that the window may go on to other things.
class FilmedScene {
 public:
  virtual ~FilmedScene() = default;
  // At a moment, looked at as `look` says; refers to this until it is asked again.
  virtual ViewFrame frame(double moment, const ViewFrame& look) = 0;
};

// Of all that is seen at these moments.
Bounds bounds(FilmedScene& scene, const std::vector<double>& moments);

// The same steady state again, ready to be turned; nothing where it is not found. Throws SceneError.
std::optional<Analysis> analysis_at(std::shared_ptr<const Mechanism> mechanism, const Solution& steady);

class Film {
 public:
  // format.frames is that of the moments. Of `look` count the camera, the colours, what is hidden and the
  // options, and the ghost where the scene shows it; forces are not filmed. Throws SceneError.
  Film(std::unique_ptr<FilmedScene> scene, std::vector<double> moments, const std::filesystem::path& file,
       const MovieFormat& format, const ViewFrame& look, int samples);

  // Draws the next frame, or has the film finished, waiting at most `seconds` for ffmpeg; whether it is all
  // done. Needs a current OpenGL context, always the same. Throws SceneError.
  bool step(ViewRenderer& renderer, double seconds);
  std::size_t drawn() const { return drawn_; }
  std::size_t frames() const { return moments_.size(); }

 private:
  std::unique_ptr<FilmedScene> scene_;
  std::vector<double> moments_;
  MovieFormat format_;
  ViewFrame look_;
  std::vector<Pose> ghost_;
  int samples_;
  std::size_t drawn_ = 0;
  std::optional<Framebuffer> target_;
  MovieWriter writer_;
};

} // namespace flyball
