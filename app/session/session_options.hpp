// What a session is opened with.
#pragma once

#include "app/live/background_worker.hpp"
#include "app/session/number_text.hpp"

#include <filesystem>
#include <functional>

namespace flyball {

struct SessionOptions {
  BackgroundWorker::Mode mode = BackgroundWorker::Mode::background;
  std::function<void()> on_news{}; // from the background thread; see BackgroundWorker
  std::filesystem::path scenes{};  // the shipped scenes; may be empty
  NumberStyle numbers{};
  std::filesystem::path state{}; // folder for recent files and autosaves; empty: nothing is kept anywhere
};

} // namespace flyball
