// What the File menu does: asks before unsaved work is lost, and for names of files.
#pragma once

#include "app/session/files.hpp"

namespace flyball {

struct App;
struct DialogState;
struct FileDialogState;
struct Session;

// Does `then` at once where nothing would be lost, otherwise after the person has saved or said not to; never
// where he thinks better of it.
void leave_document(App& app, std::function<void(App&)> then);

void new_document(App& app);                                 // asks first
void open_file(App& app, const std::filesystem::path& file); // asks first
void show_open_dialog(App& app);
void show_gallery(App& app);  // the shipped scenes with pictures
void save_document(App& app); // where it has no file of its own yet, asks for one
void show_save_dialog(App& app);
void quit(App& app); // asks first
void show_export_dialog(App& app);
void show_report_dialog(App& app);
void show_model_dialog(App& app);      // of the linear model that is shown
void show_movie_dialog(App& app);      // of the motion that is shown
void show_mode_movie_dialog(App& app); // of the mode that is shown

// When the program has started: reads what is kept in options.state, and offers what a crash has left; to
// whoever has `chosen` a file to begin with, nothing of others.
void begin_files(Session& session, DialogState& dialog, bool chosen = false);
// Of files.leftovers, where there are any.
void offer_leftovers(const Session& session, DialogState& dialog);
// See recover_now().
void recover(App& app, const Leftover& leftover); // asks first

// What the dialogs do.

// Does what the document was to be left for.
void leave_now(App& app);
// Asks for a file to save to, keeping what the document is to be left for.
void ask_where_to_save(const Session& session, DialogState& dialog, FileDialogState& file_dialogs,
                       std::string why);

} // namespace flyball
