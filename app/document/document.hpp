// The open mechanism with its past: every edit is a step that can be undone, and the document knows what of
// it is in its file. Numbers that are only tried, while exploring, are steps, too, but change nothing of what
// is stored.
#pragma once

#include "app/document/body_hues.hpp"
#include "app/document/explored.hpp"
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
  Selection selection;                      // after the edit; later, when it was last left
  std::uint64_t gesture = 0;                // the hand's movement it belongs to; 0: an edit at one blow
  Explored explored{};                      // numbers tried beside it
  std::shared_ptr<const Mechanism> tried{}; // the mechanism with them; the same object where there are none
  std::shared_ptr<const BodyHues> hues{};
};

class Document {
 public:
  // Nothing in it: the ease of a new drawing. `file` is empty for a document without one; `hues` are those
  // that its bodies are known by.
  explicit Document(Mechanism mechanism = empty_mechanism(), std::filesystem::path file = {},
                    const NamedHues& hues = {});

  // What is shown and solved: with the numbers that are explored, unless these are put aside.
  const Mechanism& mechanism() const { return *shared(); }
  const std::shared_ptr<const Mechanism>& shared() const { return aside_ ? now().mechanism : now().tried; }
  // What saving writes: without them.
  const Mechanism& stored() const { return *now().mechanism; }
  const Explored& explored() const { return now().explored; }
  const BodyHues& hues() const { return *now().hues; } // of the bodies stored
  BodyColouring colouring() const { return {now().mechanism, now().hues}; }
  const Selection& selection() const { return selection_; }
  const std::filesystem::path& file() const { return file_; }
  // What is in the file; for a document without one, what it began as.
  const Mechanism& saved() const { return *saved_; }
  bool unsaved() const { return unsaved_; } // whether what is stored differs from what is in the file
  // Rises whenever the mechanism may have changed.
  std::uint64_t revision() const { return revision_; }
  // Rises whenever what is stored may have changed.
  std::uint64_t stored_revision() const { return stored_revision_; }

  // A new state. An edit of the same gesture (not 0) and name as the last one takes its place in the history,
  // so that a drag is one step. No step where nothing changes. Redo is lost, as everywhere.
  // `next` is made from what is stored; what is explored stays beside it (see carried_explored). Throws
  // SceneError where expressions give numbers that it has set otherwise (see settle_formulas).
  void edit(std::string name, Mechanism next, Selection selection, std::uint64_t gesture = 0);
  // The same of one number of the mechanism, which is explored no longer; of one that an expression gives,
  // what this rests on changes. Throws SceneError.
  void edit_number(std::string name, const std::string& address, double value, std::uint64_t gesture = 0);
  // A step that only tries other numbers: nothing is unsaved by it. Throws SceneError where expressions can
  // make nothing of them.
  void explore(std::string name, const Explored& values, std::uint64_t gesture = 0);
  void keep_explored(); // they become the document's: an edit
  void drop_explored(); // back to what is stored
  // While building, the mechanism is what is stored. Returns whether that made a difference.
  bool put_explored_aside(bool aside);
  // Selecting is no step. Going to another step keeps what is selected as far as it exists there, so that
  // nothing changes under the hand. Where nothing is left of it, what was selected there is; where nothing
  // was selected at all, those of them that come back. Redoing gives what was selected there, unless another
  // selection was made since.
  void select(Selection selection);

  bool can_undo() const { return position_ > 0; }
  bool can_redo() const { return position_ + 1 < steps_.size(); }
  // To the step before or after, past those that change nothing of what is shown, as while what is explored
  // is put aside those that only try. False where there is nothing to undo or redo.
  bool undo();
  bool redo();
  // Step 0 is how it was opened. Steps before `position` are done, those after it undone.
  const std::vector<Step>& steps() const { return steps_; }
  std::size_t position() const { return position_; }
  void go_to(std::size_t step);

  // The present state is what is in the file.
  void mark_saved(std::filesystem::path file);
  // A mechanism that nobody has named is called so, in every step: a name that comes with its file is none
  // of the edits, and changes nothing that is solved.
  void name_untitled(const std::string& name);
  // Another mechanism as a file has it, mistakes in its expressions too: a step of its own. `hues` are those
  // that its bodies are known by; without, as after an edit.
  void replace(std::string name, Mechanism mechanism, const std::optional<NamedHues>& hues = {});

  // No bodies, the earth's gravity along -y.
  static Mechanism empty_mechanism();
  // Steps kept; the oldest are dropped. Of large mechanisms those that take about `most_bytes`, but some
  // always.
  static constexpr std::size_t most_steps = 1000, least_steps = 20, most_bytes = 256'000'000;

 private:
  const Step& now() const { return steps_[position_]; }
  bool is_seen(std::size_t step) const;
  void take(std::string name, Mechanism next, Selection selection, std::uint64_t gesture,
            std::shared_ptr<const BodyHues> hues = {});
  void push(Step step);
  void changed(const Mechanism* stored_before);

  std::vector<Step> steps_;
  std::size_t position_ = 0;
  Selection selection_;
  std::optional<Selection> given_{}; // by going to a step, last
  std::filesystem::path file_;
  std::shared_ptr<const Mechanism> saved_;
  std::uint64_t revision_ = 1, stored_revision_ = 1;
  bool unsaved_ = false, aside_ = false;
};

} // namespace flyball
