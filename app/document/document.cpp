#include "app/document/document.hpp"

#include "app/document/finite.hpp"
#include "app/document/settle_formulas.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace flyball {

namespace {

bool is_finite(const Explored& explored) {
  return std::ranges::all_of(explored, [](const ExploredValue& each) { return std::isfinite(each.value); });
}

// Bytes, roughly.
std::size_t size_of(const Mechanism& mechanism) {
  std::size_t out = sizeof mechanism + mechanism.bodies.size() * sizeof(Body) +
                    mechanism.joints.size() * sizeof(Joint) + mechanism.forces.size() * sizeof(Force);
  for (const Body& body : mechanism.bodies)
    out += body.shapes.size() * sizeof(Shape);
  for (const Joint& joint : mechanism.joints)
    out += joint.coordinates.size() * sizeof(Coordinate);
  return out;
}

} // namespace

Document::Document(Mechanism mechanism, std::filesystem::path file, const NamedHues& hues)
    : file_(std::move(file)), saved_(std::make_shared<const Mechanism>(std::move(mechanism))) {
  steps_.push_back({.name = file_.empty() && saved_->bodies.empty() ? "New" : "Open",
                    .mechanism = saved_,
                    .selection = {},
                    .tried = saved_,
                    .hues = std::make_shared<const BodyHues>(choose_hues(*saved_, hues))});
}

// Once after every change: comparing thousands of bodies is too much for every frame.
void Document::changed(const Mechanism* stored_before) {
  ++revision_;
  if (now().mechanism.get() == stored_before) return;
  ++stored_revision_;
  unsaved_ = now().mechanism != saved_ && *now().mechanism != *saved_;
}

void Document::push(Step step) {
  const std::shared_ptr<const Mechanism> before = now().mechanism; // `last` may be its only owner
  steps_[position_].selection = selection_;
  steps_.resize(position_ + 1);
  selection_ = step.selection = existing(std::move(step.selection), *step.mechanism);
  if (!step.tried) {
    step.tried = step.mechanism;
    try {
      if (!step.explored.empty())
        step.tried = std::make_shared<const Mechanism>(with_explored(*step.mechanism, step.explored));
    } catch (const SceneError&) { // after an edit that leaves nothing to try them on
      step.explored.clear();
    }
  }
  if (!step.hues)
    step.hues = step.mechanism == before || same_bodies(*before, *step.mechanism)
                    ? now().hues
                    : std::make_shared<const BodyHues>(carried_hues(*before, *now().hues, *step.mechanism));
  Step& last = steps_.back();
  if (step.gesture != 0 && position_ > 0 && last.gesture == step.gesture && last.name == step.name) {
    const Step& former = steps_[position_ - 1];
    if (step.explored == former.explored && *step.mechanism == *former.mechanism) { // dragged back
      steps_.pop_back();
      --position_;
    } else {
      last = std::move(step);
    }
    return changed(before.get());
  }
  const std::size_t most = std::clamp(most_bytes / size_of(*step.tried), least_steps, most_steps);
  steps_.push_back(std::move(step));
  if (steps_.size() > most) steps_.erase(steps_.begin(), steps_.end() - static_cast<std::ptrdiff_t>(most));
  position_ = steps_.size() - 1;
  changed(before.get());
}

void Document::edit(std::string name, Mechanism next, Selection selection, std::uint64_t gesture) {
  if (!flyball::is_finite(next)) return select(std::move(selection));
  settle_formulas(stored(), next);
  take(std::move(name), std::move(next), std::move(selection), gesture);
}

void Document::take(std::string name, Mechanism next, Selection selection, std::uint64_t gesture,
                    std::shared_ptr<const BodyHues> hues) {
  if (next == stored()) return select(std::move(selection));
  Explored left = carried_explored(now().explored, stored(), next);
  push({.name = std::move(name),
        .mechanism = std::make_shared<const Mechanism>(std::move(next)),
        .selection = std::move(selection),
        .gesture = gesture,
        .explored = std::move(left),
        .hues = std::move(hues)});
}

void Document::edit_number(std::string name, const std::string& address, double value,
                           std::uint64_t gesture) {
  Mechanism next = stored();
  if (formula_at(next, address)) {
    put_number(next, address, value);
    settle_formulas(stored(), next);
  } else {
    set_parameter(next, address, value);
  }
  const bool same = next == stored();
  Explored left = now().explored;
  std::erase_if(left, [&](const ExploredValue& each) { return each.address == address; });
  if (same && left == now().explored) return;
  push({.name = std::move(name),
        .mechanism = same ? now().mechanism : std::make_shared<const Mechanism>(std::move(next)),
        .selection = selection_,
        .gesture = gesture,
        .explored = std::move(left)});
}

