#include "app/platform/access.hpp"

#include <cerrno>
#include <unistd.h>

namespace flyball {

std::error_code write_refusal(const std::filesystem::path& path) {
  std::error_code ignored;
  const int wanted = std::filesystem::is_directory(path, ignored) ? W_OK | X_OK : W_OK;
  if (::access(path.c_str(), wanted) == 0) return {};
  return {errno, std::generic_category()};
}

} // namespace flyball
