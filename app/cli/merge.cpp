#include "app/cli/command.hpp"
#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/sweep_part.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>

namespace flyball::cli {
namespace {

struct OpenPart {
  std::filesystem::path file;
  std::ifstream in; // behind the first line
  SweepPart part;

  explicit OpenPart(const std::filesystem::path& path) : file(path), in(path, std::ios::binary) {
    if (!in) throw SceneError(file.string(), "cannot read");
    std::string line;
    std::getline(in, line);
    part = read_part_head(file, line);
  }
};

// In order, all of one sweep, none missing and none twice.
void check_parts(std::vector<std::unique_ptr<OpenPart>>& parts) {
  const OpenPart& first = *parts.front();
  for (const auto& each : parts)
    if (const std::string what = each->part.differs_from(first.part); !what.empty())
      throw SceneError(each->file.string(), "expected a part of the same sweep as " + first.file.string() +
                                                "; its " + what + " is another");
  std::ranges::stable_sort(parts, {}, [](const auto& p) { return p->part.shard.number; });
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i]->part.shard.number == parts[i - 1]->part.shard.number)
      throw SceneError(parts[i]->file.string(),
                       fmt::format("expected each part once; it is part {}, as is {}",
                                   parts[i]->part.shard.number, parts[i - 1]->file.string()));
  std::string missing;
  std::size_t at = 0, count = 0;
  constexpr std::size_t named = 20;
  for (std::uint64_t number = 1; number <= first.part.shard.of; ++number) {
    if (at < parts.size() && parts[at]->part.shard.number == number)
      ++at;
    else if (++count <= named)
      missing += (missing.empty() ? "" : ", ") + std::to_string(number);
  }
  if (count > named) missing += fmt::format(" and {} more", count - named);
  if (count > 0)
    throw SceneError("parts",
                     fmt::format("expected all {} of the sweep; missing {}", first.part.shard.of, missing));
}

// Rows of CSV as numbers again, by columns.
class RowColumns {
 public:
  RowColumns(std::size_t columns, std::size_t status, std::size_t stable)
      : columns_(columns), status_(status), stable_(stable) {}

  // False where the row has other columns, or something that is no number where one stands.
  bool add(std::string_view row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::size_t comma = row.find(',');
      if ((comma == std::string_view::npos) != (i + 1 == columns_.size())) return false;
      if (!add(i, row.substr(0, comma))) return false;
      if (comma != std::string_view::npos) row.remove_prefix(comma + 1);
    }
    ++rows_;
    return true;
  }
  std::size_t rows() const { return rows_; }
  std::string take() {
    std::string all;
    for (std::string& column : columns_) {
      all += column;
      column.clear();
    }
    rows_ = 0;
    return all;
  }

 private:
  bool add(std::size_t column, std::string_view text) {
    std::string& out = columns_[column];
    if (column == status_) {
      append_word(out, text);
    } else if (column == stable_) {
      if (!text.empty() && text != "true" && text != "false") return false;
      out += static_cast<char>(npz_stable(text.empty() ? std::nullopt : std::optional(text == "true")));
    } else {
      double value = std::nan("");
      const char* end = text.data() + text.size();
      if (!text.empty() && std::from_chars(text.data(), end, value).ptr != end) return false;
      append_item(out, value);
    }
    return true;
  }

  std::vector<std::string> columns_; // bytes
  std::size_t status_, stable_, rows_ = 0;
};

// Calls for each row, with its line end, and checks that they are as many as the part says.
template <class Take>
void for_rows(OpenPart& part, const Take& take) {
  std::uint64_t left = part.part.end() - part.part.begin();
  std::string row;
  for (; left > 0 && std::getline(part.in, row) && !part.in.eof(); --left) {
    row += '\n';
    take(row);
  }
  if (left > 0 || part.in.peek() != std::ifstream::traits_type::eof())
    throw SceneError(part.file.string(),
                     fmt::format("expected {} rows; it is damaged", part.part.end() - part.part.begin()));
}

void merge_to_csv(std::vector<std::unique_ptr<OpenPart>>& parts, const std::filesystem::path& file) {
  constexpr std::size_t piece = 1 << 20; // bytes
  FileWriter out(file);
  std::string bytes = csv_head(parts.front()->part.columns);
  for (const auto& part : parts)
    for_rows(*part, [&](const std::string& row) {
      bytes += row;
      if (bytes.size() < piece) return;
      out.write(bytes);
      bytes.clear();
    });
  out.write(bytes);
  out.finish();
}

void merge_to_npz(std::vector<std::unique_ptr<OpenPart>>& parts, const std::filesystem::path& file) {
  const SweepPart& sweep = parts.front()->part;
  const std::vector<NpzColumn> columns = npz_columns(sweep.columns, sweep.variations.size());
  const auto stable = std::ranges::find(columns, "|i1", &NpzColumn::type) - columns.begin();
  constexpr std::size_t piece = 10'000; // rows
  NpzWriter out(file, columns, sweep.rows);
  RowColumns rows(columns.size(), sweep.variations.size(), static_cast<std::size_t>(stable));
  std::uint64_t written = 0;
  const auto write = [&] {
    const std::uint64_t begin = written;
    written += rows.rows();
    out.write(begin, written, rows.take());
  };
  for (const auto& part : parts)
    for_rows(*part, [&](const std::string& row) {
      if (!rows.add(std::string_view(row).substr(0, row.size() - 1)))
        throw SceneError(part->file.string(), "expected rows of numbers; it is damaged");
      if (rows.rows() == piece) write();
    });
  write();
  out.finish();
}

} // namespace

void add_merge(CLI::App& app, Ending&) {
  struct Options {
    std::vector<std::string> parts;
    std::string out;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("merge", "Put the parts of a sweep together that `sweep --shard` has written");
  command->add_option("parts", options->parts, "Files of the parts, in any order")->required();
  command
      ->add_option("-o,--output", options->out,
                   "Write a table to a file (-: standard output), or columns for NumPy where it ends in .npz")
      ->required();
  command->footer("Example: flyball merge part*.csv -o curve.csv");
  command->callback([options] {
    std::vector<std::unique_ptr<OpenPart>> parts;
    for (const std::string& file : options->parts) {
      check_outputs(file, {{"--output", options->out}});
      parts.push_back(std::make_unique<OpenPart>(file));
    }
    check_parts(parts);
    if (options->out.ends_with(".npz"))
      merge_to_npz(parts, options->out);
    else
      merge_to_csv(parts, options->out);
  });
}

} // namespace flyball::cli
