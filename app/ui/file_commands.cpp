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
  if (!has_unsaved_work(app)) return then(app);
  app.file_dialogs.then = std::move(then);
  app.file_dialogs.message.clear();
  app.dialog.wanted = Dialog::unsaved;
}

void leave_now(App& app) {
  if (const auto then = std::exchange(app.file_dialogs.then, {})) then(app);
}

void new_document(App& app) {
  leave_document(app, [](App& left) { replace_document(left, Document(), {}); });
}

void open_file(App& app, const fs::path& file) {
  leave_document(app, [file](App& left) {
    left.problem.clear();
    open_scene(left, file);
    if (!left.problem.empty() || left.document.file().empty()) return;
    note_recent(left, left.document.file());
    find_own_leftovers(left);
    offer_leftovers(left, left.dialog);
  });
}

void recover(App& app, const Leftover& leftover) {
  leave_document(app, [leftover](App& left) {
    const bool was_empty = left.mechanism().bodies.empty();
    recover_now(left, leftover);
    if (was_empty) left.view.fit = true;
  });
}

void save_document(App& app) {
  const fs::path file = app.document.file();
  if (file.empty() || is_example(app)) return show_save_dialog(app);
  FileState& files = app.files;
  if (files.conflict || (files.watch.file() == file && files.watch.differs())) {
    files.conflict = files.save_wanted = true;
    return;
  }
  app.file_dialogs.then = {};
  if (std::string why = save_to(app, file); !why.empty())
    ask_where_to_save(app, app.dialog, app.file_dialogs, std::move(why));
}

void show_save_dialog(App& app) {
  app.file_dialogs.then = {};
  ask_where_to_save(app, app.dialog, app.file_dialogs, {});
}

void quit(App& app) {
  leave_document(app, [](App& left) {
    left.files.autosave.remove();
    left.quit = true;
  });
}

} // namespace flyball
