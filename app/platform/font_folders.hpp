// Where the system keeps its fonts.
#pragma once

#include <filesystem>
#include <vector>

namespace flyball {

// Those in which the interface's fonts may be, the best first.
std::vector<std::filesystem::path> font_folders();

} // namespace flyball