void Document::explore(std::string name, const Explored& values, std::uint64_t gesture) {
  if (!is_finite(values)) return;
  Explored next = now().explored;
  for (const ExploredValue& each : values)
    explore_value(next, stored(), each.address, each.value);
  if (next == now().explored) return;
  std::shared_ptr<const Mechanism> tried = now().mechanism;
  if (!next.empty()) tried = std::make_shared<const Mechanism>(with_explored(*tried, next)); // may refuse
  push({.name = std::move(name),
        .mechanism = now().mechanism,
        .selection = selection_,
        .gesture = gesture,
        .explored = std::move(next),
        .tried = std::move(tried)});
}

void Document::keep_explored() {
  if (now().explored.empty()) return;
  push({.name = "Keep the explored values", .mechanism = now().tried, .selection = selection_});
}

void Document::drop_explored() {
  if (now().explored.empty()) return;
  push({.name = "Leave the explored values", .mechanism = now().mechanism, .selection = selection_});
}

bool Document::put_explored_aside(bool aside) {
  if (aside == aside_) return false;
  aside_ = aside;
  if (now().explored.empty()) return false;
  ++revision_;
  return true;
}

void Document::select(Selection selection) {
  selection_ = existing(std::move(selection), stored());
}

bool Document::is_seen(std::size_t step) const {
  return !aside_ || step == 0 || steps_[step].mechanism != steps_[step - 1].mechanism;
}

bool Document::undo() {
  if (!can_undo()) return false;
  std::size_t step = position_;
  while (step > 1 && !is_seen(step))
    --step;
  go_to(step - 1);
  return true;
}

bool Document::redo() {
  if (!can_redo()) return false;
  std::size_t step = position_ + 1;
  while (step + 1 < steps_.size() && !is_seen(step))
    ++step;
  go_to(step);
  return true;
}

void Document::go_to(std::size_t step) {
  step = std::min(step, steps_.size() - 1);
  if (step == position_) return;
  const Mechanism* before = now().mechanism.get();
  const bool again = step > position_ && given_ == selection_;
  steps_[position_].selection = selection_;
  position_ = step;
  Selection kept = existing(again ? steps_[step].selection : selection_, stored());
  if (kept.empty() && !again) {
    kept = existing(steps_[step].selection, stored());
    if (selection_.empty())
      std::erase_if(kept.parts,
                    [&](const Part& part) { return find_part(*before, part).kind != PartKind::none; });
  }
  selection_ = std::move(kept);
  given_ = selection_;
  changed(before);
}

void Document::mark_saved(std::filesystem::path file) {
  file_ = std::move(file);
  saved_ = steps_[position_].mechanism;
  unsaved_ = false;
}

void Document::name_untitled(const std::string& name) {
  const std::string untitled = empty_mechanism().name;
  if (stored().name != untitled || name == untitled) return;
  std::map<std::shared_ptr<const Mechanism>, std::shared_ptr<const Mechanism>> named; // shared as before
  const auto give_name = [&](std::shared_ptr<const Mechanism>& mechanism) {
    if (mechanism->name != untitled) return;
    std::shared_ptr<const Mechanism>& other = named[mechanism];
    if (!other) {
      Mechanism copy = *mechanism;
      copy.name = name;
      other = std::make_shared<const Mechanism>(std::move(copy));
    }
    mechanism = other;
  };
  const std::shared_ptr<const Mechanism> before = now().mechanism;
  for (Step& step : steps_) {
    give_name(step.mechanism);
    give_name(step.tried);
  }
  changed(before.get());
}

void Document::replace(std::string name, Mechanism mechanism, const std::optional<NamedHues>& hues) {
  if (!flyball::is_finite(mechanism)) return;
  std::shared_ptr<const BodyHues> known;
  if (hues) known = std::make_shared<const BodyHues>(choose_hues(mechanism, *hues));
  take(std::move(name), std::move(mechanism), selection_, 0, std::move(known));
}

Mechanism Document::empty_mechanism() {
  Mechanism mechanism;
  mechanism.name = "Untitled";
  mechanism.gravity = {0, -9.80665, 0};
  return mechanism;
}

} // namespace flyball
