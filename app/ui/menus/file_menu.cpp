#include "app/ui/menus/menu_commands.hpp"

#include "app/ui/file_commands.hpp"

#include <array>

namespace flyball::menus {

namespace {

// The model is that which Transfer shows.
void export_model(App& app) {
  if (app.session.study.open != StudyKind::transfer) open_study(app.session, StudyKind::transfer);
  app.panels->model.open(app.session, app.dialog);
}

// Of the mode that moves, or else of the motion, which begins where none is shown.
void export_film(App& app) {
  const Filmed of = moving_mode(app.session) ? Filmed::mode : Filmed::run;
  if (of == Filmed::run && !app.session.motion.on) open_study(app.session, StudyKind::motion);
  app.panels->movie.open(app.session, app.dialog, app.movie, of);
}

const std::array file_commands{
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
            .run = open_dialog_of<&Panels::gallery>,
            .words = "tutorial, templates"},
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
            .enabled = [](const App& app) { return !app.session.document.file().empty(); },
            .lacks = "the document has no file yet."},
    Command{.id = "file.export",
            .title = "Export a picture…",
            .help = "Save what is seen as a PNG file.",
            .key = ctrl('E'),
            .run = [](App& app) { app.panels->picture.open(app.session, app.dialog, app.view.loads); },
            .separated = true,
            .words = "screenshot, image"},
    Command{
        .id = "file.film",
        .title = "Export a film…",
        .help = "Save the mode that moves, or the motion, as MP4, GIF or numbered pictures.",
        .run = export_film,
        .enabled = [](const App& app) { return holds_parts(app.session) && app.session.mistakes.empty(); },
        .words = "movie, video, animation",
        .lacks = "there is nothing that moves: no part yet, or mistakes to be mended."},
    Command{
        .id = "file.report",
        .title = "Export report…",
        .help = "Write all about the steady state into one page: picture, loads, modes, curves, assumptions.",
        .run = open_dialog_of<&Panels::report>,
        .enabled = [](const App& app) { return app.session.mistakes.empty() && !writing_report(app.report); },
        .words = "HTML, print",
        .lacks = "there are mistakes, or a report is being written."},
    Command{.id = "file.model",
            .title = "Export linear model…",
            .help = "Write the linear model about the steady state for MATLAB, Python or NumPy, or as JSON.",
            .run = export_model,
            .enabled = of_session<converged>,
            .words = "state space",
            .lacks = "there is no steady state to make a model about."},
    Command{.id = "file.quit",
            .title = "Quit",
            .help = "Leave the program; asks before unsaved work is lost.",
            .key = ctrl('Q'),
            .run = quit,
            .separated = true},
};

} // namespace

std::span<const Command> file() {
  return file_commands;
}

} // namespace flyball::menus
