#include "app/session/files.hpp"

#include "app/document/recent_files.hpp"
#include "app/session/session.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

namespace flyball {

namespace {

namespace fs = std::filesystem;

// s: what is no regular file is not waited for longer.
constexpr double patience = 1;

} // namespace

std::string document_name(const Session& session) {
  const fs::path& file = session.document.file();
  return file.empty() ? session.mechanism().name : file.filename().string();
}

bool has_unsaved_work(const Session& session) {
  return session.document.unsaved() ||
         (session.files.watch.vanished() && session.files.watch.file() == session.document.file());
}

bool is_example(const Session& session) {
  std::error_code ignored;
  const fs::path& file = session.document.file();
  return !file.empty() && !session.options.scenes.empty() &&
         fs::equivalent(file.parent_path(), session.options.scenes, ignored);
}

void replace_document(Session& session, Document document, std::string_view text) {
  keep_beside_now(session);
  session.files.beside = {};
  session.files.beside_refused = false;
  session.files.autosave.remove();
  session.files.conflict = session.files.save_wanted = false;
  session.files.aside.clear();
  open_document(session, std::move(document));
  session.files.watch = FileWatch(session.document.file(), text);
}

namespace {

// What was tried when the file was last open stands beside it again.
void bring_back_explored(Session& session) {
  const Explored explored = still_explored(session.files.beside, session.mechanism());
  if (explored.empty() || is_example(session)) return;
  const std::string step = "Explored last time";
  if (session.mode == Mode::explore) {
    change_parameters(session, step, explored);
  } else {
    try {
      session.document.explore(step, explored);
    } catch (const SceneError&) { // the file has become another
    }
  }
  session.files.beside_refused = session.document.explored().empty();
  if (!session.files.beside_refused)
    session.notice =
        "Values that were explored last time are back: Keep makes them part of the document, Back "
        "leaves them.";
}

// "swing_pendulum.flyball" as a person would write it.
std::string words_of(std::string stem) {
  if (stem.ends_with(".flyball")) stem.resize(stem.rfind('.'));
  for (char& c : stem)
    if (c == '_') c = ' ';
  if (!stem.empty() && stem[0] >= 'a' && stem[0] <= 'z') stem[0] = static_cast<char>(stem[0] - 'a' + 'A');
  return stem;
}

} // namespace

void note_recent(Session& session, const fs::path& file) {
  if (!session.options.state.empty()) session.files.recent = add_recent_file(session.options.state, file);
}

void open_scene(Session& session, const fs::path& file) {
  keep_beside_now(session); // it may be of the same file
  try {
    const std::string text = read_bytes(file, patience);
    // What comes from a pipe has no file to be saved to.
    const bool stream = file == "-" || !stamp_of(file);
    const fs::path own = stream ? fs::path() : resolved(file);
    KeptBeside beside = read_beside(session.options.state, own);
    replace_document(session, Document(parse_scene(text), own, beside.hues), text);
    session.files.beside = std::move(beside);
    bring_back_explored(session);
  } catch (const SceneError& error) {
    session.problem = error.where() == file.string() ? error.what() : file.string() + ": " + error.what();
  }
}

std::string save_to(Session& session, const fs::path& file) {
  const fs::path own = resolved(file);
  const bool first = session.document.file().empty();
  Mechanism written = session.document.stored();
  if (first && written.name == Document::empty_mechanism().name) written.name = words_of(own.stem().string());
  try {
    const std::string text = write_scene(written);
    replace_file(own, text);
    session.files.watch = FileWatch(own, text);
  } catch (const SceneError& error) {
    const std::string& why = error.where() == own.string() ? error.expected() : error.what();
    return own.filename().string() + " was not saved: " + why + ".";
  }
  session.document.name_untitled(written.name);
  session.document.mark_saved(own);
  session.parameters = parameter_controls(session.mechanism(), session.document.stored(), session.units);
  session.problem.clear();
  session.files.conflict = session.files.save_wanted = false;
  session.files.aside.clear();
  session.files.autosave.remove();
  if (!session.options.state.empty()) remove_aside(own, session.options.state);
  note_explored(session);
  session.files.beside.hues = hues_to_keep(session.document.stored(), session.document.hues());
  keep_beside(session.options.state, own, session.files.beside);
  note_recent(session, own);
  const std::size_t tried = session.document.explored().size();
  session.notice = "Saved " + own.filename().string() +
                   (tried == 0   ? ""
                    : tried == 1 ? " without the explored value; Keep makes it part of it"
                                 : " without the explored values; Keep makes them part of it");
  return {};
}

void reload_document(Session& session) {
  const fs::path file = session.document.file();
  if (file.empty()) return;
  try {
    const std::string text = read_bytes(file, patience);
    Mechanism theirs = parse_scene(text);
    const bool had_edits = session.document.unsaved();
    replace_mechanism(session, "Reload", std::move(theirs));
    session.document.mark_saved(file);
    session.parameters = parameter_controls(session.mechanism(), session.document.stored(), session.units);
    session.problem.clear();
    session.files.watch = FileWatch(file, text);
    session.files.conflict = session.files.save_wanted = false;
    session.notice = "Reloaded " + document_name(session) + (had_edits ? "; Undo brings the edits back" : "");
  } catch (const SceneError& error) {
    session.problem = error.where() == file.string() ? error.what() : file.string() + ": " + error.what();
  }
}

void read_kept_files(Session& session, bool others) {
  const fs::path& state = session.options.state;
  if (state.empty()) return;
  FileState& files = session.files;
  files.recent = read_recent_files(state);
  remove_old_aside(state);
  // Of the open file first, then of what may well be opened next.
  std::vector<fs::path> wanted{session.document.file()};
  if (!session.document.file().empty()) wanted.emplace_back();
  for (const fs::path& file : files.recent)
    if (others && file != session.document.file()) wanted.push_back(file);
  files.leftovers.clear();
  for (const fs::path& file : wanted)
    for (Leftover& leftover : find_leftovers(file, state))
      files.leftovers.push_back(std::move(leftover));
}

void find_own_leftovers(Session& session) {
  if (session.options.state.empty()) return;
  session.files.leftovers = find_leftovers(session.document.file(), session.options.state);
}

} // namespace flyball
