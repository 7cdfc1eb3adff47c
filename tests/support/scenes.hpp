// Scenes from files.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <utility>
#include <vector>

namespace flyball::test {

std::string shipped_file(const std::string& name); // assets/scenes/NAME.json
Mechanism shipped(const std::string& name);
// The same with some of its numbers changed.
Mechanism shipped(const std::string& name, const std::vector<std::pair<std::string, double>>& changes);

// Files of assets/scenes, in order.
std::vector<std::string> shipped_files();

// tests/cases/NAME.json
Mechanism stored_case(const std::string& name);

} // namespace flyball::test
