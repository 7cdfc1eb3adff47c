#include "app/platform/access.hpp"

namespace flyball {

std::error_code write_refusal(const std::filesystem::path& path) {
  using std::filesystem::perms;
  std::error_code failed;
  const perms allowed = std::filesystem::status(path, failed).permissions();
  if (failed || (allowed & perms::owner_write) != perms::none) return failed;
  return std::make_error_code(std::errc::permission_denied);
}

} // namespace flyball
