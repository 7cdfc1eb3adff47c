// What dialogs that open and save share: a field for a name or path, and the folder's entries to choose from.
#pragma once

#include "app/ui/widgets/file_query.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace flyball {

struct Session;
struct Ui;

// What was typed, as a path: from the home folder after "~", otherwise from the folder that is shown.
std::filesystem::path typed_path(const FileQuery& query);
// The same with an extension, unless it is a folder or has it.
std::filesystem::path typed_file(const FileQuery& query, const std::string& extension);

// Shows a folder next, from its beginning.
void show_folder(FileQuery& query, const std::filesystem::path& folder);
// The field; returns whether Enter was pressed in it. It has the keyboard when the dialog appears and after
// Enter.
bool path_field(Ui& ui, FileQuery& query, const std::string& name, const char* hint);
// Where the dialog looks, and a way up.
void folder_line(Ui& ui, FileQuery& query, const std::string& name);

// The folders and files of the extension. `filtered`: those that what was typed is part of, and the arrow
// keys choose among them; otherwise all. A folder that is clicked is shown next; returns the file that was
// clicked.
std::optional<std::filesystem::path> file_list(Ui& ui, FileQuery& query, const std::string& name,
                                               const std::string& extension, bool filtered, float height);
// What Enter means: the entry that the arrow keys have chosen, else what was typed, else the first of the
// filtered ones. A folder is shown next; returns a file.
std::optional<std::filesystem::path> entered_file(FileQuery& query, bool filtered);

// Whether writing there may go ahead: its folder is there and nothing of the name, or it is the document's
// own file, or the person was told what is not so and pressed again. A folder that was missing is there then;
// where it cannot be made, the query's message says why.
bool may_write_to(const Session& session, FileQuery& query, const std::filesystem::path& file);
// Asks whether to replace the file, or to make its folder, where the person was just kept from it: what the
// button then says. Null where nothing is asked.
const char* asked_before_writing(Ui& ui, const FileQuery& query, const std::filesystem::path& file);

// Where a file that has no place yet may be put: the folder of the document, unless it is an example; what
// was used lately, the current folder, the home folder.
std::filesystem::path usual_folder(const Session& session);
// A name for a file from words: "Swing pendulum" is swing_pendulum.
std::string file_stem(const std::string& words);
// What files about the document are called: as its own without ".json" or ".flyball.json", or as the
// mechanism.
std::string file_stem(const Session& session);

} // namespace flyball
