#include "app/ui/menus/menu_commands.hpp"

#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/hidden_parts.hpp"
#include "app/ui/load_view.hpp"
#include "app/ui/panels.hpp"

#include <array>
#include <numbers>

namespace flyball::menus {

namespace {

constexpr double right_angle = std::numbers::pi / 2;

template <ThemeChoice choice>
void choose_colours(App& app) {
  choose_theme(app.session, app.ui, app.view, choice);
}
template <bool ViewState::*what>
void toggle(App& app) {
  toggle_in_view(app.session, app.ui, app.view, what);
}
template <ThemeChoice choice>
bool colours_chosen(const App& app) {
  return app.ui.theme_choice == choice;
}

template <int steps>
void zoom(App& app) {
  zoom_interface(app.session, app.ui, app.view, steps);
}

const std::array view_commands{
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
            .checked = [](const App& app) { return app.session.playback.playing; },
            .lacks = "there is no part yet."},
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
            .checked = tool_chosen<Tool::pull>,
            .lacks = "there is no part yet."},
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
            .enabled = [](const App& app) { return !app.view.hidden.empty(); },
            .lacks = "nothing is hidden."},
    Command{.id = "view.ghost",
            .title = "Ghost",
            .help = "The drawn pose behind the steady state, or the other way round.",
            .key = plain('G'),
            .run = toggle<&ViewState::ghost>,
            .checked = [](const App& app) { return app.view.ghost; },
            .separated = true},
    Command{.id = "view.loads",
            .title = "Forces",
            .help = "Arrows of reactions, drive torques, springs' forces and inertial loads; with one body "
                    "chosen (Page Down: the next one), its free-body diagram.",
            .key = plain('A'),
            .run =
                [](App& app) {
                  app.view.loads = !app.view.loads;
                  app.view.fit_loads = true;
                },
            .checked = [](const App& app) { return app.view.loads; }},
    Command{.id = "view.loads_by_root",
            .title = "Forces by the cube root",
            .help = "Lengths of arrows grow with the cube root, so that small forces are seen beside large "
                    "ones, rather than in proportion.",
            .run =
                [](App& app) {
                  const bool roots = !app.view.loads || !shows_roots(app.view);
                  app.view.load_lengths = roots ? LoadLengths::by_cube_root : LoadLengths::in_proportion;
                  app.view.loads = app.view.fit_loads = true;
                },
            .enabled = [](const App& app) { return !shows_diagram(app.view); },
            .checked = [](const App& app) { return app.view.loads && shows_roots(app.view); },
            .lacks = "a body's diagram is in proportion."},
    Command{.id = "view.grid",
            .title = "Grid",
            .help = "The grid on the floor.",
            .run = toggle<&ViewState::grid>,
            .checked = [](const App& app) { return app.view.grid; }},
    Command{.id = "view.shadow",
            .title = "Shadow",
            .help = "The shadow on the floor.",
            .run = toggle<&ViewState::shadow>,
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
    Command{.id = "view.larger",
            .title = "Larger interface",
            .help = "Letters, panels and signs a size larger.",
            .key = ctrl('+'),
            .also = ctrl('='),
            .run = zoom<1>,
            .enabled = [](const App& app) { return app.ui.zoom < most_zoom; },
            .separated = true,
            .words = "scale zoom size font text bigger",
            .lacks = "it is as large as it gets."},
    Command{.id = "view.smaller",
            .title = "Smaller interface",
            .help = "Letters, panels and signs a size smaller.",
            .key = ctrl('-'),
            .run = zoom<-1>,
            .enabled = [](const App& app) { return app.ui.zoom > least_zoom; },
            .words = "scale zoom size font text",
            .lacks = "it is as small as it gets."},
    Command{.id = "view.usual_size",
            .title = "Interface of the usual size",
            .help = "As large as the display is said to need.",
            .key = ctrl('0'),
            .run = zoom<0>,
            .enabled = [](const App& app) { return app.ui.zoom != 1; },
            .words = "scale zoom reset font text",
            .lacks = "it has its usual size."},
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
};

} // namespace

std::span<const Command> view() {
  return view_commands;
}

} // namespace flyball::menus
