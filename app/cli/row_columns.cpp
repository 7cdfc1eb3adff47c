#include "app/cli/row_columns.hpp"

#include "app/cli/npz.hpp"
#include "engine/mechanism/decimal.hpp"

#include <algorithm>
#include <cmath>

namespace flyball::cli {

bool split_row(std::string_view row, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0;;) {
    std::size_t end = begin;
    while (end < row.size() && row[end] == '"') { // and what is quoted again, right behind
      end = row.find('"', end + 1);
      if (end++ == std::string_view::npos) return false;
    }
    end = std::min(row.find(',', end), row.size());
    cells.push_back(row.substr(begin, end - begin));
    if (end == row.size()) return true;
    begin = end + 1;
  }
}

bool RowColumns::add(std::string_view row) {
  if (!split_row(row, cells_) || cells_.size() != columns_.size()) return false;
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (!add(i, cells_[i])) return false;
  ++rows_;
  return true;
}

std::string RowColumns::take() {
  std::string all;
  for (std::string& column : bytes_) {
    all += column;
    column.clear();
  }
  rows_ = 0;
  return all;
}

bool RowColumns::add(std::size_t column, std::string_view text) {
  std::string& out = bytes_[column];
  switch (columns_[column].kind) {
  case CellKind::number: {
    double value = std::nan("");
    const char* end = text.data() + text.size();
    if (!text.empty() && read_decimal(text.data(), end, value).ptr != end) return false;
    append_item(out, value);
    return true;
  }
  case CellKind::word: append_word(out, text); return true;
  case CellKind::verdict:
    if (!text.empty() && text != "true" && text != "false") return false;
    out += static_cast<char>(npz_verdict(text.empty() ? std::nullopt : std::optional(text == "true")));
    return true;
  case CellKind::text: return true;
  }
  return false;
}

} // namespace flyball::cli
