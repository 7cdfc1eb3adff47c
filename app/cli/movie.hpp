// A film of a run, drawn off-screen.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/solve/solution.hpp"

#include <filesystem>
#include <memory>
#include <optional>

namespace flyball::cli {

struct MovieOptions {
  std::filesystem::path file;     // its ending decides: .png, .gif, .mp4
  int width = 1280, height = 720; // pixels
  double rate = 30;               // frames a second
  double factor = 1;              // seconds of the run shown a second; below one is slow motion
};

// Throws SceneError where the film could not be made for other reasons than the run, before that is computed;
// `duration` is the run's (s).
void check_movie(const MovieOptions& options, double duration);

// The steady state solid, where there is one, and the motion in amber, from where all of both is seen. Throws
// SceneError, and GlError where nothing can be drawn. A signal to end (SIGINT, SIGTERM, SIGHUP) ends the
// program as ever, but leaves nothing of the film behind.
void draw_movie(const Mechanism& mechanism, std::shared_ptr<const Run> run,
                const std::optional<Solution>& steady, const MovieOptions& options);

} // namespace flyball::cli
