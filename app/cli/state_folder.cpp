#include "app/cli/state_folder.hpp"

#include <cstdlib>

namespace flyball::cli {

std::filesystem::path state_folder() {
  // The specification wants relative paths ignored.
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state && *state == '/') return std::filesystem::path(state) / "flyball";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? std::filesystem::path(home) / ".local/state/flyball"
                              : std::filesystem::path();
}

} // namespace flyball::cli
