// What goes on between the document and the disk: opening, saving, autosave, recovery, and what others do to
// the file. Nothing here asks a person anything.
#pragma once

#include "app/document/autosave.hpp"
#include "app/document/autosaver.hpp"
#include "app/document/file_watch.hpp"
#include "app/document/kept_beside.hpp"
#include "app/platform/change_watch.hpp"
#include "app/platform/process.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace flyball {

class Document;
struct Session;

struct FileState {
  std::vector<std::filesystem::path> recent; // opened lately, the newest first

  FileWatch watch;       // of the document's file
  ChangeWatch changes;   // says when to look; whoever runs the loop makes it one that wakes the loop
  double until_look = 0; // s
  // The file has changed on disk, and there are unsaved edits; the person is to choose.
  bool conflict = false;
  bool save_wanted = false; // he was about to save

  KeptBeside beside;                 // what is kept of the open document beside its file
  bool beside_refused = false;       // what it has explored cannot be, as the scene is now: it stays kept
  std::uint64_t beside_revision = 0; // of the document, last looked at
  double until_kept = std::numeric_limits<double>::infinity(); // s

  std::string owner = this_process(); // of autosaves
  Autosaver autosave;
  std::vector<Leftover> leftovers; // offered for recovery
  std::filesystem::path aside;     // the one discarded last, until something is saved or opened
};

// The file's name, or the mechanism's where it has no file.
std::string document_name(const Session& session);
// Whether closing the document would lose something: edits, or what is in no file any more.
bool has_unsaved_work(const Session& session);
// Whether the open file is a shipped scene, which saving leaves as it is unless it is chosen by name.
bool is_example(const Session& session);

// Another document takes the place of this one, of which nothing is wanted any more. `text` is its file's.
void replace_document(Session& session, Document document, std::string_view text);
// Reads and opens a scene, finished or not; where it cannot be read, says so in `problem` and leaves the open
// one as it is.
void open_scene(Session& session, const std::filesystem::path& file);
// Among the files opened lately, from now on.
void note_recent(Session& session, const std::filesystem::path& file);
// Writes the document to a file, which is its own from then on; a mechanism that nobody has named is called
// as its first file is. Returns why it could not, and then nothing has changed.
std::string save_to(Session& session, const std::filesystem::path& file);
void reload_document(Session& session); // from its file, as it is there now: a step that can be undone

// When the program has started: what is kept in options.state. What a crash has left is in files.leftovers:
// of the open file, of what had none, and of `others` that may well be opened next.
void read_kept_files(Session& session, bool others = true);
// What a crash has left of the open file, into files.leftovers.
void find_own_leftovers(Session& session);
// What there is to lose, for whoever has to write it at once; after every frame.
void note_unsaved_work(Session& session);
// Writes unsaved work where the next start offers it: the program is about to end. Returns why it could not.
std::string keep_unsaved_work(Session& session);
// What is explored now takes the place of what is kept so beside the file; whether that is another.
bool note_explored(Session& session);
// Keeps beside the open document's file what there is to keep, at once: it is left.
void keep_beside_now(Session& session);
// Once a frame, `seconds` after the last: autosaves what changed, and looks whether the file has changed on
// disk. Returns whether there is anything new to show.
bool update_files(Session& session, double seconds);
// s until update_files() has something to do.
double next_file_update(const Session& session);

// Takes a leftover's work as a step over what the file says; it becomes this document's autosave. What was
// open is gone.
void recover_now(Session& session, const Leftover& leftover);
void discard(Session& session, const Leftover& leftover);
void bring_back_discarded(Session& session); // and reads anew what is kept

} // namespace flyball
