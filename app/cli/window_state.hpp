// What the window shows, as JSON: how a test outside the program reads it.
#pragma once

#include "app/ui/app.hpp"

#include <string>

namespace flyball::cli {

std::string window_state(const App& app);

} // namespace flyball::cli
