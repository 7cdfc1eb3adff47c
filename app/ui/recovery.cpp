// What a crash has left: taking it over, or putting it aside.
#include "app/ui/file_commands.hpp"

#include "engine/mechanism/scene.hpp"

#include <algorithm>

namespace flyball {

namespace {

namespace fs = std::filesystem;

void recover_now(App& app, const Leftover& leftover) {
  const fs::path& file = leftover.autosave.file;
  Mechanism mechanism;
  try {
    mechanism = parse_scene(leftover.autosave.scene);
  } catch (const SceneError& error) {
    app.problem = leftover.path.string() + ": " + error.what();
    return;
  }
  app.files.autosave.remove();
  if (app.document.file() != file || app.document.unsaved() || file.empty()) {
    open_document(app, Document());
    app.files.watch = {};
    // Over what the file says now; where it says nothing, over nothing.
    if (!file.empty()) open_scene(app, file);
    if (app.document.file() != file) open_document(app, Document(Document::empty_mechanism(), file));
    if (app.files.watch.file() != file) app.files.watch = FileWatch(file, {});
  }
  app.problem.clear();
  if (!app.files.autosave.adopt(leftover.path, file, {app.options.state, app.files.owner})) {
    show_error(app, "What was left is no longer there; another window may have recovered it.");
    return;
  }
  const bool was_empty = app.mechanism().bodies.empty();
  edit(app, "Recover", [&](Mechanism& present, Selection&) { present = std::move(mechanism); });
  if (was_empty) app.view.fit = true;
  app.notice = "Recovered; not saved yet";
}

} // namespace

void recover(App& app, const Leftover& leftover) {
  leave_document(app, [leftover](App& left) { recover_now(left, leftover); });
}

void discard(App& app, const Leftover& leftover) {
  try {
    app.files.aside = put_aside(leftover.path);
  } catch (const SceneError& error) {
    show_error(app, error.what());
  }
  std::erase_if(app.files.leftovers, [&](const Leftover& one) { return one.path == leftover.path; });
}

void bring_back_discarded(App& app) {
  try {
    bring_back(app.files.aside);
  } catch (const SceneError& error) {
    show_error(app, error.what());
  }
  app.files.aside.clear();
  begin_files(app);
}

} // namespace flyball
