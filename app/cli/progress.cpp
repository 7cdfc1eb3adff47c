#include "app/cli/progress.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace flyball::cli {

Progress::Progress(std::string what)
    : what_(std::move(what)), start_(std::chrono::steady_clock::now()),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(std::size_t done, std::size_t all) {
  if (!terminal_ || all == 0 || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
  constexpr std::size_t width = 40;
  const std::size_t filled = done * width / all;
  fmt::print(stderr, "\r{} [{:=<{}}{:{}}] {} of {}", what_, "", filled, "", width - filled, done, all);
  std::fflush(stderr);
  drawn_ = true;
}

} // namespace flyball::cli
