#include "app/ui/menus/menu_commands.hpp"

#include "app/ui/plots/plot_view.hpp"

#include <array>

namespace flyball::menus {

namespace {

template <Filmed of>
void film(App& app) {
  app.panels->movie.open(app.session, app.dialog, app.movie, of);
}

template <StudyKind study>
bool is_study_shown(const App& app) {
  return study_shown(app.session, study);
}

bool shows_plot(const App& app) {
  return app.session.mode == Mode::explore && app.session.study.open != StudyKind::none && app.ui.plot_drawn;
}

// What a right click on a plot offers, too.
template <PlotFile kind>
Command save_plot(const char* id, const char* title, const char* help) {
  return {.id = id,
          .title = title,
          .help = help,
          .run = [](App& app) { app.ui.plot_file_wanted = kind; },
          .enabled = shows_plot,
          .words = "export, numbers, curve",
          .lacks = "no plot is shown."};
}

const std::array study_commands{
    Command{.id = "study.motion",
            .title = "Motion",
            .help = "The damped motion beside the steady state, and plots of it.",
            .key = plain('M'),
            .run = [](App& app) { open_study(app.session, StudyKind::motion); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::motion>,
            .words = "simulation, transient",
            .lacks = "there is no part yet."},
    Command{.id = "study.response",
            .title = "Response",
            .help = "The steady states over one parameter: branches, folds and crossings, live.",
            .key = plain('C'),
            .run = [](App& app) { open_study(app.session, StudyKind::response); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::response>,
            .words = "droop curve, resonance curve, bifurcation diagram, hysteresis, friction, sweep",
            .lacks = "there is no part yet."},
    Command{.id = "study.states",
            .title = "All equilibria",
            .help = "Every equilibrium that a bounded search finds, stable or not.",
            .key = plain('E'),
            .run = [](App& app) { open_study(app.session, StudyKind::states); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::states>,
            .words = "solutions, steady states",
            .lacks = "there is no part yet."},
    Command{.id = "study.modes",
            .title = "Modes",
            .help =
                "How the steady state swings, moving in the view, and at which speeds (Campbell diagram).",
            .key = plain('O'),
            .run = [](App& app) { open_study(app.session, StudyKind::modes); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::modes>,
            .words = "eigenvalues, natural frequencies, vibrations, critical speeds",
            .lacks = "there is no part yet."},
    Command{.id = "study.map",
            .title = "Map of two parameters",
            .help = "A coordinate in colours over the plane of two parameters, with the curves of folds.",
            .key = plain('P'),
            .run = [](App& app) { open_study(app.session, StudyKind::map); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::map>,
            .words = "boundary of hunting, Hopf points, stability diagram of Vyshnegradsky",
            .lacks = "there is no part yet."},
    Command{
        .id = "study.spread",
        .title = "Spread by tolerances",
        .help =
            "How the steady state scatters with tolerances of numbers: a histogram, and whose share it is.",
        .run = [](App& app) { open_study(app.session, StudyKind::spread); },
        .enabled = of_session<holds_parts>,
        .checked = is_study_shown<StudyKind::spread>,
        .words = "Monte Carlo, uncertainty",
        .lacks = "there is no part yet."},
    Command{.id = "study.transfer",
            .title = "Transfer function",
            .help = "The linear model about the steady state: Bode's plots, poles and zeros, files for "
                    "MATLAB and Python.",
            .run = [](App& app) { open_study(app.session, StudyKind::transfer); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::transfer>,
            .words = "frequency response, state space",
            .lacks = "there is no part yet."},
    Command{.id = "study.compare",
            .title = "Compare",
            .help = "Error against run time: the direct solution and the damped motion.",
            .run = [](App& app) { open_study(app.session, StudyKind::compare); },
            .enabled = of_session<holds_parts>,
            .checked = is_study_shown<StudyKind::compare>,
            .words = "accuracy of integrators",
            .lacks = "there is no part yet."},
    Command{.id = "study.cycle",
            .title = "Find the limit cycle",
            .help = "Where the steady state is left by swings that grow, or torques drive and there is "
                    "none: the motion that it comes to, in the results.",
            .run =
                [](App& app) {
                  find_cycle(app.session, !app.session.study.periodic.cycle_wanted);
                  set_mode(app.session, Mode::explore);
                },
            .enabled = of_session<may_cycle>,
            .checked = [](const App& app) { return app.session.study.periodic.cycle_wanted; },
            .words = "hunting",
            .lacks = "there is a steady state, and it has no swings that grow."},
    Command{.id = "study.export",
            .title = "Export the run…",
            .help = "Save the motion that is shown as a film: MP4, GIF or numbered pictures.",
            .run = film<Filmed::run>,
            .enabled =
                [](const App& app) { return app.session.motion.on && shown_motion(app.session) != nullptr; },
            .separated = true,
            .lacks = "no motion is shown; M computes one."},
    Command{.id = "study.export_mode",
            .title = "Export the mode…",
            .help = "Save the mode that is shown as a film that begins again without a jump.",
            .run = film<Filmed::mode>,
            .enabled = [](const App& app) { return moving_mode(app.session) != nullptr; },
            .lacks = "no mode is shown; O lists them."},
    save_plot<PlotFile::csv>("study.save_csv", "Save the plot as CSV…",
                             "The numbers of the plot that is shown."),
    save_plot<PlotFile::svg>("study.save_svg", "Save the plot as SVG…",
                             "For papers, of the plot that is shown."),
    save_plot<PlotFile::png>("study.save_png", "Save the plot as PNG…",
                             "A picture of the plot that is shown."),
};

} // namespace

std::span<const Command> study() {
  return study_commands;
}

} // namespace flyball::menus
