// The film of a run or of a mode that is asked for, and how far it is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace flyball {

enum class Filmed { run, mode };

struct MovieRequest {
  Filmed of = Filmed::run;
  std::filesystem::path file;
  int width = 1280, height = 720; // pixels
  double rate = 30;               // frames a second
  double factor = 1;              // seconds of the run shown a second
  double from = 0, to = 0;        // s of the run
  int swings = 1;                 // of the mode
};

struct MovieState {
  Filmed of = Filmed::run; // what the dialog is for
  // As last chosen in the dialog.
  int width = 1280, height = 720;
  double rate = 30, factor = 1;
  bool whole = true;
  double from = 0, to = 0; // s of the run, where not the whole
  int swings = 1;          // of a mode

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
