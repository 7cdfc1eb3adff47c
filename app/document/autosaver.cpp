#include "app/document/autosaver.hpp"

#include "app/document/autosave.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double soon = 0.1; // s, while something is being written

} // namespace

void Autosaver::collect() {
  if (!writing_.valid()) return;
  Outcome outcome = writing_.get();
  if (outcome.problem.empty()) {
    std::error_code ignored;
    if (!path_.empty() && path_ != outcome.path) fs::remove(path_, ignored); // older
    path_ = std::move(outcome.path);
    return;
  }
  problem_ = std::move(outcome.problem);
  written_ = 0;
  hold_ = retry;
}

void Autosaver::wait() {
  collect();
}

void Autosaver::tick(const Document& document, bool to_lose, std::uint64_t based_on,
                     const AutosaveSettings& settings, double seconds) {
  due_ = never;
  if (settings.state_folder.empty()) return;
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
  start(document, based_on, settings);
  due_ = soon;
}

void Autosaver::start(const Document& document, std::uint64_t based_on, const AutosaveSettings& settings) {
  written_ = document.stored_revision();
  still_ = waited_ = 0;
  // Turning thousands of bodies into text and waiting for the disk is nothing for the thread of the
  // interface.
  writing_ = std::async(std::launch::async,
                        [mechanism = document.steps()[document.position()].mechanism, file = document.file(),
                         based_on, settings, path = path_]() -> Outcome {
                          Outcome outcome;
                          try {
                            Autosave autosave{.file = file,
                                              .name = mechanism->name,
                                              .based_on = based_on,
                                              .owner = settings.owner,
                                              .made = static_cast<std::int64_t>(std::time(nullptr)),
                                              .scene = write_scene(*mechanism)};
                            const std::string text = write_autosave(autosave);
                            std::vector<fs::path> places = autosave_places(file, settings.state_folder);
                            if (!path.empty()) places.insert(places.begin(), path);
                            for (const fs::path& place : places) {
                              try {
                                if (place.parent_path() != file.parent_path())
                                  fs::create_directories(place.parent_path());
                                write_bytes(place, text);
                                return {.path = place, .problem = {}};
                              } catch (const std::exception& error) {
                                outcome.problem = error.what();
                              }
                            }
                          } catch (const std::exception& error) {
                            outcome.problem = error.what();
                          }
                          return outcome;
                        });
}

void Autosaver::remove() {
  collect();
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
  *this = {};
}

bool Autosaver::adopt(const fs::path& leftover, const fs::path& file, const AutosaveSettings& settings) {
  remove();
  path_ = leftover;
  std::error_code failed;
  for (const fs::path& place : autosave_places(file, settings.state_folder)) {
    if (place.parent_path() != leftover.parent_path()) continue;
    fs::rename(leftover, place, failed);
    if (!failed) path_ = place;
  }
  if (fs::exists(path_, failed)) return true;
  path_.clear();
  return false;
}

} // namespace flyball
