// Whose a key is: the view's, where letters are commands, or a panel's, in which a person types.
//
// The last click decides, as it does for a text field. After a click in a panel, or once one has typed there,
// what can be typed into a field is no command, so that a click that missed a field does no harm; letters are
// commands again as soon as the pointer works in the view, and stay so once one was a command there, whatever
// that brings under the pointer; everything is once the view, a button or a row of the list of parts is
// clicked, Escape is pressed or a field is left by Enter. At a slider, and among plots and tables of results,
// letters stay commands, since only numbers are typed there.
#pragma once

namespace flyball {

struct DialogState;
struct KeyPress;
struct Session;
struct Ui;

// Where the hand has clicked or types; before the keys of a frame are looked at.
void notice_key_focus(Ui& ui);

// Whether this key may be a command now. Where it may not, the notice says how to have it.
bool may_command(Session& session, Ui& ui, const KeyPress& key);

// Menus, lists and the sheet of keys: while one is open no key reaches what lies behind it, and Escape closes
// it. Takes the keys that are theirs out of ui.keys.
// `shortcuts`: the sheet is open; `palette`: the palette is, and sees to its keys itself.
void give_keys_to_popups(Ui& ui, const DialogState& dialog, bool& shortcuts, bool palette);

} // namespace flyball
