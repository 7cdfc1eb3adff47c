// Menus by keys: Alt opens the bar, Alt and a letter the menu that begins with it, arrows go through them.
#pragma once

#include "app/ui/ui.hpp"

namespace flyball {

struct DialogState;

// Alt alone, or Alt with a letter.
bool take_alt(Ui& ui, const DialogState& dialog, const KeyPress& key);
// Left and right, from menu to menu of the bar and into menus of menus.
bool take_menu_arrow(Ui& ui, const KeyStop* stop, const KeyPress& key);

} // namespace flyball
