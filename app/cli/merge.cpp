#include "app/cli/command.hpp"
#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/row_columns.hpp"
#include "app/cli/spread_report.hpp"
#include "app/cli/study_part.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/study/spread_tally.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>

namespace flyball::cli {
namespace {

struct OpenPart {
  std::filesystem::path file;
  std::ifstream in; // behind the first line
  StudyPart part;
  std::uint64_t hash = 0; // of the first line

  explicit OpenPart(const std::filesystem::path& path) : file(path), in(path, std::ios::binary) {
    if (!in) throw SceneError(file.string(), "cannot read");
    std::string line;
    std::getline(in, line);
    part = read_part_head(file, line);
    hash = part_hash("\n", part_hash(line));
  }
};
using OpenParts = std::vector<std::unique_ptr<OpenPart>>;

// In order, all of one study, none missing and none twice.
void check_parts(OpenParts& parts) {
  const OpenPart& first = *parts.front();
  for (const auto& each : parts)
    if (const std::string what = each->part.differs_from(first.part); !what.empty())
      throw SceneError(each->file.string(), "expected a part of the same " + first.part.study + " as " +
                                                first.file.string() + "; its " + what + " is another");
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
    throw SceneError("parts", fmt::format("expected all {} of the {}; missing {}", first.part.shard.of,
                                          first.part.study, missing));
}

SceneError damaged(const OpenPart& part) {
  return {part.file.string(), "expected rows with their number and hash behind them; it is damaged"};
}

// How many rows a file's last line tells.
std::uint64_t rows_of(OpenPart& part) {
  constexpr std::streamoff longest = 64;
  const auto here = part.in.tellg();
  part.in.seekg(0, std::ios::end);
  if (!part.in)
    throw SceneError(part.file.string(),
                     "expected a file, of which the rows are counted first for columns for NumPy");
  part.in.seekg(std::max<std::streamoff>(0, part.in.tellg() - longest));
  std::string line, last;
  while (std::getline(part.in, line))
    last = line;
  const auto end = read_part_end(last);
  part.in.clear();
  part.in.seekg(here);
  if (!end || !part.in) throw damaged(part);
  return end->rows;
}

using TakeRow = std::function<void(OpenPart& part, const std::string& row)>;

// Calls for each row, with its line end, and checks that they are those of which the part tells.
void for_rows(OpenPart& part, const TakeRow& take) {
  PartEnd sofar{0, part.hash};
  std::string row;
  for (; std::getline(part.in, row) && !part.in.eof(); ++sofar.rows) {
    if (const auto end = read_part_end(row)) {
      if (*end != sofar || part.in.peek() != std::ifstream::traits_type::eof()) break;
      return;
    }
    row += '\n';
    sofar.hash = part_hash(row, sofar.hash);
    take(part, row);
  }
  throw damaged(part);
}

void merge_to_csv(OpenParts& parts, const std::filesystem::path& file, const TakeRow& look) {
  constexpr std::size_t piece = 1 << 20; // bytes
  FileWriter out(file);
  std::string bytes = csv_head(parts.front()->part.columns);
  for (const auto& part : parts)
    for_rows(*part, [&](OpenPart& from, const std::string& row) {
      look(from, row);
      bytes += row;
      if (bytes.size() < piece) return;
      out.write(bytes);
      bytes.clear();
    });
  out.write(bytes);
  out.finish();
}

void merge_to_npz(OpenParts& parts, const std::filesystem::path& file, const TakeRow& look) {
  const std::vector<Column>& columns = parts.front()->part.columns;
  constexpr std::size_t piece = 10'000; // rows
  std::uint64_t all = 0, written = 0;
  for (const auto& part : parts)
    all += rows_of(*part);
  NpzWriter out(file, npz_columns(columns), all);
  RowColumns rows(columns);
  const auto write = [&] {
    const std::uint64_t begin = written;
    written += rows.rows();
    out.write(begin, written, rows.take());
  };
  for (const auto& part : parts)
    for_rows(*part, [&](OpenPart& from, const std::string& row) {
      look(from, row);
      if (!rows.add(std::string_view(row).substr(0, row.size() - 1))) throw damaged(from);
      if (rows.rows() == piece) write();
    });
  write();
  out.finish();
}

void merge(OpenParts& parts, const std::filesystem::path& file, const TakeRow& look) {
  if (file.extension() == ".npz")
    merge_to_npz(parts, file, look);
  else
    merge_to_csv(parts, file, look);
}

// Samples have statistics besides.
void merge_spread(OpenParts& parts, const std::filesystem::path& file, bool json) {
  SpreadReport report = read_spread(parts.front()->file, parts.front()->part);
  SpreadTally tally(report.tolerances, report.seed, report.answer);
  std::vector<std::string_view> cells;
  std::vector<double> values;
  std::size_t i = 0;
  merge(parts, file, [&](OpenPart& from, const std::string& row) {
    if (!split_row(std::string_view(row).substr(0, row.size() - 1), cells)) throw damaged(from);
    const std::optional<SampleFate> fate = read_sample(cells, report, values);
    if (!fate) throw damaged(from);
    tally.add(i++, *fate, values);
  });
  tally.tell(report.answer);
  if (file == "-") return;
  if (json)
    print_json(to_json(report));
  else
    print_text(to_text(report));
}

} // namespace

void add_merge(CLI::App& app, Ending&) {
  struct Options {
    std::vector<std::string> parts;
    std::string out;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("merge", "Put the parts of a study together that --shard has written");
  command->add_option("parts", options->parts, "Files of the parts, in any order")->required();
  command
      ->add_option("-o,--output", options->out,
                   "Write a table to a file (-: standard output), or columns for NumPy where it ends in .npz")
      ->required();
  command->add_flag("--json", options->json, "Of a spread: print its statistics as a JSON object");
  command->footer("Example: flyball merge part*.csv -o curve.csv");
  command->callback([options] {
    OpenParts parts;
    for (const std::string& file : options->parts) {
      check_outputs(file, {{"--output", options->out}});
      parts.push_back(std::make_unique<OpenPart>(file));
    }
    check_parts(parts);
    if (parts.front()->part.study == "spread")
      merge_spread(parts, options->out, options->json);
    else
      merge(parts, options->out, [](OpenPart&, const std::string&) {});
  });
}

} // namespace flyball::cli
