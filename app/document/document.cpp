#include "app/document/document.hpp"

#include "app/document/finite.hpp"

#include <algorithm>

namespace flyball {

Document::Document(Mechanism mechanism, std::filesystem::path file)
    : file_(std::move(file)), saved_(std::make_shared<const Mechanism>(std::move(mechanism))) {
  steps_.push_back({"Open", saved_, {}, 0});
}

// Once after every change: comparing thousands of bodies is too much for every frame.
void Document::compare() {
  const auto& present = steps_[position_].mechanism;
  unsaved_ = present != saved_ && *present != *saved_;
}

void Document::edit(std::string name, Mechanism next, Selection selection, std::uint64_t gesture) {
  if (next == mechanism() || !is_finite(next)) return select(std::move(selection));
  steps_.resize(position_ + 1);
  selection_ = existing(std::move(selection), next);
  Step step{std::move(name), std::make_shared<const Mechanism>(std::move(next)), selection_, gesture};
  ++revision_;
  Step& last = steps_.back();
  if (gesture != 0 && position_ > 0 && last.gesture == gesture && last.name == step.name) {
    if (*step.mechanism == *steps_[position_ - 1].mechanism) { // dragged back to where it was
      steps_.pop_back();
      --position_;
    } else {
      last = std::move(step);
    }
    return compare();
  }
  steps_.push_back(std::move(step));
  if (steps_.size() > most_steps) steps_.erase(steps_.begin());
  position_ = steps_.size() - 1;
  compare();
}

void Document::select(Selection selection) {
  selection_ = existing(std::move(selection), mechanism());
}

bool Document::undo() {
  if (!can_undo()) return false;
  go_to(position_ - 1);
  return true;
}

bool Document::redo() {
  if (!can_redo()) return false;
  go_to(position_ + 1);
  return true;
}

void Document::go_to(std::size_t step) {
  step = std::min(step, steps_.size() - 1);
  if (step == position_) return;
  position_ = step;
  selection_ = existing(steps_[step].selection, mechanism());
  ++revision_;
  compare();
}

void Document::mark_saved(std::filesystem::path file) {
  file_ = std::move(file);
  saved_ = steps_[position_].mechanism;
  unsaved_ = false;
}

void Document::recover(Mechanism mechanism) {
  edit("Recover", std::move(mechanism), {});
}

Mechanism Document::empty_mechanism() {
  Mechanism mechanism;
  mechanism.name = "Untitled";
  mechanism.gravity = {0, -9.80665, 0};
  return mechanism;
}

} // namespace flyball
