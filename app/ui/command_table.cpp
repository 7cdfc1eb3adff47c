// Every command: what it is called, its keys, and what it does.
#include "app/ui/commands.hpp"

#include "app/ui/app.hpp"
#include "app/ui/assembly_edits.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/hidden_parts.hpp"
#include "app/ui/key_focus.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/widgets/quantity_field.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

namespace flyball {

namespace {

constexpr double right_angle = std::numbers::pi / 2;

constexpr KeyPress plain(int key) {
  return {key, false, false};
}
constexpr KeyPress ctrl(int key) {
  return {key, true, false};
}
constexpr KeyPress shift(int key) {
  return {key, false, true};
}
constexpr KeyPress ctrl_shift(int key) {
  return {key, true, true};
}

bool any_selected(const Session& session) {
  return !session.selection().empty();
}
bool can_delete(const Session& session, const ToolState& tool) {
  return any_selected(session) || selected_point(session, tool);
}
bool holds_parts(const Session& session) {
  return !session.mechanism().bodies.empty();
}
template <Tool tool>
void choose_tool(App& app) {
  set_tool(app.session, app.ui, app.tool, tool);
}
template <Tool tool>
bool tool_chosen(const App& app) {
  return app.tool.tool == tool;
}

template <GearKind kind>
void gear(App& app) {
  gear_selected(app.session, kind);
}
template <GearKind kind>
bool can_gear(const App& app) {
  return can_gear_selected(app.session, kind);
}

template <auto which, auto unit>
void show_in(App& app) {
  DisplayUnits units = app.session.units;
  units.*which = unit;
  // How a person has looked at the plots was in other units.
  if (choose_units(app.session, app.ui, app.view, units)) app.panels->studies.fit();
}
template <auto which, auto unit>
bool shown_in(const App& app) {
  return app.session.units.*which == unit;
}

// Each part of the App that a command may take.
struct AnyPart {
  App& app;
  operator Session&() const { return app.session; }
  operator ToolState&() const { return app.tool; }
  operator ViewState&() const { return app.view; }
  operator ViewContext() const { return app.context(); }
};

template <class... Parts>
void give(App& app, void (*command)(Parts...)) {
  command(static_cast<Parts>(AnyPart{app})...);
}

// A command that is given the parts that it takes.
template <auto command>
void given(App& app) {
  give(app, command);
}

template <auto dialog>
void open_dialog_of(App& app) {
  ((*app.panels).*dialog).open(app.session, app.dialog);
}

template <Filmed of>
void film(App& app) {
  app.panels->movie.open(app.session, app.dialog, app.movie, of);
}

// What the session tells.
template <auto told>
auto of_session(const App& app) {
  return told(app.session);
}

template <auto told>
bool of_tool(const App& app) {
  return told(app.session, app.tool);
}

template <ThemeChoice choice>
void choose_colours(App& app) {
  choose_theme(app.session, app.ui, app.view, choice);
}
template <ThemeChoice choice>
bool colours_chosen(const App& app) {
  return app.ui.theme_choice == choice;
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

const std::array all_commands{
    Command{.id = "file.new",
            .title = "New",
            .help = "An empty document.",
            .key = ctrl('N'),
            .run = new_document},
    Command{.id = "file.open",
            .title = "Open…",
            .help = "Open a scene file.",
            .key = ctrl('O'),
            .run = open_dialog_of<&Panels::open>},
    Command{.id = "file.examples",
            .title = "Examples…",
            .help = "Mechanisms to start from, with pictures.",
            .key = ctrl_shift('O'),
            .run = open_dialog_of<&Panels::gallery>},
    Command{.id = "file.save",
            .title = "Save",
            .help = "Write the scene to its file.",
            .key = ctrl('S'),
            .run = save_document,
            .separated = true},
    Command{.id = "file.save_as",
            .title = "Save as…",
            .help = "Write the scene to another file.",
            .key = ctrl_shift('S'),
            .run = show_save_dialog},
    Command{.id = "file.reload",
            .title = "Reload",
            .help = "Read the file again, as it is on disk now.",
            .key = ctrl('R'),
            .run = given<reload_document>,
            .enabled = [](const App& app) { return !app.session.document.file().empty(); }},
    Command{.id = "file.export",
            .title = "Export a picture…",
            .help = "Save what is seen as a PNG file.",
            .key = ctrl('E'),
            .run = [](App& app) { app.panels->picture.open(app.session, app.dialog, app.view.loads); },
            .separated = true},
    Command{.id = "file.report",
            .title = "Export report…",
            .help =
                "Write all about the steady state into one page: picture, loads, modes, curves, assumptions.",
            .run = open_dialog_of<&Panels::report>,
            .enabled =
                [](const App& app) { return app.session.mistakes.empty() && !writing_report(app.report); }},
    Command{.id = "file.model",
            .title = "Export linear model…",
            .help = "Write the linear model that Transfer shows for MATLAB, Python or NumPy, or as JSON.",
            .run = open_dialog_of<&Panels::model>,
            .enabled = [](const App& app) { return has_transfer(app.session); }},
    Command{.id = "file.quit",
            .title = "Quit",
            .help = "Leave the program; asks before unsaved work is lost.",
            .key = ctrl('Q'),
            .run = quit,
            .separated = true},

    Command{.id = "edit.undo",
            .title = "Undo",
            .help = "Take the last edit back.",
            .key = ctrl('Z'),
            .run = given<undo>,
            .enabled = [](const App& app) { return app.session.document.can_undo(); },
            .label = of_session<undo_label>},
    Command{.id = "edit.redo",
            .title = "Redo",
            .help = "Do again what was taken back.",
            .key = ctrl_shift('Z'),
            .also = ctrl('Y'),
            .run = given<redo>,
            .enabled = [](const App& app) { return app.session.document.can_redo(); },
            .label = of_session<redo_label>},
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
    Command{.id = "edit.gear",
            .title = "Join by a gear",
            .help = "Couple the selected joints: each turns as the one chosen before it does.",
            .run = gear<GearKind::gear>,
            .enabled = can_gear<GearKind::gear>},
    Command{.id = "edit.belt",
            .title = "Join by a belt",
            .help =
                "A belt or chain over wheels on the selected joints, from one to the next in the order of "
                "their choice.",
            .run = gear<GearKind::belt>,
            .enabled = can_gear<GearKind::belt>},
    Command{.id = "edit.rack",
            .title = "Join by a rack",
            .help = "A pinion on the selected joint that turns moves a rack along the one that slides.",
            .run = gear<GearKind::rack>,
            .enabled = can_gear<GearKind::rack>},
    Command{.id = "edit.screw",
            .title = "Join by a screw",
            .help = "A thread: the selected joint that slides moves by the lead as the other makes a turn.",
            .run = gear<GearKind::screw>,
            .enabled = can_gear<GearKind::screw>},
    Command{.id = "edit.backlash",
            .title = "Give backlash",
            .help =
                "Play between the teeth of the selected gear, belt, rack or screw: its wheel is hung in a "
                "rim between two stops.",
            .run = given<give_backlash_to_selected>,
            .enabled = of_session<can_give_backlash>},
    Command{.id = "edit.settle",
            .title = "Draw as it settles",
            .help = "The steady state becomes the drawn pose; the mechanism stays the same.",
            .run = given<draw_settled>,
            .enabled = of_tool<can_draw_settled>},
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
            .enabled = [](const App& app) { return !focused_address(app.ui).empty(); }},
    Command{.id = "edit.all",
            .title = "Select all",
            .help = "Select every part.",
            .key = ctrl('A'),
            .run = given<select_all>,
            .enabled = of_session<holds_parts>,
            .separated = true},
    Command{.id = "edit.none",
            .title = "Select nothing",
            .help = "Drop the selection and the tool.",
            .key = plain(keys::escape),
            .run = choose_none},

    Command{.id = "insert.ball",
            .title = "Ball",
            .help = "A solid ball: click where its centre is.",
            .key = shift('B'),
            .run = choose_tool<Tool::ball>,
            .checked = tool_chosen<Tool::ball>},
    Command{.id = "insert.block",
            .title = "Block",
            .help = "A solid block: click where its centre is.",
            .key = shift('K'),
            .run = choose_tool<Tool::block>,
            .checked = tool_chosen<Tool::block>},
    Command{.id = "insert.rod",
            .title = "Rod",
            .help = "A solid rod: click its two ends.",
            .key = shift('R'),
            .run = choose_tool<Tool::rod>,
            .checked = tool_chosen<Tool::rod>},
    Command{.id = "insert.plate",
            .title = "Plate",
            .help = "A thin block: click where its centre is.",
            .key = shift('P'),
            .run = choose_tool<Tool::plate>,
            .checked = tool_chosen<Tool::plate>},
    Command{.id = "insert.joint",
            .title = "Joint",
            .help = "Join two bodies, or a body and the ground: click the point where they meet.",
            .key = plain('J'),
            .run = choose_tool<Tool::joint>,
            .checked = tool_chosen<Tool::joint>,
            .separated = true},
    Command{.id = "insert.distance",
            .title = "Link",
            .help = "A massless link of constant length between two points (a distance joint).",
            .key = plain('L'),
            .run = choose_tool<Tool::distance>,
            .checked = tool_chosen<Tool::distance>},
    Command{.id = "insert.spring",
            .title = "Spring",
            .help = "A spring between two points.",
            .key = plain('S'),
            .run = choose_tool<Tool::spring>,
            .checked = tool_chosen<Tool::spring>,
            .separated = true},
    Command{.id = "insert.damper",
            .title = "Damper",
            .help = "A damper between two points.",
            .key = plain('D'),
            .run = choose_tool<Tool::damper>,
            .checked = tool_chosen<Tool::damper>},
    Command{.id = "insert.bearing",
            .title = "Bearing",
            .help = "An elastic bearing: stiffness and damping across the axis of what turns in it.",
            .key = shift('J'),
            .run = choose_tool<Tool::bearing>,
            .checked = tool_chosen<Tool::bearing>},
    Command{.id = "insert.force",
            .title = "Force",
            .help = "A constant force at a point of a body.",
            .key = shift('F'),
            .run = choose_tool<Tool::force>,
            .checked = tool_chosen<Tool::force>},
    Command{.id = "insert.torque",
            .title = "Torque",
            .help = "A constant torque on a body.",
            .key = shift('T'),
            .run = choose_tool<Tool::torque>,
            .checked = tool_chosen<Tool::torque>},
    Command{.id = "insert.drag",
            .title = "Air drag",
            .help = "The drag of the air, at a point of a body.",
            .key = shift('A'),
            .run = choose_tool<Tool::drag>,
            .checked = tool_chosen<Tool::drag>},
    Command{.id = "insert.vane",
            .title = "Vane",
            .help = "A plate or blade in the air: drag and lift by the direction of the flow.",
            .key = shift('V'),
            .run = choose_tool<Tool::vane>,
            .checked = tool_chosen<Tool::vane>},

    Command{.id = "view.mode",
            .title = "Build",
            .help = "Edit the drawn pose; or else explore the steady state with sliders.",
            .key = plain(keys::tab),
            .run =
                [](App& app) {
                  set_mode(app.session, app.session.mode == Mode::build ? Mode::explore : Mode::build);
                },
            .checked = [](const App& app) { return app.session.mode == Mode::build; }},
    Command{.id = "view.play",
            .title = "Turn",
            .help = "Turn the mechanism at its drives' speeds.",
            .key = plain(' '),
            .run =
                [](App& app) {
                  // A mode in the view is what moves.
                  if (moving_mode(app.session))
                    app.session.study.modes.playing = !app.session.study.modes.playing;
                  else
                    play(app.session, !app.session.playback.playing);
                },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.playback.playing; }},
    Command{.id = "view.select",
            .title = "Select and move",
            .help = "Pick parts; arrows at the selected ones move them.",
            .key = plain('V'),
            .run = choose_tool<Tool::select>,
            .checked = tool_chosen<Tool::select>,
            .separated = true},
    Command{.id = "view.rotate",
            .title = "Select and rotate",
            .help = "Pick parts; rings round the selected ones turn them.",
            .key = plain('R'),
            .run = choose_tool<Tool::rotate>,
            .checked = tool_chosen<Tool::rotate>},
    Command{.id = "view.pull",
            .title = "Pull",
            .help =
                "Drag a body: along its joints while building, by a spring while exploring (or hold Alt); "
                "with Shift pinned sliders bring it where the hand is.",
            .key = plain('H'),
            .run = choose_tool<Tool::pull>,
            .enabled = of_session<holds_parts>,
            .checked = tool_chosen<Tool::pull>},
    Command{.id = "view.box",
            .title = "Select a box",
            .help = "Drag a frame round the parts to select (or hold Ctrl).",
            .key = plain('B'),
            .run = choose_tool<Tool::box>,
            .checked = tool_chosen<Tool::box>},
    Command{.id = "view.snap",
            .title = "Snap",
            .help = "Snap to points, the grid and round angles; Ctrl while dragging does the opposite.",
            .key = plain('N'),
            .run = [](App& app) { app.tool.snap = !app.tool.snap; },
            .checked = [](const App& app) { return app.tool.snap; }},
    Command{.id = "view.fit",
            .title = "All in view",
            .help = "Move the camera so that everything is seen.",
            .key = plain('F'),
            .run = given<fit_all>,
            .separated = true},
    Command{.id = "view.front",
            .title = "From the front",
            .help = "Look from the front.",
            .key = plain('1'),
            .run = [](App& app) { look_from(app.view, 0, 0); }},
    Command{.id = "view.side",
            .title = "From the side",
            .help = "Look from the right.",
            .key = plain('2'),
            .run = [](App& app) { look_from(app.view, right_angle, 0); }},
    Command{.id = "view.top",
            .title = "From above",
            .help = "Look from above.",
            .key = plain('3'),
            .run = [](App& app) { look_from(app.view, 0, right_angle); }},
    Command{.id = "view.iso",
            .title = "Isometric",
            .help = "Look from the front, right and above.",
            .key = plain('4'),
            .run = [](App& app) { look_from(app.view, right_angle / 2, isometric_elevation); }},
    Command{.id = "view.fit_selected",
            .title = "Selection in view",
            .help = "Move the camera to what is selected.",
            .key = plain('Z'),
            .run = given<fit_selected>,
            .enabled = of_session<any_selected>},
    Command{.id = "view.hide",
            .title = "Hide",
            .help = "Leave the selected parts out of the view; they act as before.",
            .key = shift('H'),
            .run = given<hide_selected>,
            .enabled = of_session<any_selected>,
            .separated = true},
    Command{.id = "view.isolate",
            .title = "Isolate",
            .help = "Hide everything but the selected parts and what joins them.",
            .key = plain('I'),
            .run = given<isolate_selected>,
            .enabled = of_session<any_selected>},
    Command{.id = "view.show_all",
            .title = "Show all",
            .help = "Bring hidden parts back.",
            .key = ctrl_shift('H'),
            .run = given<show_hidden>,
            .enabled = [](const App& app) { return !app.view.hidden.empty(); }},
    Command{.id = "view.ghost",
            .title = "Ghost",
            .help = "The drawn pose behind the steady state, or the other way round.",
            .key = plain('G'),
            .run = [](App& app) { app.view.ghost = !app.view.ghost; },
            .checked = [](const App& app) { return app.view.ghost; },
            .separated = true},
    Command{.id = "view.loads",
            .title = "Forces",
            .help = "Arrows of reactions, drive torques, springs' forces and inertial loads; with one body "
                    "chosen, its free-body diagram.",
            .key = plain('A'),
            .run =
                [](App& app) {
                  app.view.loads = !app.view.loads;
                  app.view.fit_loads = true;
                },
            .checked = [](const App& app) { return app.view.loads; }},
    Command{.id = "view.grid",
            .title = "Grid",
            .help = "The grid on the floor.",
            .run = [](App& app) { app.view.grid = !app.view.grid; },
            .checked = [](const App& app) { return app.view.grid; }},
    Command{.id = "view.shadow",
            .title = "Shadow",
            .help = "The shadow on the floor.",
            .run = [](App& app) { app.view.shadow = !app.view.shadow; },
            .checked = [](const App& app) { return app.view.shadow; }},
    Command{.id = "view.navigation_own",
            .title = "Mouse: left button orbits",
            .help = "Drag to orbit, right drag or Shift+drag to pan, the wheel zooms to the pointer.",
            .run = [](App& app) { choose_navigation(app.session, app.ui, app.view, Navigation::own); },
            .checked = [](const App& app) { return app.view.navigation == Navigation::own; },
            .separated = true},
    Command{.id = "view.navigation_blender",
            .title = "Mouse: as in Blender",
            .help =
                "Middle drag to orbit, with Shift to pan, with Ctrl or the wheel to zoom; the left button "
                "selects a box.",
            .run = [](App& app) { choose_navigation(app.session, app.ui, app.view, Navigation::blender); },
            .checked = [](const App& app) { return app.view.navigation == Navigation::blender; }},
    Command{.id = "view.navigation_cad",
            .title = "Mouse: as in CAD",
            .help =
                "Right or middle drag to orbit, with Ctrl to pan, with Shift or the wheel to zoom (Onshape, "
                "SolidWorks); the left button selects a box.",
            .run = [](App& app) { choose_navigation(app.session, app.ui, app.view, Navigation::cad); },
            .checked = [](const App& app) { return app.view.navigation == Navigation::cad; }},
    Command{.id = "view.menu",
            .title = "Context menu",
            .help = "What can be done with the selected parts, or with the view; as a right click.",
            .key = shift(keys::f10),
            .also = plain(keys::menu),
            .run = [](App& app) { app.panels->viewport.open_menu(app.session); }},
    Command{.id = "view.theme_system",
            .title = "Colours of the system",
            .help = "Light or dark as the desktop is, also when that changes.",
            .run = choose_colours<ThemeChoice::system>,
            .checked = colours_chosen<ThemeChoice::system>,
            .separated = true},
    Command{.id = "view.theme_light",
            .title = "Light colours",
            .help = "Dark words on a light ground.",
            .run = choose_colours<ThemeChoice::light>,
            .checked = colours_chosen<ThemeChoice::light>},
    Command{.id = "view.theme_dark",
            .title = "Dark colours",
            .help = "Light words on a dark ground.",
            .run = choose_colours<ThemeChoice::dark>,
            .checked = colours_chosen<ThemeChoice::dark>},
    Command{.id = "view.theme_contrast",
            .title = "High contrast",
            .help = "On black, with every word at a contrast of 7 to 1 or more.",
            .run = choose_colours<ThemeChoice::high_contrast>,
            .checked = colours_chosen<ThemeChoice::high_contrast>},

