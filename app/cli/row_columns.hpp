// Rows of CSV that were put out, read again.
#pragma once

#include "app/cli/row_output.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

// The cells of a row without its line end; what is quoted stays so. False where a quote has no end.
bool split_row(std::string_view row, std::vector<std::string_view>& cells);

// Rows as bytes of numbers and words, column after column, as NpzWriter takes them.
class RowColumns {
 public:
  explicit RowColumns(const std::vector<Column>& columns) : columns_(columns), bytes_(columns.size()) {}

  // Without its line end. False where the row has other columns, or something that is no number where one
  // stands.
  bool add(std::string_view row);
  std::size_t rows() const { return rows_; } // since they were taken
  std::string take();

 private:
  bool add(std::size_t column, std::string_view text);

  std::vector<Column> columns_;
  std::vector<std::string> bytes_; // by column
  std::vector<std::string_view> cells_;
  std::size_t rows_ = 0;
};

} // namespace flyball::cli
