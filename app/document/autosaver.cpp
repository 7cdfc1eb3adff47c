#include "app/document/autosaver.hpp"

#include "app/document/autosave.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double soon = 0.1; // s, while something is being written

} // namespace

void Autosaver::collect() {
  if (!writing_.valid()) return;
  problem_ = writing_.get();
  if (problem_.empty()) return;
  written_ = 0;
  hold_ = retry;
}

void Autosaver::wait() {
  collect();
}

void Autosaver::note(const Document& document, bool to_lose, std::uint64_t based_on,
                     const AutosaveSettings& settings) {
  if (settings.state_folder.empty() || !to_lose) return slot_->expect(std::nullopt);
  const Step& now = document.steps()[document.position()];
  slot_->expect(UnsavedWork{.mechanism = now.mechanism,
                            .file = document.file(),
                            .based_on = based_on,
                            .settings = settings,
                            .hues = now.hues});
}

void Autosaver::tick(const Document& document, bool to_lose, std::uint64_t based_on,
                     const AutosaveSettings& settings, double seconds) {
  due_ = never;
  if (settings.state_folder.empty()) return;
  note(document, to_lose, based_on, settings);
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      due_ = soon;
      waited_ += seconds;
      return;
    }
    collect();
  }
  if (!to_lose) return remove();
  if (document.stored_revision() == written_) return;
  still_ = document.stored_revision() == seen_ ? still_ + seconds : 0;
  waited_ += seconds;
  hold_ -= seconds;
  seen_ = document.stored_revision();
  due_ = std::max({0., std::min(pause - still_, longest - waited_), hold_});
  if (due_ > 0) return;
  due_ = soon;
  // Turning thousands of bodies into text and waiting for the disk is nothing for the thread of the
  // interface.
  try {
    writing_ = std::async(std::launch::async, [slot = slot_] { return slot->write(); });
  } catch (const std::system_error&) { // no thread is to be had now
    return;
  }
  written_ = document.stored_revision();
  still_ = waited_ = 0;
}

void Autosaver::reset() {
  collect();
  problem_.clear();
  seen_ = written_ = 0;
  still_ = waited_ = hold_ = 0;
  due_ = never;
}

void Autosaver::remove() {
  reset();
  slot_->remove();
}

bool Autosaver::adopt(const fs::path& leftover, const fs::path& file, const AutosaveSettings& settings) {
  remove();
  fs::path path = leftover;
  std::error_code failed;
  for (const fs::path& place : autosave_places(file, settings.state_folder)) {
    if (place.parent_path() != leftover.parent_path()) continue;
    fs::rename(leftover, place, failed);
    if (!failed) path = place;
  }
  if (!fs::exists(path, failed)) return false;
  slot_->take_over(path);
  return true;
}

} // namespace flyball
