// What a command puts out: text and JSON that are safe on a terminal, and files that do not overwrite its
// input.
#pragma once

#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

// To standard output, without control characters but line ends (see printable_lines).
void print_text(std::string_view text);
// To standard output, indented, with a line end; control characters are escaped as JSON does.
void print_json(const nlohmann::ordered_json& json);

// A coordinate's name for text in one line; see coordinate_label() and printable().
template <class Coordinate>
std::string shown_label(const Coordinate& c) {
  return printable(coordinate_label(c));
}

// Columns two blanks apart, numbers to the right; with `names` the first column has names, to the left and
// indented.
std::string aligned(const std::vector<std::vector<std::string>>& rows, bool names = false);

struct OutputFile {
  const char* option;         // "--csv"
  std::filesystem::path file; // empty: not asked for
};
// Throws SceneError where a file would replace the scene that is read, by whatever name or link, or another
// of the outputs; before anything is computed.
void check_outputs(const std::filesystem::path& scene, std::initializer_list<OutputFile> outputs);

} // namespace flyball::cli
