#include "app/cli/time_limit.hpp"

#include "app/cli/scene_argument.hpp"

#include <algorithm>
#include <chrono>
#include <CLI/CLI.hpp>

namespace flyball::cli {

void add_time_limit(CLI::App& command, double& seconds) {
  command
      .add_option("--time-limit", seconds,
                  "Seconds of computing after which it stops, keeps what it has and exits with 1")
      ->check(above_zero())
      ->capture_default_str();
}

TimeLimit::TimeLimit(double seconds)
    : thread_([this, seconds](const std::stop_token& stop) {
        constexpr double longest = 1e8; // s, within the clock's own range
        std::unique_lock lock(mutex_);
        const auto span = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
            std::chrono::duration<double>(std::min(seconds, longest)));
        wake_.wait_for(lock, stop, span, [] { return false; });
        over_ = !stop.stop_requested();
      }) {}

TimeLimit::~TimeLimit() = default;

} // namespace flyball::cli
