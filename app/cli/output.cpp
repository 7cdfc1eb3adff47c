#include "app/cli/output.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace flyball::cli {

void print_text(std::string_view text) {
  fmt::print("{}", printable_lines(text));
}

void print_json(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", printable_json(json.dump(2)));
}

std::string aligned(const std::vector<std::vector<std::string>>& rows, bool names) {
  const auto width = [](const std::string& text) { // in characters of UTF-8
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
  };
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string room(widths[i] - width(row[i]), ' ');
      out += i > 0 || names ? "  " : "";
      out += i == 0 && names ? row[i] + room : room + row[i];
    }
    out += "\n";
  }
  return out;
}

void check_outputs(const std::filesystem::path& scene, std::initializer_list<OutputFile> outputs) {
  for (const OutputFile* one = outputs.begin(); one != outputs.end(); ++one) {
    if (one->file.empty()) continue;
    if (same_file(scene, one->file))
      throw SceneError(std::string(one->option) + " " + one->file.string(),
                       "expected another file than the scene itself");
    for (const OutputFile* other = outputs.begin(); other != one; ++other) {
      const bool same = one->file == "-" || other->file == "-" ? one->file == other->file
                                                               : same_file(other->file, one->file);
      if (!other->file.empty() && same)
        throw SceneError(std::string(one->option) + " " + one->file.string(),
                         std::string("expected another file than ") + other->option + " writes");
    }
  }
}

} // namespace flyball::cli
