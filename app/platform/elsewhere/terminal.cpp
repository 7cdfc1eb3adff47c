#include "app/platform/terminal.hpp"

namespace flyball {

std::optional<int> terminal_columns() {
  return std::nullopt;
}

} // namespace flyball
