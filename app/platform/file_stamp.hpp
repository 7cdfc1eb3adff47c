// Tells one state of a file from another without reading it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace flyball {

// Differs whenever a file was written or replaced.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, size = 0; // 0 where files have no such numbers
  std::int64_t modified = 0;                     // ns, since when depends on the system
  bool operator==(const FileStamp&) const = default;
};
// Nothing where there is no regular file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

} // namespace flyball
