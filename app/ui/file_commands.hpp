// Documents and files: what the File menu does, asking before unsaved work is lost, autosave and recovery.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// The file's name, or the mechanism's where it has no file.
std::string document_name(const App& app);
// Whether closing the document would lose something: edits, or what is in no file any more.
bool has_unsaved_work(const App& app);

// Does `then` at once where nothing would be lost, otherwise after the person has saved or said not to; never
// where he thinks better of it.
void leave_document(App& app, std::function<void(App&)> then);

void new_document(App& app);                                 // asks first
void open_file(App& app, const std::filesystem::path& file); // asks first
void show_open_dialog(App& app);
void show_gallery(App& app);  // the shipped scenes with pictures
void save_document(App& app); // where it has no file of its own yet, asks for one
// Whether the open file is a shipped scene, which saving leaves as it is unless it is chosen by name.
bool is_example(const App& app);
void show_save_dialog(App& app);
void reload_document(App& app); // from its file, as it is there now: a step that can be undone
void quit(App& app);            // asks first
void show_export_dialog(App& app);
void show_movie_dialog(App& app); // of the motion that is shown

// Files opened lately, the newest first.
const std::vector<std::filesystem::path>& recent_files(const App& app);

// When the program has started: reads what is kept in options.state, and offers what a crash has left.
void begin_files(App& app);
// What there is to lose, for whoever has to write it at once; after every frame.
void note_unsaved_work(App& app);
// Writes unsaved work where the next start offers it: the program is about to end. Returns why it could not.
std::string keep_unsaved_work(App& app);
// Once a frame, `seconds` after the last: autosaves what changed, and looks whether the file has changed on
// disk. Returns whether there is anything new to show.
bool update_files(App& app, double seconds);
// s until update_files() has something to do.
double next_file_update(const App& app);

// What the dialogs do.

// Writes the document to a file, which is its own from then on. Returns why it could not, and then nothing
// has changed.
std::string save_to(App& app, const std::filesystem::path& file);
// Does what the document was to be left for.
void leave_now(App& app);
// Asks for a file to save to, keeping what the document is to be left for.
void ask_where_to_save(App& app, std::string why);
// Takes a leftover's work as a step over what the file says; it becomes this document's autosave.
void recover(App& app, const Leftover& leftover); // asks first
void discard(App& app, const Leftover& leftover);
void bring_back_discarded(App& app);

} // namespace flyball
