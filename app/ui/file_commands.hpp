// What the File menu does: asks before unsaved work is lost, and for names of files.
#pragma once

#include "app/session/files.hpp"

#include <filesystem>
#include <functional>

namespace flyball {

struct App;
struct DialogState;
struct Session;

// Does `then` at once where nothing would be lost, otherwise after the person has saved or said not to; never
// where he thinks better of it.
void leave_document(App& app, std::function<void(App&)> then);

void new_document(App& app);                                 // asks first
void open_file(App& app, const std::filesystem::path& file); // asks first
void save_document(App& app); // where it has no file of its own yet, asks for one
void quit(App& app);          // asks first
void show_save_dialog(App& app);

// When the program has started: reads what is kept in options.state, and offers what a crash has left; to
// whoever has `chosen` a file to begin with, nothing of others.
void begin_files(Session& session, DialogState& dialog, bool chosen = false);
// Of files.leftovers, where there are any.
void offer_leftovers(const Session& session, DialogState& dialog);
// See recover_now().
void recover(App& app, const Leftover& leftover); // asks first

// Draws the dialogs and does what a person has answered in them.
void show_dialogs(App& app);

} // namespace flyball
