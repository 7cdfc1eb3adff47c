// What is kept of unsaved work, for after a crash: a file beside the document's with a line that says what it
// is of, and then the scene as it would have been saved.
#pragma once

#include "app/document/body_hues.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct Autosave {
  std::filesystem::path file; // of the document; empty for one without
  std::string name;           // of the mechanism
  std::uint64_t based_on = 0; // text_hash of what the file held; 0 without one
  std::string owner;          // the process that wrote it; see process.hpp
  std::int64_t made = 0;      // s since 1970
  std::string scene;          // text
  NamedHues hues;             // of its bodies, where they are not those that names ask for
};

std::string write_autosave(const Autosave& autosave);
// Throws SceneError for text that is no autosave.
Autosave parse_autosave(std::string_view text);

// Where the process `number` may keep it, the best place first: beside the file, else in the state folder.
// The names are taken by nothing yet.
std::vector<std::filesystem::path> autosave_places(const std::filesystem::path& file,
                                                   const std::filesystem::path& state_folder);

// What a program that no longer runs has left.
struct Leftover {
  std::filesystem::path path;
  Autosave autosave;
  bool outdated = false; // the document's file holds something else than the work was begun on
};
// Those of a document's file, or where it is empty of documents without one; the newest first. Those without
// news, because the file holds the same, are removed.
std::vector<Leftover> find_leftovers(const std::filesystem::path& file,
                                     const std::filesystem::path& state_folder);

// Puts a leftover aside, where find_leftovers does not see it; returns where it is then. Throws SceneError.
std::filesystem::path put_aside(const std::filesystem::path& leftover);
// The way back; returns where it was before. Throws SceneError.
std::filesystem::path bring_back(const std::filesystem::path& aside);
// Removes what was put aside of a file, where something newer was saved.
void remove_aside(const std::filesystem::path& file, const std::filesystem::path& state_folder);
// Removes everything in the state folder that was put aside more than a month ago.
void remove_old_aside(const std::filesystem::path& state_folder);

} // namespace flyball