    Command{.id = "units.degrees",
            .title = "Angles in degrees",
            .help = "Angles in fields, results and plots; any unit can be typed.",
            .run = show_in<&DisplayUnits::angle, AngleUnit::degree>,
            .checked = shown_in<&DisplayUnits::angle, AngleUnit::degree>},
    Command{.id = "units.radians",
            .title = "Angles in radians",
            .help = "Angles in fields, results and plots; any unit can be typed.",
            .run = show_in<&DisplayUnits::angle, AngleUnit::radian>,
            .checked = shown_in<&DisplayUnits::angle, AngleUnit::radian>},
    Command{.id = "units.metres",
            .title = "Lengths in metres",
            .help = "Lengths in fields, results and plots; stiffness in N/m.",
            .run = show_in<&DisplayUnits::length, LengthUnit::metre>,
            .checked = shown_in<&DisplayUnits::length, LengthUnit::metre>,
            .separated = true},
    Command{.id = "units.millimetres",
            .title = "Lengths in millimetres",
            .help = "Lengths in fields, results and plots; stiffness in N/mm.",
            .run = show_in<&DisplayUnits::length, LengthUnit::millimetre>,
            .checked = shown_in<&DisplayUnits::length, LengthUnit::millimetre>},
    Command{.id = "units.radians_per_second",
            .title = "Speeds of turning in rad/s",
            .help = "Drive speeds and rates of angles, everywhere.",
            .run = show_in<&DisplayUnits::speed, SpeedUnit::radian>,
            .checked = shown_in<&DisplayUnits::speed, SpeedUnit::radian>,
            .separated = true},
    Command{.id = "units.rpm",
            .title = "Speeds of turning in rpm",
            .help = "Drive speeds and rates of angles, everywhere.",
            .run = show_in<&DisplayUnits::speed, SpeedUnit::rpm>,
            .checked = shown_in<&DisplayUnits::speed, SpeedUnit::rpm>},
    Command{.id = "units.degrees_per_second",
            .title = "Speeds of turning in °/s",
            .help = "Drive speeds and rates of angles, everywhere.",
            .run = show_in<&DisplayUnits::speed, SpeedUnit::degree>,
            .checked = shown_in<&DisplayUnits::speed, SpeedUnit::degree>},

