// The film of a run that is asked for, and how far it is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace flyball {

struct MovieRequest {
  std::filesystem::path file;
  int width = 1280, height = 720; // pixels
  double rate = 30;               // frames a second
  double factor = 1;              // seconds of the run shown a second
  double from = 0, to = 0;        // s of the run
};

struct MovieState {
  // As last chosen in the dialog.
  int width = 1280, height = 720;
  double rate = 30, factor = 1;
  bool whole = true;
  double from = 0, to = 0; // s of the run, where not the whole

  // The dialog asks, whoever draws answers (see movie_export.hpp).
  std::optional<MovieRequest> request; // to be begun
  bool cancel = false;
  struct Progress {
    std::size_t drawn = 0, frames = 0;
  };
  std::optional<Progress> progress; // while it is made
  bool done = false;                // it is in its place
  std::string problem;              // why the last one was not made
};

} // namespace flyball
