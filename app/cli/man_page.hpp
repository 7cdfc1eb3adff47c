// The manual's pages in the language of man(7), from the commands' own words.
#pragma once

#include "app/cli/description.hpp"

namespace flyball::cli {

// flyball(1); of a command flyball-solve(1).
std::string man_page(const ProgramDescription& program);
std::string man_page(const CommandDescription& command);

} // namespace flyball::cli
