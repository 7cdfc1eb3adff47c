#include "app/cli/sweep_part.hpp"

#include "app/document/file_watch.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>

namespace flyball::cli {
namespace {

constexpr std::string_view mark = "# part of a sweep by flyball: ";

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

SweepPart::SweepPart(const Mechanism& mechanism, const SweepColumns& of, const Shard& which)
    : version(FLYBALL_VERSION), scene(fmt::format("{:016x}", text_hash(write_scene(mechanism)))),
      variations(of.variations), columns(of.names()), rows(grid_size(of.variations)), shard(which) {}

std::string SweepPart::head() const {
  nlohmann::ordered_json varied = nlohmann::ordered_json::array();
  for (const Variation& v : variations)
    varied.push_back({v.address, v.from, v.to, v.count});
  const nlohmann::ordered_json json = {{"version", version},   {"scene", scene},
                                       {"variations", varied}, {"columns", columns},
                                       {"rows", rows},         {"shard", {shard.number, shard.of}}};
  return std::string(mark) + json.dump() + "\n";
}

std::string SweepPart::differs_from(const SweepPart& other) const {
  if (scene != other.scene) return "scene or its settings";
  if (variations != other.variations) return "variations";
  if (shard.of != other.shard.of) return "number of parts";
  if (version != other.version) return "version of the program";
  if (columns != other.columns || rows != other.rows) return "columns";
  return {};
}

SweepPart read_part_head(const std::filesystem::path& file, std::string_view line) {
  try {
    if (!line.starts_with(mark)) throw std::runtime_error("");
    const auto json = nlohmann::json::parse(line.substr(mark.size()));
    SweepPart part;
    json.at("version").get_to(part.version);
    json.at("scene").get_to(part.scene);
    for (const auto& v : json.at("variations"))
      part.variations.push_back({v.at(0), v.at(1), v.at(2), v.at(3)});
    json.at("columns").get_to(part.columns);
    json.at("rows").get_to(part.rows);
    part.shard = {json.at("shard").at(0), json.at("shard").at(1)};
    if (part.shard.number < 1 || part.shard.number > part.shard.of ||
        part.rows != grid_size(part.variations) || part.columns.size() <= part.variations.size())
      throw std::runtime_error("");
    return part;
  } catch (const std::exception&) {
    throw SceneError(file.string(), "expected a part of a sweep, as `flyball sweep --shard` writes them");
  }
}

} // namespace flyball::cli
