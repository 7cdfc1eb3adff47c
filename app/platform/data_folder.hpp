// Where the program's own files are.
#pragma once

#include <filesystem>

namespace flyball {

// share/flyball beside the folder of the executable, as installed and in a build tree alike. Whether there is
// such a folder is not looked at.
std::filesystem::path data_folder();

} // namespace flyball
