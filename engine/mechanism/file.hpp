// Files as bytes: read whole, and written so that nobody ever sees half of one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace flyball {

// The whole of a file; "-" is standard input. Throws SceneError (`where` is the path) where it cannot be
// read.
std::string read_bytes(const std::filesystem::path& file);

// Replaces a file: written beside it, synchronised and renamed, through symbolic links and with the
// permissions it had. "-" is standard output; a path that is no regular file (a pipe, /dev/stdout) is written
// directly. Throws SceneError (`where` is the path), and then leaves the old file as it was.
void write_bytes(const std::filesystem::path& file, std::string_view bytes);

} // namespace flyball
