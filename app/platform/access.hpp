// Whether this process may write somewhere.
#pragma once

#include <filesystem>

namespace flyball {

// Why a file may not be written, or a folder's entries not be changed; no error where they may.
std::error_code write_refusal(const std::filesystem::path& path);

} // namespace flyball
