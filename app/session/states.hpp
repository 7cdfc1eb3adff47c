// Every equilibrium that a bounded search finds. Nothing of it is made before a person asks.
#pragma once

#include "app/live/background.hpp"
#include "engine/report/analysis.hpp"

#include <memory>
#include <optional>
#include <string>

namespace flyball {

struct Session;

struct FoundStates {
  AllSolutions all;
  bool cancelled = false; // then the list is not of use
  double run_time_s = 0;
};

struct StatesState {
  std::unique_ptr<Background<FoundStates>> task;
  std::optional<FoundStates> result;
  std::uint64_t asked = 0, of = 0; // revisions of the document: last searched, and of the result
  std::uint64_t lists = 0;         // so far, for the table's widths
  std::string problem;             // why there is no list, in words
};

void search_states(Session& session);
// Searches when the study opens, and again after every change where that takes no time to speak of; takes
// what was found.
void update_states(Session& session);
// Whether the list is of the mechanism as it is now.
bool states_are_current(const Session& session);
// Which of the list the view shows; none where it is another, or the list is of an earlier mechanism.
std::optional<std::size_t> shown_state(const Session& session);
// Puts the mechanism there.
void show_state(Session& session, std::size_t index);

} // namespace flyball
