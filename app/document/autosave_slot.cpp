#include "app/document/autosave_slot.hpp"

#include "app/document/autosave.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

#include <ctime>
#include <exception>
#include <utility>
#include <vector>

namespace flyball {

namespace fs = std::filesystem;

void AutosaveSlot::expect(std::optional<UnsavedWork> work) {
  const std::lock_guard lock(work_mutex_);
  work_ = std::move(work);
}

fs::path AutosaveSlot::path() const {
  const std::lock_guard lock(work_mutex_);
  return path_;
}

std::string AutosaveSlot::write() {
  const std::lock_guard writing(writing_);
  std::optional<UnsavedWork> work;
  fs::path former;
  {
    const std::lock_guard lock(work_mutex_);
    work = work_;
    former = path_;
  }
  if (!work || work->settings.state_folder.empty() || (work->mechanism == written_ && !former.empty()))
    return {};
  std::string problem;
  try {
    const std::string text = write_autosave({.file = work->file,
                                             .name = work->mechanism->name,
                                             .based_on = work->based_on,
                                             .owner = work->settings.owner,
                                             .made = static_cast<std::int64_t>(std::time(nullptr)),
                                             .scene = write_scene(*work->mechanism),
                                             .hues = hues_to_keep(*work->mechanism, *work->hues)});
    std::vector<fs::path> places = autosave_places(work->file, work->settings.state_folder);
    if (!former.empty()) places.insert(places.begin(), former);
    for (const fs::path& place : places) {
      try {
        if (place.parent_path() != work->file.parent_path()) fs::create_directories(place.parent_path());
        replace_file(place, text);
      } catch (const std::exception& error) {
        problem = error.what();
        continue;
      }
      std::error_code ignored;
      if (!former.empty() && former != place) fs::remove(former, ignored); // older
      written_ = work->mechanism;
      const std::lock_guard lock(work_mutex_);
      if (!former.empty() && former != place) former_.push_back(former);
      path_ = place;
      return {};
    }
  } catch (const std::exception& error) {
    problem = error.what();
  }
  return problem;
}

void AutosaveSlot::remove() {
  expect(std::nullopt);
  const std::lock_guard writing(writing_);
  written_.reset();
  const std::lock_guard lock(work_mutex_);
  std::error_code ignored;
  former_.push_back(std::exchange(path_, {}));
  for (const fs::path& place : std::exchange(former_, {}))
    if (!place.empty()) fs::remove(place, ignored);
}

void AutosaveSlot::take_over(const fs::path& path) {
  const std::lock_guard writing(writing_);
  written_.reset();
  const std::lock_guard lock(work_mutex_);
  path_ = path;
}

} // namespace flyball
