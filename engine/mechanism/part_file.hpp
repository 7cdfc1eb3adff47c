// What is being written beside the file it will replace: a file or a folder under a name of its own, where
// the system can tell with a lock on it, so that what a killed program has left is told from what is still
// being written, by this machine or another one on a shared disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace flyball {

class PartFile {
 public:
  enum class Kind { file, folder };
  // Makes an empty one beside `target` under a name that nothing has, after removing what killed programs
  // have left in that folder. A file has the permissions of the target and, where this process may give it,
  // its owner. Throws SceneError that names `file`, as do all others.
  PartFile(const std::filesystem::path& file, const std::filesystem::path& target, Kind kind);
  // Removes it with all that is in it, unless it was put in its place.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Appends to a file.
  void write(std::string_view bytes);
  // Into a file from this place (bytes) on; what is appended does not move for it.
  void write_at(std::uint64_t place, std::string_view bytes);
  // Moves a file, by whomever it was written, over the target once it is on disk.
  void put_in_place();

 private:
  std::filesystem::path file_, target_, path_;
  int descriptor_ = -1; // where there are such: open for writing, or of the folder
};

} // namespace flyball
