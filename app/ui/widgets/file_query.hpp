// What a dialog that asks for a file shows and has been told.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flyball {

// The folder that a dialog lists.
struct FolderEntry {
  std::filesystem::path path;
  bool folder = false;
};
struct FolderList {
  std::filesystem::path shown; // where names that are typed are looked for
  std::filesystem::path read;  // whose entries these are; empty: to be read
  std::vector<FolderEntry> entries;
  int chosen = -1; // of those listed, by the arrow keys
};

struct FileQuery {
  std::string path;    // typed
  std::string message; // in the dialog: why what was asked for was not done
  // A file of which the dialog has said that it would be replaced, or that there is no folder for it.
  std::filesystem::path asked;
  FolderList list;
};

} // namespace flyball
