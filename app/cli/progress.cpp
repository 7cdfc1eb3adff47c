#include "app/cli/progress.hpp"

#include "app/platform/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>

namespace flyball::cli {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

ProgressBar::ProgressBar(const char* phase) : phase_(phase) {
  if (!terminal_columns()) return;
  thread_ = std::jthread([this](const std::stop_token& stop) {
    const auto begin = Clock::now();
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    auto wait = std::chrono::milliseconds(1000);
    while (!wake.wait_for(lock, stop, wait, [&] { return stop.stop_requested(); })) {
      draw(std::chrono::duration<double>(Clock::now() - begin).count());
      wait = std::chrono::milliseconds(100);
    }
  });
}

ProgressBar::~ProgressBar() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

void ProgressBar::show(const Progress& now) {
  phase_ = now.phase;
  part_ = now.part;
  all_ = 0;
}

void ProgressBar::show(const char* phase, std::size_t done, std::size_t all) {
  phase_ = phase;
  part_ = all > 0 ? static_cast<double>(done) / static_cast<double>(all) : -1;
  done_ = done;
  all_ = all;
}

void ProgressBar::draw(double seconds) {
  const double part = part_;
  const std::size_t all = all_;
  std::string text;
  if (all > 0)
    text = fmt::format("{} of {}, ", std::min(done_.load(), all), all);
  else if (part >= 0)
    text = fmt::format("{:.0f} %, ", std::floor(100 * std::min(part, 1.)));
  text += fmt::format("{:.0f} s", std::floor(seconds));
  std::string line(phase_.load());
  const int room = terminal_columns().value_or(80) - static_cast<int>(line.size() + text.size()) - 6;
  if (part >= 0 && room >= 10) {
    const int width = std::min(room, 40);
    const int filled = std::clamp(static_cast<int>(part * width), 0, width);
    line += fmt::format(" [{:=<{}}{:{}}]", "", filled, "", width - filled);
  }
  // One write, so that nothing else on the terminal comes between.
  fmt::print(stderr, "{}", fmt::format("\r{} {}\033[K", line, text));
  std::fflush(stderr);
  drawn_ = true;
}

} // namespace flyball::cli
