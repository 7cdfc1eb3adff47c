// Parts of a study's rows, each computed by itself: a first line that says of what it is a part, rows of CSV,
// and a last line with their number and hash. Put together they are the file that one process would have
// written.
#pragma once

#include "app/cli/row_output.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace flyball::cli {

struct Shard {
  std::uint64_t number = 1, of = 1; // from 1
};
// "3/64". Throws SceneError naming the option.
Shard parse_shard(std::string_view option, std::string_view text);
// Adds --shard, which needs the file that --csv names.
CLI::Option* add_shard(CLI::App& command, std::string& text, CLI::Option* csv);

struct StudyPart {
  std::string study;              // the command: "sweep"
  std::string version;            // of the program
  std::string scene;              // hash of the scene with its settings, as 16 figures
  nlohmann::ordered_json request; // what was asked for, each thing by its name: "variations"
  std::vector<Column> columns;    // of the rows
  std::uint64_t count = 0;        // of what all parts together share: points, samples
  Shard shard;
  nlohmann::ordered_json told; // what is to be known of all of it besides its rows

  std::uint64_t begin() const { return count * (shard.number - 1) / shard.of; } // its share
  std::uint64_t end() const { return count * shard.number / shard.of; }
  // What the other is of, where that is not the same: "scene", "variations", ...; else empty.
  std::string differs_from(const StudyPart& other) const;
};

StudyPart part_of(std::string study, const Mechanism& mechanism, nlohmann::ordered_json request,
                  std::vector<Column> columns, std::uint64_t count);

// A file with the part's rows, which come as CSV.
std::unique_ptr<RowOutput> part_output(const StudyPart& part, const std::filesystem::path& file);

// From a file's first line. Throws SceneError that names the file.
StudyPart read_part_head(const std::filesystem::path& file, std::string_view line);
// What a last line tells of those before it; nothing where it is none.
struct PartEnd {
  std::uint64_t rows = 0;
  std::uint64_t hash = 0; // FNV-1a of their bytes, the first line's too
  bool operator==(const PartEnd&) const = default;
};
std::optional<PartEnd> read_part_end(std::string_view line);
// The hash of `text` behind what has the hash `behind`.
std::uint64_t part_hash(std::string_view text, std::uint64_t behind = 0xcbf29ce484222325U);

} // namespace flyball::cli
