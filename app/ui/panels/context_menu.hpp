// What can be done with what is under the hand in the view: the menu of a click with the right button.
#pragma once

#include "app/ui/panels/view_input.hpp"

namespace flyball {

// Opens the menu where the right button was clicked, or where open_context_menu() asked for it, and shows it
// while it is open. On a part, which is selected by it, it is that part's, elsewhere the view's.
void context_menu(App& app, const ViewInput& input);

// For a key: at the selected part, else in the middle of the view.
void open_context_menu(App& app);

} // namespace flyball
