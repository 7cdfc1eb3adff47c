// Where the shipped scenes are.
#pragma once

#include <filesystem>

namespace flyball::cli {

// The folder scenes/ of the source tree, or of the installed program (../share/flyball beside the
// executable's folder), or of a tree that was moved (../../assets); empty where there is none.
std::filesystem::path shipped_scenes();

} // namespace flyball::cli
