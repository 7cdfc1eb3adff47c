// A film of a run or of a mode, drawn off-screen.
#pragma once

#include "app/ui/studies/film.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace flyball::cli {

struct MovieOptions {
  std::filesystem::path file;     // its ending decides: .png, .gif, .mp4
  int width = 1280, height = 720; // pixels
  double rate = 30;               // frames a second
};

// Throws SceneError where the film could not be made for other reasons than what it shows, before that is
// computed; `frames`: about how many.
void check_movie(const MovieOptions& options, double frames);

// The scene at these moments, from where all of it is seen. Throws SceneError, and GlError where nothing can
// be drawn. A signal to end (SIGINT, SIGTERM, SIGHUP) ends the program as ever, but leaves nothing of the
// film behind.
void draw_movie(const Mechanism& mechanism, std::unique_ptr<FilmedScene> scene,
                const std::vector<double>& moments, const MovieOptions& options);

// The options --size and --fps of a film that `movie` names; `size` is read by read_size().
void add_movie_look(CLI::App& command, CLI::Option* movie, std::string& size, MovieOptions& options);

} // namespace flyball::cli
