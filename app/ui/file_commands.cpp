#include "app/ui/file_commands.hpp"

#include "app/ui/app.hpp"

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
  app.file_dialogs.then = std::move(then);
  app.file_dialogs.message.clear();
  app.dialog.wanted = Dialog::unsaved;
}

void leave_now(App& app) {
  if (const auto then = std::exchange(app.file_dialogs.then, {})) then(app);
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
  app.file_dialogs.then = {};
  if (std::string why = save_to(app.session, file); !why.empty())
    ask_where_to_save(app.session, app.dialog, app.file_dialogs, std::move(why));
}

void show_save_dialog(App& app) {
  app.file_dialogs.then = {};
  ask_where_to_save(app.session, app.dialog, app.file_dialogs, {});
}

void quit(App& app) {
  leave_document(app, [](App& left) {
    left.session.files.autosave.remove();
    left.quit = true;
  });
}

} // namespace flyball
