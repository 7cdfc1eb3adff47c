#include "app/ui/menus/menu_commands.hpp"

#include "app/ui/assembly_edits.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/key_focus.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/widgets/quantity_field.hpp"

#include <array>
#include <string>

namespace flyball::menus {

namespace {

bool can_delete(const Session& session, const ToolState& tool) {
  return any_selected(session) || selected_point(session, tool);
}

std::string undo_label(const Session& session) {
  const Document& document = session.document;
  return document.can_undo() ? "Undo " + document.steps()[document.position()].name : "Undo";
}
std::string redo_label(const Session& session) {
  const Document& document = session.document;
  return document.can_redo() ? "Redo " + document.steps()[document.position() + 1].name : "Redo";
}

void choose_none(App& app) {
  set_tool(app.session, app.ui, app.tool, Tool::select);
  select(app.session, {});
}

const std::array edit_commands{
    Command{.id = "edit.undo",
            .title = "Undo",
            .help = "Take the last edit back.",
            .key = ctrl('Z'),
            .run = given<undo>,
            .enabled = [](const App& app) { return app.session.document.can_undo(); },
            .label = of_session<undo_label>,
            .lacks = "there is nothing to take back."},
    Command{.id = "edit.redo",
            .title = "Redo",
            .help = "Do again what was taken back.",
            .key = ctrl_shift('Z'),
            .also = ctrl('Y'),
            .run = given<redo>,
            .enabled = [](const App& app) { return app.session.document.can_redo(); },
            .label = of_session<redo_label>,
            .lacks = "nothing was taken back."},
    Command{.id = "edit.history",
            .title = "History",
            .help = "Every step, to go back to.",
            .key = ctrl('H'),
            .run = [](App& app) { app.panels->history.open = !app.panels->history.open; },
            .checked = [](const App& app) { return app.panels->history.open; }},
    Command{.id = "edit.cut",
            .title = "Cut",
            .help = "Copy the selected parts and delete them.",
            .key = ctrl('X'),
            .run = given<cut_selected>,
            .enabled = of_session<any_selected>,
            .separated = true},
    Command{.id = "edit.copy",
            .title = "Copy",
            .help = "Copy the selected parts as text, for this or another document.",
            .key = ctrl('C'),
            .run = given<copy_selected>,
            .enabled = of_session<any_selected>},
    Command{.id = "edit.paste",
            .title = "Paste",
            .help = "Add the parts that were copied.",
            .key = ctrl('V'),
            .run = given<paste_parts>},
    Command{.id = "edit.duplicate",
            .title = "Duplicate",
            .help = "Copy the selected parts beside themselves, with what holds them.",
            .key = ctrl('D'),
            .run = given<duplicate_selected>,
            .enabled = of_session<any_selected>},
    Command{.id = "edit.delete",
            .title = "Delete",
            .help = "Remove the selected parts and what hangs on them.",
            .key = plain(keys::del),
            .also = plain(keys::backspace),
            .run = given<delete_selected>,
            .enabled = of_tool<can_delete>},
    Command{.id = "edit.mirror",
            .title = "Mirror…",
            .help = "Make the mirror image of the selected bodies, with what holds them.",
            .key = ctrl('M'),
            .run = [](App& app) { app.panels->copies.open_mirror(app.session, app.dialog); },
            .enabled = of_session<any_selected>,
            .separated = true},
    Command{.id = "edit.circular",
            .title = "Circular copy…",
            .help = "Repeat the selected bodies round an axis, with what holds them.",
            .key = ctrl_shift('M'),
            .run = [](App& app) { app.panels->copies.open_circular(app.session, app.dialog); },
            .enabled = of_session<any_selected>},
    Command{.id = "edit.backlash",
            .title = "Give backlash",
            .help =
                "Play between the teeth of the selected gear, belt, rack or screw: its wheel is hung in a "
                "rim between two stops.",
            .run = given<give_backlash_to_selected>,
            .enabled = of_session<can_give_backlash>},
    Command{.id = "edit.bearing_drive",
            .title = "Drive in its bearings",
            .help =
                "A drive for the selected body that elastic bearings hold: they hold a sleeve then, in which "
                "it turns.",
            .run = given<drive_selected_in_bearings>,
            .enabled = of_session<can_drive_in_bearings>,
            .words = "rotor shaft spin turn speed",
            .lacks = "no body that bearings hold is selected."},
    Command{.id = "edit.settle",
            .title = "Draw as it settles",
            .help = "The steady state becomes the drawn pose; the mechanism stays the same.",
            .run = given<draw_settled>,
            .enabled = of_tool<can_draw_settled>,
            .lacks = "there is no steady state that differs from the drawn pose."},
    Command{.id = "edit.rename",
            .title = "Rename",
            .help = "Another name for the selected part; every reference follows.",
            .key = plain(keys::f2),
            .run = [](App& app) { app.panels->outline.start_rename(app.session, app.ui); },
            .enabled = [](const App& app) { return app.session.selection().parts.size() == 1; }},
    Command{.id = "edit.pin",
            .title = "Pin the number",
            .help = "The number of the field that the keyboard is in gets a slider, or loses it.",
            .key = ctrl('L'),
            .run =
                [](App& app) {
                  const std::string address = focused_address(app.ui);
                  pin(app.session, address, !is_pinned(app.session.mechanism(), address));
                },
            .enabled = [](const App& app) { return !focused_address(app.ui).empty(); },
            .lacks = "the keyboard is in no number's field."},
    Command{.id = "edit.all",
            .title = "Select all",
            .help = "Select every part.",
            .key = ctrl('A'),
            .run = given<select_all>,
            .enabled = of_session<holds_parts>,
            .separated = true,
            .lacks = "there is no part yet."},
    Command{.id = "edit.none",
            .title = "Select nothing",
            .help = "Drop the selection and the tool.",
            .key = plain(keys::escape),
            .run = choose_none},
};

} // namespace

std::span<const Command> edit() {
  return edit_commands;
}

} // namespace flyball::menus
