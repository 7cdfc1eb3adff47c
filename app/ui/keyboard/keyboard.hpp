// The window without a mouse: which widget has the keys, what they do there, and the ring that shows it.
//
// A region is a panel, a dialog, or all that lies over the 3-D view; F6 and Ctrl+Tab go from one to the
// next, Tab through a region's widgets in reading order, arrows to the nearest one. In the view, which has
// the keys at first and after Esc, Tab and letters are commands. Dear ImGui's own navigation differs from
// release to release and knows nothing of our widgets, so this uses no more of it than pressing an item.
#pragma once

#include "app/ui/ui.hpp"

namespace flyball {

class CommandRunner;
struct DialogState;
struct ViewContext;

// Takes the keys that move the focus or act on the widget that has it out of ui.keys; at the beginning of a
// frame, before tools and shortcuts look at them. `taken`: something that is open sees to the keys itself.
void take_keyboard(Ui& ui, const DialogState& dialog, const CommandRunner& commands, bool taken);
// Arrows, plus and minus steer the view while it has the keys, or the cursor of the tool that places; after
// the tools have had theirs.
void take_view_keys(const ViewContext& context);
// After everything is drawn: brings the focused widget into sight and draws the ring.
void settle_keyboard(Ui& ui);

// The widget gets the keys as soon as it is drawn.
void focus_widget(Ui& ui, const std::string& name);
// The same of a dialog that is opening: what had them before gets them back.
void enter_dialog_at(Ui& ui, const std::string& name);
bool has_keyboard(const Ui& ui, const std::string& name);
// The slider or field of the number at this address gets the keys when it is drawn; the inspector opens the
// section that it is in.
void seek_number(Ui& ui, const std::string& address);
// Of a field or slider of that number, while it is drawn.
void note_number(Ui& ui, const std::string& name, const std::string& address);
// What keys do to this slider or plot in this frame; null: nothing.
const KeyNudge* nudge_of(const Ui& ui, const std::string& name);
// What keys make of a slider's value between its ends, in hundredths of the way; whether it is another.
bool nudge_value(const Ui& ui, const std::string& name, double& value, double from, double to);
// Whether the widget's context menu is asked for by a key; asks once.
bool takes_menu_key(Ui& ui, const std::string& name);
// Whether Enter presses the focused widget of a dialog rather than what the dialog takes it for.
bool enter_is_taken(const Ui& ui);
// Whether this frame's keys go on with a movement of a slider that began before.
bool goes_on_nudging(const Ui& ui);
// The number that the focused widget shows; empty: none.
std::string focused_address(const Ui& ui);

} // namespace flyball
