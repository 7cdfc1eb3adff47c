#include "app/cli/study_part.hpp"

#include "app/document/file_watch.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <charconv>

namespace flyball::cli {
namespace {

constexpr std::string_view mark = "# part by flyball: ", end_mark = "# rows: ", hash_mark = ", hash: ";
constexpr std::array<std::string_view, 4> kinds{"number", "word", "verdict", "text"}; // by CellKind

std::string head(const StudyPart& part) {
  nlohmann::ordered_json columns = nlohmann::ordered_json::array();
  for (const Column& column : part.columns)
    columns.push_back({column.name, kinds[static_cast<std::size_t>(column.kind)]});
  const nlohmann::ordered_json json = {{"study", part.study},
                                       {"version", part.version},
                                       {"scene", part.scene},
                                       {"request", part.request},
                                       {"columns", columns},
                                       {"count", part.count},
                                       {"shard", {part.shard.number, part.shard.of}},
                                       {"told", part.told}};
  return std::string(mark) + json.dump() + "\n";
}

class PartOutput final : public RowOutput {
 public:
  PartOutput(const StudyPart& part, const std::filesystem::path& file)
      : rows_(csv_output(file, head(part))), end_{0, part_hash(head(part))} {}

  void begin() override { rows_->begin(); }
  void take(std::size_t begin, std::size_t end, std::string_view rows) override {
    end_.rows += static_cast<std::uint64_t>(std::ranges::count(rows, '\n'));
    end_.hash = part_hash(rows, end_.hash);
    rows_->take(begin, end, rows);
  }
  void finish() override {
    rows_->take(0, 0, fmt::format("{}{}{}{:016x}\n", end_mark, end_.rows, hash_mark, end_.hash));
    rows_->finish();
  }

 private:
  std::unique_ptr<RowOutput> rows_;
  PartEnd end_;
};

} // namespace

Shard parse_shard(std::string_view option, std::string_view text) {
  constexpr std::uint64_t most = 1'000'000;
  Shard shard;
  const char* end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool has_slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto of = has_slash ? std::from_chars(number.ptr + 1, end, shard.of) : number;
  if (!has_slash || of.ec != std::errc() || of.ptr != end || shard.number < 1 || shard.number > shard.of ||
      shard.of > most)
    throw SceneError(std::string(option),
                     "expected which part of how many, such as 3/64, not \"" + std::string(text) + "\"");
  return shard;
}

CLI::Option* add_shard(CLI::App& command, std::string& text, CLI::Option* csv) {
  return command
      .add_option("--shard", text,
                  "Compute part K of N alone, K/N, and write it to --csv for `flyball merge`; without times")
      ->needs(csv);
}

std::string StudyPart::differs_from(const StudyPart& other) const {
  if (study != other.study) return "study";
  if (scene != other.scene) return "scene or its settings";
  for (const auto& [name, value] : request.items())
    if (!other.request.contains(name) || other.request[name] != value) return name;
  if (shard.of != other.shard.of) return "number of parts";
  if (version != other.version) return "version of the program";
  if (columns != other.columns || count != other.count || request != other.request || told != other.told)
    return "columns";
  return {};
}

StudyPart part_of(std::string study, const Mechanism& mechanism, nlohmann::ordered_json request,
                  std::vector<Column> columns, std::uint64_t count) {
  return {std::move(study),
          FLYBALL_VERSION,
          fmt::format("{:016x}", text_hash(write_scene(mechanism))),
          std::move(request),
          std::move(columns),
          count,
          {},
          nullptr};
}

std::unique_ptr<RowOutput> part_output(const StudyPart& part, const std::filesystem::path& file) {
  return std::make_unique<PartOutput>(part, file);
}

StudyPart read_part_head(const std::filesystem::path& file, std::string_view line) {
  try {
    if (!line.starts_with(mark)) throw std::runtime_error("");
    const auto json = nlohmann::ordered_json::parse(line.substr(mark.size()));
    StudyPart part;
    json.at("study").get_to(part.study);
    json.at("version").get_to(part.version);
    json.at("scene").get_to(part.scene);
    part.request = json.at("request");
    for (const auto& column : json.at("columns")) {
      const auto kind = std::ranges::find(kinds, column.at(1).get<std::string>());
      if (kind == kinds.end()) throw std::runtime_error("");
      part.columns.push_back({column.at(0), static_cast<CellKind>(kind - kinds.begin())});
    }
    json.at("count").get_to(part.count);
    part.shard = {json.at("shard").at(0), json.at("shard").at(1)};
    part.told = json.at("told");
    if (part.shard.number < 1 || part.shard.number > part.shard.of || part.columns.empty() ||
        !part.request.is_object())
      throw std::runtime_error("");
    return part;
  } catch (const std::exception&) {
    throw SceneError(file.string(), "expected a part, as commands write it with --shard");
  }
}

std::optional<PartEnd> read_part_end(std::string_view line) {
  PartEnd out;
  if (!line.starts_with(end_mark)) return {};
  const char* end = line.data() + line.size();
  const auto rows = std::from_chars(line.data() + end_mark.size(), end, out.rows);
  if (rows.ec != std::errc() || !std::string_view(rows.ptr, end).starts_with(hash_mark)) return {};
  const auto hash = std::from_chars(rows.ptr + hash_mark.size(), end, out.hash, 16);
  if (hash.ec != std::errc() || hash.ptr != end) return {};
  return out;
}

std::uint64_t part_hash(std::string_view text, std::uint64_t behind) {
  for (const char c : text)
    behind = (behind ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return behind;
}

} // namespace flyball::cli
