#include "app/cli/movie.hpp"

#include "app/cli/progress.hpp"
#include "app/platform/end_signals.hpp"
#include "app/render/offscreen.hpp"
#include "app/ui/studies/motion/run_movie.hpp"
#include "engine/mechanism/error.hpp"

#include <limits>

namespace flyball::cli {

namespace {

MovieFormat format_of(const MovieOptions& options, std::size_t frames) {
  return {options.width, options.height, options.rate, frames};
}

// Sees all of it, from the direction the scene asks for.
ViewCamera camera_for(const Mechanism& mechanism, RunScene& scene, const std::vector<double>& times,
                      const MovieOptions& options) {
  const ViewSize size{static_cast<double>(options.width), static_cast<double>(options.height)};
  const Bounds bounds = scene.bounds(times);
  ViewCamera camera = initial_camera(mechanism, bounds, size);
  camera.fit(bounds, size);
  return camera;
}

} // namespace

void check_movie(const MovieOptions& options, double duration) {
  const double frames = duration / options.factor * options.rate + 1;
  const auto count = frames < static_cast<double>(most_movie_frames) ? static_cast<std::size_t>(frames)
                                                                     : most_movie_frames + 1;
  if (const std::string problem = movie_problem(options.file, format_of(options, count)); !problem.empty())
    throw SceneError("--movie " + options.file.string(), problem);
}

void draw_movie(const Mechanism& mechanism, std::shared_ptr<const Run> run,
                const std::optional<Solution>& steady, const MovieOptions& options) {
  const OffscreenContext context;
  ViewRenderer renderer;
  const std::vector<double> times =
      movie_times(*run, {run->time.front(), run->time.back(), options.rate, options.factor});
  RunScene scene(std::make_shared<const Mechanism>(mechanism), std::move(run), steady);
  ViewFrame look;
  look.camera = camera_for(mechanism, scene, times, options);
  const EndSignalsPutOff signals;
  ProgressBar progress("drawing");
  RunMovie movie(std::move(scene), times, options.file, format_of(options, times.size()), look, 4);
  constexpr double between_signals = 0.1; // s
  while (!EndSignalsPutOff::came_one() && !movie.step(renderer, between_signals))
    progress.show("drawing", movie.drawn(), movie.frames());
}

} // namespace flyball::cli
