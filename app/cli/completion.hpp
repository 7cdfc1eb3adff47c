// What shells complete: commands, their options, and words that an option may be.
#pragma once

#include "app/cli/description.hpp"

namespace flyball::cli {

// Scripts to be sourced, or put where the shell looks for them.
std::string bash_completion(const ProgramDescription& program);
std::string zsh_completion(const ProgramDescription& program);
std::string fish_completion(const ProgramDescription& program);

} // namespace flyball::cli
