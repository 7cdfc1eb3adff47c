#include "app/cli/row_output.hpp"

#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace flyball::cli {
namespace {

class CsvOutput final : public RowOutput {
 public:
  CsvOutput(std::filesystem::path file, std::string head) : file_(std::move(file)), head_(std::move(head)) {}

  void begin() override { writer_.emplace(file_); }
  void take(std::size_t, std::size_t, std::string_view rows) override {
    writer_->write(std::exchange(head_, {})); // no word to a pipe before there is a row
    writer_->write(rows);
  }
  void finish() override {
    writer_->write(head_);
    writer_->finish();
  }

 private:
  std::filesystem::path file_;
  std::string head_;
  std::optional<FileWriter> writer_;
};

class NpzOutput final : public RowOutput {
 public:
  NpzOutput(const std::vector<Column>& columns, std::filesystem::path file, std::uint64_t count)
      : columns_(npz_columns(columns)), file_(std::move(file)), count_(count) {}

  void begin() override { writer_.emplace(file_, columns_, count_); }
  void take(std::size_t begin, std::size_t end, std::string_view rows) override {
    writer_->write(begin, end, rows);
  }
  void finish() override { writer_->finish(); }

 private:
  std::vector<NpzColumn> columns_;
  std::filesystem::path file_;
  std::uint64_t count_;
  std::optional<NpzWriter> writer_;
};

// An object as print_json() would have it.
class JsonOutput final : public RowOutput {
 public:
  explicit JsonOutput(const Mechanism& mechanism)
      : end_(with_warnings(nlohmann::ordered_json::object(), mechanism).dump(2)) {}

  void take(std::size_t begin, std::size_t, std::string_view rows) override {
    constexpr std::size_t separator = 2; // before the first row there is none
    if (begin == 0) fmt::print("{{\n  \"points\": [\n{}", rows.substr(separator));
    if (begin > 0) fmt::print("{}", rows);
  }
  void finish() override { fmt::print("\n  ],{}\n", printable_json(end_.substr(1))); }

 private:
  std::string end_;
};

class TableOutput final : public RowOutput {
 public:
  explicit TableOutput(std::vector<std::string> head) { rows_.push_back(std::move(head)); }

  void take(std::size_t, std::size_t, std::string_view rows) override {
    for (std::size_t at = 0; at < rows.size();) {
      const std::size_t end = rows.find_first_of("\t\n", at);
      row_.emplace_back(rows.substr(at, end - at));
      if (rows[end] == '\n') rows_.push_back(std::exchange(row_, {}));
      at = end + 1;
    }
  }
  void finish() override { print_text(aligned(rows_)); }

 private:
  std::vector<std::string> row_;
  std::vector<std::vector<std::string>> rows_;
};

} // namespace

std::string csv_head(const std::vector<Column>& columns) {
  std::string out;
  for (const Column& column : columns)
    out += (out.empty() ? "" : ",") + csv_field(column.name);
  return out + "\n";
}

std::string json_row(std::string_view indented_object) {
  std::string out = ",\n    ";
  for (const char c : indented_object) {
    out += c;
    if (c == '\n') out += "    ";
  }
  return printable_json(out);
}

std::string named_with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? printable(name) : fmt::format("{} [{}]", printable(name), unit);
}

std::unique_ptr<RowOutput> csv_output(const std::filesystem::path& file, std::string head) {
  return std::make_unique<CsvOutput>(file, std::move(head));
}
std::unique_ptr<RowOutput> npz_output(const std::vector<Column>& columns, const std::filesystem::path& file,
                                      std::uint64_t count) {
  return std::make_unique<NpzOutput>(columns, file, count);
}
std::unique_ptr<RowOutput> json_output(const Mechanism& mechanism) {
  return std::make_unique<JsonOutput>(mechanism);
}
std::unique_ptr<RowOutput> table_output(std::vector<std::string> head) {
  return std::make_unique<TableOutput>(std::move(head));
}

} // namespace flyball::cli
