// What is under way between the document and the disk.
#pragma once

#include "app/document/autosave.hpp"
#include "app/document/autosaver.hpp"
#include "app/document/change_watch.hpp"
#include "app/document/file_watch.hpp"
#include "app/document/process.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <filesystem>
#include <functional>
#include <optional>
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

struct FileState {
  std::vector<std::filesystem::path> recent;

  FileWatch watch;       // of the document's file
  ChangeWatch changes;   // says when to look; whoever runs the loop makes it one that wakes the loop
  double until_look = 0; // s
  // The file has changed on disk, and there are unsaved edits; the person is to choose.
  bool conflict = false;
  bool save_wanted = false; // he was about to save

  std::string owner = this_process(); // of autosaves
  Autosaver autosave;
  std::vector<Leftover> leftovers; // offered for recovery
  int chosen_leftover = 0;
  std::filesystem::path aside; // the one discarded last, until something is saved

  std::function<void(App&)> then;  // what leaving the document is for, while it is asked about
  std::string message;             // in the dialog: why what was asked for was not done
  std::filesystem::path replacing; // an existing file of which the dialog has said that it would be replaced
  int choice = 0;                  // the button that Enter means
  FolderList list;
  GalleryState gallery;
};

} // namespace flyball
