// What is being written beside the file it will replace: ".NAME.PID-N.part", a file or a folder. Its writer
// holds a lock on it, so that what a killed program has left is told from what is still being written, by
// this machine or another one on a shared disk.
#pragma once

#include <filesystem>
#include <sys/types.h>

namespace flyball {

class PartFile {
 public:
  enum class Kind { file, folder };
  // Makes an empty one beside `target` under a name that nothing has, with these permissions less the
  // umask's, after removing what killed programs have left in that folder. Throws SceneError that names
  // `file`.
  PartFile(const std::filesystem::path& file, const std::filesystem::path& target, Kind kind, mode_t mode);
  // Removes it with all that is in it, unless it was renamed or kept.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return fd_; } // open for writing, or of the folder
  // Closes the descriptor; false (and errno) where a file system says only now that it has failed to write.
  bool close();
  // Moves it over the target; false (and errno) where it cannot, and then it is still here.
  bool rename_to(const std::filesystem::path& target);

 private:
  std::filesystem::path path_;
  int fd_ = -1;
};

// Removes parts of programs that no longer run from a folder; those of others stay. Fails without a word.
void remove_orphaned_parts(const std::filesystem::path& folder);

} // namespace flyball
