// Where the program keeps what lasts from one run to the next.
#pragma once

#include <filesystem>

namespace flyball::cli {

// flyball/ in $XDG_STATE_HOME, or else in ~/.local/state; empty where there is no home. It need not exist.
std::filesystem::path state_folder();

} // namespace flyball::cli
