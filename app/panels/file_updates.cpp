// What goes on between the document and the disk without being asked for.
#include "app/panels/file_commands.hpp"

#include "engine/mechanism/scene.hpp"

#include <algorithm>

namespace flyball {

namespace {

constexpr double between_looks = 0.5; // s

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

} // namespace

bool update_files(App& app, double seconds) {
  FileState& files = app.files;
  bool news = false;
  files.until_look -= seconds;
  if (files.until_look <= 0) {
    files.until_look = between_looks;
    if (files.watch.file() == app.document.file()) news = look_at_disk(app);
  }
  files.autosave.tick(app.document, has_unsaved_work(app), files.watch.hash(),
                      {app.options.state, files.owner}, seconds);
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
