// What goes on between the document and the disk without being asked for.
#include "app/ui/file_commands.hpp"

#include "engine/mechanism/scene.hpp"

#include <algorithm>

namespace flyball {

namespace {

// s between looks at the disk: while the file is being written; where nothing tells of changes; and where the
// folder is watched, as that does not see that a folder above it was renamed.
constexpr double between_looks = 0.5, untold = 2, told = 30;

bool look_at_disk(App& app) {
  const FileWatch::Look look = app.files.watch.look();
  switch (look.news) {
  case FileWatch::News::none: return false;
  case FileWatch::News::vanished:
    show_error(app,
               document_name(app) + " is no longer on disk. It is still open here; saving writes it anew.");
    return true;
  case FileWatch::News::changed: break;
  }
  if (app.document.unsaved()) {
    app.files.conflict = true;
    return true;
  }
  // An editor that saves at every key leaves what cannot be read now and then: no reason for alarm.
  try {
    parse_scene(look.text);
  } catch (const SceneError& error) {
    show_error(app, document_name(app) + " has changed on disk and cannot be read: " + error.what());
    return true;
  }
  reload_document(app);
  return true;
}

AutosaveSettings settings_of(const App& app) {
  return {app.options.state, app.files.owner};
}

// s until the next look.
double next_look(const App& app) {
  const FileState& files = app.files;
  double wait = files.watch.settled() ? (files.changes.tells() ? told : untold) : between_looks;
  if (files.changes.changed()) wait = std::min(wait, between_looks);
  return wait;
}

} // namespace

void note_unsaved_work(App& app) {
  app.files.autosave.note(app.document, has_unsaved_work(app), app.files.watch.hash(), settings_of(app));
}

std::string keep_unsaved_work(App& app) {
  note_unsaved_work(app);
  return app.files.autosave.slot()->write();
}

bool update_files(App& app, double seconds) {
  FileState& files = app.files;
  bool news = false;
  files.until_look = std::min(files.until_look - seconds, next_look(app));
  if (files.until_look <= 0) {
    // First what is to be told of, then the look: nothing between the two is missed.
    files.changes.take_change();
    files.changes.watch(app.document.file());
    if (files.watch.file() == app.document.file()) news = look_at_disk(app);
    files.until_look = next_look(app);
  }
  files.autosave.tick(app.document, has_unsaved_work(app), files.watch.hash(), settings_of(app), seconds);
  if (const std::string problem = files.autosave.take_problem(); !problem.empty()) {
    show_error(app, "Unsaved work cannot be kept for after a crash: " + problem);
    news = true;
  }
  return news;
}

double next_file_update(const App& app) {
  const double autosave = app.files.autosave.due_in();
  return app.document.file().empty() ? autosave : std::min(autosave, std::max(app.files.until_look, 0.));
}

} // namespace flyball
