#include "app/platform/file_stamp.hpp"

#include <chrono>

namespace flyball {

std::optional<FileStamp> stamp_of(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return std::nullopt;
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  if (failed) return std::nullopt;
  const auto modified = std::filesystem::last_write_time(file, failed).time_since_epoch();
  if (failed) return std::nullopt;
  return FileStamp{.size = size, .modified = std::chrono::nanoseconds(modified).count()};
}

} // namespace flyball
