#include "app/platform/file_stamp.hpp"

#include <sys/stat.h>

namespace flyball {

std::optional<FileStamp> stamp_of(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  constexpr std::int64_t nanoseconds = 1'000'000'000;
  return FileStamp{static_cast<std::uint64_t>(found.st_dev), static_cast<std::uint64_t>(found.st_ino),
                   static_cast<std::uint64_t>(found.st_size),
                   found.st_mtim.tv_sec * nanoseconds + found.st_mtim.tv_nsec};
}

} // namespace flyball
