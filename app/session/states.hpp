// Every equilibrium that a bounded search finds. Nothing of it is made before a person asks.
#pragma once

#include "app/session/shared_mechanism.hpp"
#include "app/session/study.hpp"
#include "engine/report/analysis.hpp"

#include <optional>

namespace flyball {

struct Session;

using StatesStudy = Study<SharedMechanism, AllSolutions>;

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
