// What a report was made by.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace flyball {

// Program, scene file format, and the libraries that numbers pass through, each with its version.
std::vector<std::pair<std::string, std::string>> program_versions();

} // namespace flyball
