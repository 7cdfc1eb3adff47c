// What the dialogs about files show and have been told.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace flyball {

struct App;

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

// A shipped scene in the gallery.
struct SceneCard {
  std::filesystem::path file;
  Mechanism mechanism;
  std::string about;    // the first sentence of its description
  unsigned picture = 0; // OpenGL's; 0 until it is drawn
};
struct GalleryState {
  std::vector<SceneCard> cards;
  int chosen = 0;
  bool showing = false; // in the last frame
  bool drawing = false; // pictures are still to be drawn
};

struct FileDialogState {
  std::function<void(App&)> then;  // what leaving the document is for, while it is asked about
  std::string path;                // typed
  std::string message;             // in the dialog: why what was asked for was not done
  std::filesystem::path replacing; // an existing file of which the dialog has said that it would be replaced
  int choice = 0;                  // the button that Enter means
  int chosen_leftover = 0;
  FolderList list;
  GalleryState gallery;
};

} // namespace flyball
