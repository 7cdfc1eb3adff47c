#include "app/platform/terminal.hpp"

#include <cstdlib>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace flyball {

std::optional<int> terminal_columns() {
  const char* kind = std::getenv("TERM");
  if (::isatty(STDERR_FILENO) != 1 || (kind && std::string_view(kind) == "dumb")) return std::nullopt;
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

} // namespace flyball
