// Parts of a sweep, each computed by itself: a first line that says of what it is a part, then rows of CSV.
// Put together they are the file that one process would have written.
#pragma once

#include "app/cli/sweep_columns.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

struct Shard {
  std::uint64_t number = 1, of = 1; // from 1
};
// "3/64". Throws SceneError naming the option.
Shard parse_shard(std::string_view option, std::string_view text);

struct SweepPart {
  std::string version; // of the program
  std::string scene;   // hash of the scene with its settings, as 16 figures
  std::vector<Variation> variations;
  std::vector<std::string> columns; // of the rows
  std::uint64_t rows = 0;           // of all parts together
  Shard shard;

  SweepPart() = default;
  SweepPart(const Mechanism& mechanism, const SweepColumns& columns, const Shard& shard);

  std::uint64_t begin() const { return rows * (shard.number - 1) / shard.of; } // its rows
  std::uint64_t end() const { return rows * shard.number / shard.of; }
  std::string head() const; // the first line
  // What the other is of, where that is not the same: "scene", "variations", ...; else empty.
  std::string differs_from(const SweepPart& other) const;
};

// From a file's first line. Throws SceneError that names the file.
SweepPart read_part_head(const std::filesystem::path& file, std::string_view line);

} // namespace flyball::cli
