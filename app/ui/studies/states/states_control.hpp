// Searches all equilibria in the background. No drawing.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

void search_states(App& app);
// Searches when the study opens, and again after every change where that takes no time to speak of; takes
// what was found.
void update_states(App& app);
// Whether the list is of the mechanism as it is now.
bool states_are_current(const App& app);
// Which of the list the view shows; none where it is another, or the list is of an earlier mechanism.
std::optional<std::size_t> shown_state(const App& app);
// Puts the mechanism there.
void show_state(App& app, std::size_t index);

} // namespace flyball
