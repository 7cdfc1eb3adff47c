#include "app/ui/file_commands.hpp"

#include "app/document/recent_files.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

#include <utility>

namespace flyball {

namespace {

namespace fs = std::filesystem;

// s: what is no regular file is not waited for longer.
constexpr double patience = 1;

// Another document takes the place of this one, of which nothing is wanted any more.
void replace_document(App& app, Document document, std::string_view text) {
  app.files.autosave.remove();
  app.files.conflict = app.files.save_wanted = false;
  open_document(app, std::move(document));
  app.files.watch = FileWatch(app.document.file(), text);
}

void note_recent(App& app, const fs::path& file) {
  if (!app.options.state.empty()) app.files.recent = add_recent_file(app.options.state, file);
}

// What was left of the file by a crash is offered.
void offer_leftovers(App& app) {
  if (app.options.state.empty()) return;
  app.files.leftovers = find_leftovers(app.document.file(), app.options.state);
  if (!app.files.leftovers.empty()) app.dialog.wanted = Dialog::recover;
}

} // namespace

std::string document_name(const App& app) {
  const fs::path& file = app.document.file();
  return file.empty() ? app.mechanism().name : file.filename().string();
}

bool has_unsaved_work(const App& app) {
  return app.document.unsaved() ||
         (app.files.watch.vanished() && app.files.watch.file() == app.document.file());
}

void leave_document(App& app, std::function<void(App&)> then) {
  if (!has_unsaved_work(app)) return then(app);
  app.files.then = std::move(then);
  app.files.message.clear();
  app.dialog.wanted = Dialog::unsaved;
}

void leave_now(App& app) {
  if (const auto then = std::exchange(app.files.then, {})) then(app);
}

void new_document(App& app) {
  leave_document(app, [](App& left) { replace_document(left, Document(), {}); });
}

void open_scene(App& app, const fs::path& file) {
  try {
    const std::string text = read_bytes(file, patience);
    // What comes from a pipe has no file to be saved to.
    const bool stream = file == "-" || !stamp_of(file);
    const fs::path own = stream ? fs::path() : resolved(file);
    replace_document(app, Document(parse_scene(text), own), text);
  } catch (const SceneError& error) {
    app.problem = error.where() == file.string() ? error.what() : file.string() + ": " + error.what();
  }
}

void open_file(App& app, const fs::path& file) {
  leave_document(app, [file](App& left) {
    left.problem.clear();
    open_scene(left, file);
    if (!left.problem.empty() || left.document.file().empty()) return;
    note_recent(left, left.document.file());
    offer_leftovers(left);
  });
}

std::string save_to(App& app, const fs::path& file) {
  const fs::path own = resolved(file);
  try {
    const std::string text = write_scene(app.document.stored());
    replace_file(own, text);
    app.files.watch = FileWatch(own, text);
  } catch (const SceneError& error) {
    const std::string& why = error.where() == own.string() ? error.expected() : error.what();
    return own.filename().string() + " was not saved: " + why + ".";
  }
  app.document.mark_saved(own);
  app.parameters = parameter_controls(app.mechanism(), app.document.stored());
  app.problem.clear();
  app.files.conflict = app.files.save_wanted = false;
  app.files.aside.clear();
  app.files.autosave.remove();
  if (!app.options.state.empty()) remove_aside(own, app.options.state);
  note_recent(app, own);
  const std::size_t tried = app.document.explored().size();
  app.notice = "Saved " + own.filename().string() +
               (tried == 0   ? ""
                : tried == 1 ? " without the explored value; Keep makes it part of it"
                             : " without the explored values; Keep makes them part of it");
  return {};
}

bool is_example(const App& app) {
  std::error_code ignored;
  const fs::path& file = app.document.file();
  return !file.empty() && !app.options.scenes.empty() &&
         fs::equivalent(file.parent_path(), app.options.scenes, ignored);
}

void save_document(App& app) {
  const fs::path file = app.document.file();
  if (file.empty() || is_example(app)) return show_save_dialog(app);
  FileState& files = app.files;
  if (files.conflict || (files.watch.file() == file && files.watch.differs())) {
    files.conflict = files.save_wanted = true;
    return;
  }
  files.then = {};
  if (std::string why = save_to(app, file); !why.empty()) ask_where_to_save(app, std::move(why));
}

void show_save_dialog(App& app) {
  app.files.then = {};
  ask_where_to_save(app, {});
}

void reload_document(App& app) {
  const fs::path file = app.document.file();
  if (file.empty()) return;
  try {
    const std::string text = read_bytes(file, patience);
    Mechanism theirs = parse_scene(text);
    const bool had_edits = app.document.unsaved();
    edit(app, "Reload", [&](Mechanism& mechanism, Selection&) { mechanism = std::move(theirs); });
    app.document.mark_saved(file);
    app.parameters = parameter_controls(app.mechanism(), app.document.stored());
    app.problem.clear();
    app.files.watch = FileWatch(file, text);
    app.files.conflict = app.files.save_wanted = false;
    app.notice = "Reloaded " + document_name(app) + (had_edits ? "; Undo brings the edits back" : "");
  } catch (const SceneError& error) {
    app.problem = error.where() == file.string() ? error.what() : file.string() + ": " + error.what();
  }
}

void quit(App& app) {
  leave_document(app, [](App& left) {
    left.files.autosave.remove();
    left.quit = true;
  });
}

const std::vector<fs::path>& recent_files(const App& app) {
  return app.files.recent;
}

void begin_files(App& app) {
  const fs::path& state = app.options.state;
  if (state.empty()) return;
  FileState& files = app.files;
  files.recent = read_recent_files(state);
  remove_old_aside(state);
  // Of the open file first, then of what may well be opened next.
  std::vector<fs::path> wanted{app.document.file()};
  if (!app.document.file().empty()) wanted.emplace_back();
  for (const fs::path& file : files.recent)
    if (file != app.document.file()) wanted.push_back(file);
  files.leftovers.clear();
  for (const fs::path& file : wanted)
    for (Leftover& leftover : find_leftovers(file, state))
      files.leftovers.push_back(std::move(leftover));
  if (!files.leftovers.empty()) app.dialog.wanted = Dialog::recover;
}

} // namespace flyball
