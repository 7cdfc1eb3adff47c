// The open mechanism with its past: every edit is a step that can be undone, and the document knows what of
// it is in its file.
#pragma once

#include "app/document/part.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// A state of the mechanism and what led to it.
struct Step {
  std::string name; // "Move ball 1"
  std::shared_ptr<const Mechanism> mechanism;
  Selection selection;       // after the edit
  std::uint64_t gesture = 0; // the hand's movement it belongs to; 0: an edit at one blow
};

class Document {
 public:
  // Nothing in it: the ease of a new drawing. `file` is empty for a document without one.
  explicit Document(Mechanism mechanism = empty_mechanism(), std::filesystem::path file = {});

  const Mechanism& mechanism() const { return *steps_[position_].mechanism; }
  const Selection& selection() const { return selection_; }
  const std::filesystem::path& file() const { return file_; }
  // What is in the file; for a document without one, what it began as.
  const Mechanism& saved() const { return *saved_; }
  bool unsaved() const { return unsaved_; } // whether it differs from what is in the file
  // Rises whenever the mechanism may have changed.
  std::uint64_t revision() const { return revision_; }

  // A new state. An edit of the same gesture (not 0) and name as the last one takes its place in the history,
  // so that a drag is one step. No step where nothing changes. Redo is lost, as everywhere.
  void edit(std::string name, Mechanism next, Selection selection, std::uint64_t gesture = 0);
  // Selecting is no step.
  void select(Selection selection);

  bool can_undo() const { return position_ > 0; }
  bool can_redo() const { return position_ + 1 < steps_.size(); }
  // False where there is nothing to undo or redo.
  bool undo();
  bool redo();
  // Step 0 is how it was opened. Steps before `position` are done, those after it undone.
  const std::vector<Step>& steps() const { return steps_; }
  std::size_t position() const { return position_; }
  void go_to(std::size_t step);

  // The present state is what is in the file.
  void mark_saved(std::filesystem::path file);
  // A state that came back from an autosave: unsaved from the start, over what the file says.
  void recover(Mechanism mechanism);

  // No bodies, the earth's gravity along -y.
  static Mechanism empty_mechanism();
  // Steps kept; the oldest are dropped.
  static constexpr std::size_t most_steps = 1000;

 private:
  void compare();

  std::vector<Step> steps_;
  std::size_t position_ = 0;
  Selection selection_;
  std::filesystem::path file_;
  std::shared_ptr<const Mechanism> saved_;
  std::uint64_t revision_ = 1;
  bool unsaved_ = false;
};

} // namespace flyball
