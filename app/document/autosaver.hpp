// Keeps the open document's unsaved work in a file of its own, so that a crash costs a few seconds at most.
#pragma once

#include "app/document/autosave_slot.hpp"
#include "app/document/document.hpp"

#include <future>
#include <limits>
#include <utility>

namespace flyball {

class Autosaver {
 public:
  // A pause of the hand after which it is written, and how long it waits where there is none.
  static constexpr double pause = 1, longest = 4; // s
  // After it could not be written.
  static constexpr double retry = 10; // s

  Autosaver() = default;
  // Waits for what is being written; the file stays.
  ~Autosaver() = default;
  Autosaver(Autosaver&&) = default;
  Autosaver& operator=(Autosaver&&) = default;

  // What there is to lose now, for whoever has to write it at once (see slot()); quick.
  void note(const Document& document, bool to_lose, std::uint64_t based_on, const AutosaveSettings& settings);
  // `seconds` after the last call. Where there is something to lose and the time has come it writes in the
  // background; where there is nothing to lose any more it removes the file. `based_on` is the hash of what
  // the document's file holds.
  void tick(const Document& document, bool to_lose, std::uint64_t based_on, const AutosaveSettings& settings,
            double seconds);
  // s until tick() has something to do; infinite while there is nothing new to lose.
  double due_in() const { return due_; }
  // Why it could not be written, once.
  std::string take_problem() { return std::exchange(problem_, {}); }

  // Where it is; empty where nothing is kept. Only what is already written.
  std::filesystem::path path() const { return slot_->path(); }
  // Writes what was noted last, from any thread; lasts as long as this.
  const std::shared_ptr<AutosaveSlot>& slot() const { return slot_; }
  void wait(); // for what is being written
  // Removes the file: the work was saved, or is not wanted.
  void remove();
  // Takes over a leftover, which from now on is this document's; false where somebody else was quicker.
  bool adopt(const std::filesystem::path& leftover, const std::filesystem::path& file,
             const AutosaveSettings& settings);

 private:
  void collect(); // what was being written and no longer is
  void reset();

  std::shared_ptr<AutosaveSlot> slot_ = std::make_shared<AutosaveSlot>();
  std::future<std::string> writing_; // why it could not be
  std::string problem_;
  std::uint64_t seen_ = 0, written_ = 0;     // revisions of the document
  double still_ = 0, waited_ = 0, hold_ = 0; // s: since the last change, since the first, before trying again
  double due_ = std::numeric_limits<double>::infinity();
};

} // namespace flyball
