// What a crash has left: taking it over, or putting it aside.
#include "app/session/files.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>

namespace flyball {

namespace {

namespace fs = std::filesystem;

} // namespace

void recover_now(Session& session, const Leftover& leftover) {
  const fs::path& file = leftover.autosave.file;
  Mechanism mechanism;
  try {
    mechanism = parse_scene(leftover.autosave.scene);
  } catch (const SceneError& error) {
    session.problem = leftover.path.string() + ": " + error.what();
    return;
  }
  session.files.autosave.remove();
  if (session.document.file() != file || session.document.unsaved() || file.empty()) {
    open_document(session, Document());
    session.files.watch = {};
    session.files.beside = {};
    session.files.beside_refused = false;
    // Over what the file says now; where it says nothing, over nothing.
    if (!file.empty()) open_scene(session, file);
    if (session.document.file() != file) open_document(session, Document(Document::empty_mechanism(), file));
    if (session.files.watch.file() != file) session.files.watch = FileWatch(file, {});
  }
  session.problem.clear();
  if (!session.files.autosave.adopt(leftover.path, file, {session.options.state, session.files.owner})) {
    show_error(session, "What was left is no longer there; another window may have recovered it.");
    return;
  }
  replace_mechanism(session, "Recover", std::move(mechanism), leftover.autosave.hues);
  session.notice = "Recovered; not saved yet";
}

void discard(Session& session, const Leftover& leftover) {
  try {
    session.files.aside = put_aside(leftover.path);
  } catch (const SceneError& error) {
    show_error(session, error.what());
  }
  std::erase_if(session.files.leftovers, [&](const Leftover& one) { return one.path == leftover.path; });
}

void bring_back_discarded(Session& session) {
  try {
    bring_back(session.files.aside);
  } catch (const SceneError& error) {
    show_error(session, error.what());
  }
  session.files.aside.clear();
  read_kept_files(session);
}

} // namespace flyball
