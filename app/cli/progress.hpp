// A progress bar on standard error, for a person at a terminal who has waited for over a second.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace flyball::cli {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress(); // wipes the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::size_t done, std::size_t all);

 private:
  std::string what_;
  std::chrono::steady_clock::time_point start_;
  bool terminal_, drawn_ = false;
};

} // namespace flyball::cli
