// Where rows of a study go, as they come: what solves points puts their rows into form, on whatever thread or
// process, and one takes them in order.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

enum class CellKind {
  number,  // empty where there is none
  word,    // of a few
  verdict, // "true", "false", or empty for unknown
  text,
};
struct Column {
  std::string name;
  CellKind kind = CellKind::number;
  bool operator==(const Column&) const = default;
};

class RowOutput {
 public:
  virtual ~RowOutput() = default;
  // Before the first, then in order, then after the last, when a file comes to its place. The rows are of the
  // study's indices from `begin` up to `end`. Throw SceneError where nothing can be written.
  virtual void begin() {}
  virtual void take(std::size_t begin, std::size_t end, std::string_view rows) = 0;
  virtual void finish() = 0;
};

// A table of text. `head` comes before the first row.
std::unique_ptr<RowOutput> csv_output(const std::filesystem::path& file, std::string head);
// Its first line.
std::string csv_head(const std::vector<Column>& columns);
// An array for each column, see npz.hpp; rows come column after column. `count`: of rows, one for each index.
std::unique_ptr<RowOutput> npz_output(const std::vector<Column>& columns, const std::filesystem::path& file,
                                      std::uint64_t count);
// To standard output, a JSON object {"points": [...], "warnings": [...]}. A row is what json_row() makes.
std::unique_ptr<RowOutput> json_output(const Mechanism& mechanism);
std::string json_row(std::string_view indented_object);
// To standard output, aligned for a person, all of it at the end. Cells of a row have tabs between them.
std::unique_ptr<RowOutput> table_output(std::vector<std::string> head);
// "slide [m]".
std::string named_with_unit(const std::string& name, const std::string& unit);

} // namespace flyball::cli
