#include "app/ui/file_commands.hpp"

#include "app/ui/app.hpp"
#include "app/ui/panel_list.hpp"

#include <utility>

namespace flyball {

namespace {

namespace fs = std::filesystem;

} // namespace

void offer_leftovers(const Session& session, DialogState& dialog) {
  if (!session.files.leftovers.empty()) dialog.wanted = Dialog::recover;
}

void begin_files(Session& session, DialogState& dialog, bool chosen) {
  read_kept_files(session, !chosen);
  offer_leftovers(session, dialog);
}

void leave_document(App& app, std::function<void(App&)> then) {
  if (!has_unsaved_work(app.session)) return then(app);
  app.leaving = std::move(then);
  app.dialog.wanted = Dialog::unsaved;
}

void new_document(App& app) {
  leave_document(app, [](App& left) { replace_document(left.session, Document(), {}); });
}

void open_file(App& app, const fs::path& file) {
  leave_document(app, [file](App& left) {
    left.session.problem.clear();
    open_scene(left.session, file);
    if (!left.session.problem.empty() || left.session.document.file().empty()) return;
    note_recent(left.session, left.session.document.file());
    find_own_leftovers(left.session);
    offer_leftovers(left.session, left.dialog);
  });
}

void recover(App& app, const Leftover& leftover) {
  leave_document(app, [leftover](App& left) {
    const bool was_empty = left.session.mechanism().bodies.empty();
    recover_now(left.session, leftover);
    if (was_empty) left.view.fit = true;
  });
}

void save_document(App& app) {
  const fs::path file = app.session.document.file();
  if (file.empty() || is_example(app.session)) return show_save_dialog(app);
  FileState& files = app.session.files;
  if (files.conflict || (files.watch.file() == file && files.watch.differs())) {
    files.conflict = files.save_wanted = true;
    return;
  }
  app.leaving = {};
  if (std::string why = save_to(app.session, file); !why.empty())
    app.panels->save.open(app.session, app.dialog, std::move(why));
}

void show_save_dialog(App& app) {
  app.leaving = {};
  app.panels->save.open(app.session, app.dialog, {});
}

void quit(App& app) {
  leave_document(app, [](App& left) {
    left.session.files.autosave.remove();
    left.quit = true;
  });
}

namespace {

// Does what the document was to be left for.
void leave_now(App& app) {
  if (const auto then = std::exchange(app.leaving, {})) then(app);
}

// And then leaves; where that takes a file to save to, asks for it, keeping what it is to be left for.
void save_first(App& app) {
  Session& session = app.session;
  std::string why;
  if (!session.document.file().empty() && !is_example(session)) {
    why = save_to(session, session.document.file());
    if (why.empty()) return leave_now(app);
  }
  app.panels->save.open(session, app.dialog, std::move(why));
}

void ask_for_scenes(App& app) {
  Panels& panels = *app.panels;
  const OpenDialog::Answer open = panels.open.draw(app.session, app.ui, app.dialog);
  if (open.examples) panels.gallery.open(app.session, app.dialog);
  if (!open.file.empty()) open_file(app, open.file);
  switch (panels.save.draw(app.session, app.ui, app.dialog)) {
  case SaveDialog::Answer::none: break;
  case SaveDialog::Answer::saved: leave_now(app); break;
  case SaveDialog::Answer::cancelled: app.leaving = {}; break;
  }
  const GalleryDialog::Answer shown = panels.gallery.draw(app.ui, app.dialog);
  if (shown.other) panels.open.open(app.session, app.dialog);
  if (!shown.file.empty()) open_file(app, shown.file);
}

void ask_for_exports(App& app) {
  Panels& panels = *app.panels;
  if (auto wanted = panels.picture.draw(app.session, app.ui, app.dialog)) app.export_request = wanted;
  if (auto wanted = panels.report.draw(app.session, app.ui, app.dialog, writing_report(app.report)))
    app.export_request = wanted;
  panels.model.draw(app.session, app.ui, app.dialog);
  panels.movie.draw(app.session, app.ui, app.dialog, app.movie);
  if (auto wanted = panels.plot.draw(app.session, app.ui, app.dialog)) app.export_request = wanted;
}

} // namespace

void show_dialogs(App& app) {
  ask_for_scenes(app);
  ask_for_exports(app);
  app.panels->copies.draw(app.session, app.ui, app.dialog);
  if (const auto wanted = app.panels->recovery.draw(app.session, app.ui, app.dialog)) recover(app, *wanted);
  const auto answer = app.panels->unsaved.draw(app.session, app.ui, app.dialog);
  if (answer == UnsavedDialog::Answer::save) save_first(app);
  if (answer == UnsavedDialog::Answer::discard) leave_now(app);
  if (answer == UnsavedDialog::Answer::cancel) app.leaving = {};
}

} // namespace flyball
