#include "app/cli/output.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flyball::cli {

void print_text(std::string_view text) {
  fmt::print("{}", printable_lines(text));
}

void print_json(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", printable_json(json.dump(2)));
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
