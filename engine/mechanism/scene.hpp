// Scene files: a Mechanism as JSON text and back (the format is described in assets/scenes/README.md, and
// held by assets/scene.schema.json).
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace flyball {

// Reads and validates; throws SceneError naming the place and what was expected; for text that is not
// JSON the place is the line and column.
Mechanism read_scene(std::string_view text);
// Reads without validating (see validate.hpp), for whoever wants to show or mend an unfinished mechanism; the
// numbers of expressions that cannot be evaluated are zero.
Mechanism parse_scene(std::string_view text);
// The same from a file ("-": standard input); the error's `where` starts with the file's path. Also throws
// SceneError where the file cannot be read.
Mechanism load_scene(const std::filesystem::path& file);

// Text that read_scene turns back into an equal value; keys at their default are left out, numbers read back
// exactly, short arrays and objects stay on one line. Throws SceneError for a number that is not finite.
std::string write_scene(const Mechanism& mechanism);
// Writes beside the file and renames, so that a reader never sees half a scene (see file.hpp). Throws
// SceneError.
void save_scene(const Mechanism& mechanism, const std::filesystem::path& file);

} // namespace flyball
