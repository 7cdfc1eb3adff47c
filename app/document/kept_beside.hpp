// What is kept of a document beside its file, from one time it is open to the next: numbers that were tried
// while exploring, and which colours its bodies had when it was saved. A scene file has neither.
#pragma once

#include "app/document/body_hues.hpp"
#include "app/document/explored.hpp"

#include <filesystem>

namespace flyball {

struct KeptBeside {
  Explored explored;
  Explored stored; // the numbers that stood beneath these
  NamedHues hues;  // where they are not those that names ask for
  bool operator==(const KeptBeside&) const = default;
};

// What is tried, and what the mechanism has there.
void keep_explored(KeptBeside& kept, const Mechanism& stored, const Explored& explored);
// What was tried over the numbers that the mechanism still has; what has become another since counts.
Explored still_explored(const KeptBeside& kept, const Mechanism& mechanism);

// Nothing where nothing is kept of the file, or what is cannot be read.
KeptBeside read_beside(const std::filesystem::path& state_folder, const std::filesystem::path& file);
// In the place of what was kept; of the files that this was last done for. Where it cannot be kept, as of a
// file whose name is not UTF-8, nobody is disturbed.
void keep_beside(const std::filesystem::path& state_folder, const std::filesystem::path& file,
                 const KeptBeside& kept);
inline constexpr std::size_t most_kept_beside = 100; // files

} // namespace flyball
