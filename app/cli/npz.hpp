// Columns of numbers for NumPy (npz_archive.hpp), so that `numpy.load(file)["slide"]` has them.
//
// An archive of a known number of rows is laid out beforehand and its columns are written side by side as the
// rows come, so that no row is kept; that is why no library of archives, all of which write one member after
// the other, is used.
#pragma once

#include "app/cli/row_output.hpp"
#include "engine/mechanism/file.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

struct NpzColumn {
  std::string name;
  std::string type;     // NumPy's: "<f8"
  std::size_t size = 0; // bytes of an item
};

// Numbers, NaN where there is none; words; verdicts: 1, 0, or -1 where it is not known. Texts, which may be
// of any length, are left out.
std::vector<NpzColumn> npz_columns(const std::vector<Column>& columns);
void append_item(std::string& out, double value);
void append_word(std::string& out, std::string_view word); // of npz_columns' size
std::int8_t npz_verdict(std::optional<bool> verdict);

class NpzWriter {
 public:
  // `rows` of each column. Throws SceneError where nothing can be written, as do all others.
  NpzWriter(const std::filesystem::path& file, const std::vector<NpzColumn>& columns, std::uint64_t rows);

  // The rows from `begin` up to `end`, which follow those before: column after column.
  void write(std::uint64_t begin, std::uint64_t end, std::string_view columns);
  void finish();

 private:
  struct Member {
    NpzColumn column;
    std::string name, head; // of the file in the archive; of the array
    std::uint64_t place = 0, size = 0;
    std::uint32_t checksum = 0; // of what is written
    std::uint64_t data() const;
  };
  FileWriter out_;
  std::vector<Member> members_;
  std::uint64_t end_ = 0; // of the members
};

} // namespace flyball::cli
