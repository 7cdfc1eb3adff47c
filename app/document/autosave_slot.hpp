// Where a document's unsaved work is kept, written by whichever thread gets there first: in the background as
// it changes, or by the one that notices that the program is about to end.
#pragma once

#include "app/document/body_hues.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Where it is kept and on whose behalf.
struct AutosaveSettings {
  std::filesystem::path state_folder; // empty: nothing is kept anywhere
  std::string owner;                  // see process.hpp
};

// What there is to lose.
struct UnsavedWork {
  std::shared_ptr<const Mechanism> mechanism;
  std::filesystem::path file; // of the document; empty for one without
  std::uint64_t based_on = 0; // text_hash of what the file holds
  AutosaveSettings settings;
  std::shared_ptr<const BodyHues> hues{}; // of its bodies
};

// All functions may be called from any thread.
class AutosaveSlot {
 public:
  // The newest work, or none; quick.
  void expect(std::optional<UnsavedWork> work);
  // Writes what is expected, unless it is there already; waits for another thread that is writing. Returns
  // why it could not.
  std::string write();
  // Nothing is to be lost any more: removes the file.
  void remove();
  // This file is its place from now on.
  void take_over(const std::filesystem::path& path);
  // Where it is; empty where nothing is kept.
  std::filesystem::path path() const;

 private:
  mutable std::mutex work_mutex_; // of work_, path_ and former_, for moments
  std::mutex writing_;            // while the disk is waited for; taken before work_mutex_
  std::optional<UnsavedWork> work_;
  std::shared_ptr<const Mechanism> written_;
  std::filesystem::path path_;
  std::vector<std::filesystem::path> former_; // places before: one whose folder was away is removed later
};

} // namespace flyball
