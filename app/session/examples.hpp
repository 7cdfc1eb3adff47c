// The scenes that come with the program, in groups, and what finds one of them.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct Example {
  std::filesystem::path file;
  Mechanism mechanism;
  std::string group; // its title, empty where there are no groups; those of one follow each other
};

// The scenes of the folder in the order of its groups.txt (which says itself how it is read): those that it
// does not name last, by title. Files that cannot be opened are left out.
std::vector<Example> read_examples(const std::filesystem::path& folder);

// Where every word that is typed begins one: 0 of its title, 1 of that, its group's or its description, 2 of
// those or of what its parts are called ("belt", "hinge", "friction", "engine"); else nothing. Upper and
// lower case count as the same.
std::optional<int> found_rank(const Example& example, std::string_view typed);

} // namespace flyball
