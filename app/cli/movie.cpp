#include "app/cli/movie.hpp"

#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/platform/end_signals.hpp"
#include "app/render/offscreen.hpp"
#include "engine/mechanism/error.hpp"

#include <CLI/CLI.hpp>

#include <utility>

namespace flyball::cli {

namespace {

MovieFormat format_of(const MovieOptions& options, std::size_t frames) {
  return {options.width, options.height, options.rate, frames};
}

// Sees all of it, from the direction the scene asks for.
ViewCamera camera_for(const Mechanism& mechanism, FilmedScene& scene, const std::vector<double>& moments,
                      const MovieOptions& options) {
  const ViewSize size{static_cast<double>(options.width), static_cast<double>(options.height)};
  const Bounds seen = bounds(scene, moments);
  ViewCamera camera = initial_camera(mechanism, seen, size);
  camera.fit(seen, size);
  return camera;
}

} // namespace

void check_movie(const MovieOptions& options, double frames) {
  const auto count = frames < static_cast<double>(most_movie_frames) ? static_cast<std::size_t>(frames)
                                                                     : most_movie_frames + 1;
  if (const std::string problem = movie_problem(options.file, format_of(options, count)); !problem.empty())
    throw SceneError("--movie " + options.file.string(), problem);
}

void draw_movie(const Mechanism& mechanism, std::unique_ptr<FilmedScene> scene,
                const std::vector<double>& moments, const MovieOptions& options) {
  const OffscreenContext context;
  ViewRenderer renderer;
  ViewFrame look;
  look.camera = camera_for(mechanism, *scene, moments, options);
  const EndSignalsPutOff signals;
  ProgressBar progress("drawing");
  Film film(std::move(scene), moments, options.file, format_of(options, moments.size()), look, 4);
  constexpr double between_signals = 0.1; // s
  while (!EndSignalsPutOff::came_one() && !film.step(renderer, between_signals))
    progress.show("drawing", film.drawn(), film.frames());
}

void add_movie_look(CLI::App& command, CLI::Option* movie, std::string& size, MovieOptions& options) {
  command.add_option("--size", size, "Pixels of the film")->needs(movie)->capture_default_str();
  command.add_option("--fps", options.rate, "Frames a second of the film")
      ->check(above_zero())
      ->needs(movie)
      ->capture_default_str();
}

} // namespace flyball::cli
