// The files opened or saved lately, kept from one run of the program to the next.
#pragma once

#include <filesystem>
#include <vector>

namespace flyball {

inline constexpr std::size_t most_recent_files = 10;

// Newest first; without those that are no longer there. An unreadable list is an empty one.
std::vector<std::filesystem::path> read_recent_files(const std::filesystem::path& state_folder);

// Puts the file first, beside what other instances have added meanwhile, and returns the list. Where it
// cannot be kept it is returned all the same.
std::vector<std::filesystem::path> add_recent_file(const std::filesystem::path& state_folder,
                                                   const std::filesystem::path& file);

} // namespace flyball
