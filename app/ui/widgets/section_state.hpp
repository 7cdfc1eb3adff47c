// Which sections of the inspector and the outline are open.
#pragma once

#include "app/document/part.hpp"

#include <functional>
#include <map>
#include <string>

namespace flyball {

struct SectionState {
  std::map<std::string, bool, std::less<>> open; // that were opened or closed by hand
  std::map<std::string, bool, std::less<>> seen; // the others as they stood first, of `seen_of`
  Selection seen_of{};
};

} // namespace flyball