    Command{.id = "study.motion",
            .title = "Motion",
            .help = "The damped motion beside the steady state, and plots of it.",
            .key = plain('M'),
            .run = [](App& app) { open_study(app.session, StudyKind::motion); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::motion; }},
    Command{.id = "study.response",
            .title = "Response",
            .help = "The steady states over one parameter: branches, folds and crossings, live.",
            .key = plain('C'),
            .run = [](App& app) { open_study(app.session, StudyKind::response); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::response; }},
    Command{.id = "study.states",
            .title = "All equilibria",
            .help = "Every equilibrium that a bounded search finds, stable or not.",
            .key = plain('E'),
            .run = [](App& app) { open_study(app.session, StudyKind::states); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::states; }},
    Command{.id = "study.modes",
            .title = "Modes",
            .help =
                "How the steady state swings, moving in the view, and at which speeds (Campbell diagram).",
            .key = plain('O'),
            .run = [](App& app) { open_study(app.session, StudyKind::modes); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::modes; }},
    Command{.id = "study.map",
            .title = "Map of two parameters",
            .help = "A coordinate in colours over the plane of two parameters, with the curves of folds.",
            .key = plain('P'),
            .run = [](App& app) { open_study(app.session, StudyKind::map); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::map; }},
    Command{
        .id = "study.spread",
        .title = "Spread by tolerances",
        .help =
            "How the steady state scatters with tolerances of numbers: a histogram, and whose share it is.",
        .run = [](App& app) { open_study(app.session, StudyKind::spread); },
        .enabled = of_session<holds_parts>,
        .checked = [](const App& app) { return app.session.study.open == StudyKind::spread; }},
    Command{.id = "study.transfer",
            .title = "Transfer function",
            .help = "The linear model about the steady state: Bode's plots, poles and zeros, files for "
                    "MATLAB and Python.",
            .run = [](App& app) { open_study(app.session, StudyKind::transfer); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::transfer; }},
    Command{.id = "study.compare",
            .title = "Compare",
            .help = "Error against run time: the direct solution and the damped motion.",
            .run = [](App& app) { open_study(app.session, StudyKind::compare); },
            .enabled = of_session<holds_parts>,
            .checked = [](const App& app) { return app.session.study.open == StudyKind::compare; }},
    Command{.id = "study.cycle",
            .title = "Find the limit cycle",
            .help = "Where the steady state is left by swings that grow: the motion that they come to, "
                    "in the results.",
            .run =
                [](App& app) {
                  find_cycle(app.session, !app.session.study.periodic.cycle_wanted);
                  set_mode(app.session, Mode::explore);
                },
            .enabled = of_session<hunts>,
            .checked = [](const App& app) { return app.session.study.periodic.cycle_wanted; }},
    Command{.id = "study.export",
            .title = "Export the run…",
            .help = "Save the motion that is shown as a film: MP4, GIF or numbered pictures.",
            .run = film<Filmed::run>,
            .enabled =
                [](const App& app) { return app.session.motion.on && shown_motion(app.session) != nullptr; },
            .separated = true},
    Command{.id = "study.export_mode",
            .title = "Export the mode…",
            .help = "Save the mode that is shown as a film that begins again without a jump.",
            .run = film<Filmed::mode>,
            .enabled = [](const App& app) { return moving_mode(app.session) != nullptr; }},

    Command{.id = "help.palette",
            .title = "Find…",
            .help = "Commands, parts and numbers by name; \"spin 15\" sets a number.",
            .key = ctrl('P'),
            .run = [](App& app) { app.panels->palette.open(); }},
    Command{.id = "help.messages",
            .title = "Messages",
            .help = "What was told before, the latest first.",
            .run = [](App& app) { app.notice_log.showing = !app.notice_log.showing; },
            .checked = [](const App& app) { return app.notice_log.showing; }},
    Command{.id = "help.shortcuts",
            .title = "Shortcuts",
            .help = "Every key and what it does.",
            .key = plain('?'),
            .also = plain(keys::f1),
            .run = [](App& app) { app.panels->shortcuts.open = !app.panels->shortcuts.open; },
            .checked = [](const App& app) { return app.panels->shortcuts.open; }},
};

} // namespace

std::span<const Command> commands() {
  return all_commands;
}

} // namespace flyball
