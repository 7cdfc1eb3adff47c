// What `flyball spread` tells: of samples that it made itself, or that `merge` has read from parts.
#pragma once

#include "app/cli/study_part.hpp"
#include "engine/study/spread.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::cli {

struct SpreadReport {
  std::string name; // the scene's
  nlohmann::ordered_json warnings;
  std::vector<Tolerance> tolerances;
  std::uint64_t seed = 1;
  SpreadAnswer answer;
};

std::string to_text(const SpreadReport& report);
nlohmann::ordered_json to_json(const SpreadReport& report);

// Its samples as rows: the numbers, what became of them, the outputs. Of the report all but samples and their
// statistics is read.
StudyPart sample_part(const Mechanism& mechanism, const SpreadReport& report, std::size_t samples);
std::string sample_row(const SpreadReport& report, std::size_t i, SampleFate fate,
                       std::span<const double> values);

// The same back. Throws SceneError that names the file where the part is none of a spread.
SpreadReport read_spread(const std::filesystem::path& file, const StudyPart& part);
// What became of the sample that a row tells of, and its values; nothing where it is none.
std::optional<SampleFate> read_sample(std::span<const std::string_view> cells, const SpreadReport& report,
                                      std::vector<double>& values);

} // namespace flyball::cli
