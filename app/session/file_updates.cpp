// What goes on between the document and the disk without being asked for.
#include "app/session/files.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>

namespace flyball {

namespace {

// s between looks at the disk: while the file is being written; where nothing tells of changes; and where the
// folder is watched, as that does not see that a folder above it was renamed.
constexpr double between_looks = 0.5, untold = 2, told = 30;

std::string no_longer_there(const Session& session) {
  return document_name(session) + " is no longer on disk. It is still open here; saving writes it anew.";
}

bool look_at_disk(Session& session) {
  const FileWatch::Look look = session.files.watch.look();
  switch (look.news) {
  case FileWatch::News::none: return false;
  case FileWatch::News::vanished:
    session.files.conflict = session.files.save_wanted = false; // with nothing any more
    show_error(session, no_longer_there(session));
    return true;
  case FileWatch::News::changed: break;
  }
  if (session.notice == no_longer_there(session)) session.notice.clear(); // there it is
  if (session.document.unsaved()) {
    session.files.conflict = true;
    return true;
  }
  // An editor that saves at every key leaves what cannot be read now and then: no reason for alarm.
  try {
    parse_scene(look.text);
  } catch (const SceneError& error) {
    show_error(session, document_name(session) + " has changed on disk and cannot be read: " + error.what());
    return true;
  }
  reload_document(session);
  return true;
}

AutosaveSettings settings_of(const Session& session) {
  return {session.options.state, session.files.owner};
}

// s until the next look.
double next_look(const Session& session) {
  const FileState& files = session.files;
  double wait = files.watch.settled() ? (files.changes.tells() ? told : untold) : between_looks;
  if (files.changes.changed()) wait = std::min(wait, between_looks);
  return wait;
}

// Numbers that are tried are written once the hand has paused.
void keep_beside_later(Session& session, double seconds) {
  constexpr double pause = 1; // s
  constexpr double never = std::numeric_limits<double>::infinity();
  FileState& files = session.files;
  if (files.beside_revision != session.document.revision()) {
    files.beside_revision = session.document.revision();
    files.until_kept = files.beside.explored == session.document.explored() ? never : pause;
  }
  files.until_kept -= seconds;
  if (files.until_kept <= 0) keep_beside_now(session);
}

} // namespace

bool note_explored(Session& session) {
  FileState& files = session.files;
  const Explored& explored = session.document.explored();
  if (!explored.empty()) files.beside_refused = false;
  if (files.beside_refused) return false;
  const bool another = files.beside.explored != explored;
  keep_explored(files.beside, session.document.stored(), explored);
  return another;
}

void keep_beside_now(Session& session) {
  FileState& files = session.files;
  files.until_kept = std::numeric_limits<double>::infinity();
  if (is_example(session) || !note_explored(session)) return;
  keep_beside(session.options.state, session.document.file(), files.beside);
}

void note_unsaved_work(Session& session) {
  session.files.autosave.note(session.document, has_unsaved_work(session), session.files.watch.hash(),
                              settings_of(session));
}

std::string keep_unsaved_work(Session& session) {
  note_unsaved_work(session);
  return session.files.autosave.slot()->write();
}

bool update_files(Session& session, double seconds) {
  FileState& files = session.files;
  keep_beside_later(session, seconds);
  bool news = false;
  files.until_look = std::min(files.until_look - seconds, next_look(session));
  if (files.until_look <= 0) {
    // First what is to be told of, then the look: nothing between the two is missed.
    files.changes.take_change();
    files.changes.watch(session.document.file());
    if (files.watch.file() == session.document.file()) news = look_at_disk(session);
    files.until_look = next_look(session);
  }
  files.autosave.tick(session.document, has_unsaved_work(session), files.watch.hash(), settings_of(session),
                      seconds);
  if (const std::string problem = files.autosave.take_problem(); !problem.empty()) {
    show_error(session, "Unsaved work cannot be kept for after a crash: " + problem);
    news = true;
  }
  return news;
}

double next_file_update(const Session& session) {
  const double autosave = std::min(session.files.autosave.due_in(), std::max(session.files.until_kept, 0.));
  return session.document.file().empty() ? autosave
                                         : std::min(autosave, std::max(session.files.until_look, 0.));
}

} // namespace flyball
