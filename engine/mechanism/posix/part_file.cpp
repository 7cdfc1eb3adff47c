#include "engine/mechanism/part_file.hpp"

#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <tuple>
#include <unistd.h>
#include <utility>
#include <vector>

// A part is called ".NAME.PID-N.part".
namespace flyball {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view ending = ".part";

std::string part_name(const fs::path& target, int attempt) {
  constexpr std::size_t most = 200; // of the 255 bytes that file systems give a name
  std::string name = target.filename().string();
  std::size_t end = std::min(name.size(), most);
  while (end > 0 && end < name.size() && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80)
    --end; // not within a character
  name.resize(end);
  return "." + name + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt) + std::string(ending);
}

// The process that a name says it is of, or 0 for a name that is not of our making.
pid_t process_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(ending)) return 0;
  name.remove_suffix(ending.size());
  const auto number = [&](char before) -> int {
    const std::size_t at = name.rfind(before);
    if (at == std::string_view::npos || at + 1 == name.size()) return -1;
    int value = -1;
    const char* last = name.data() + name.size();
    const auto result = std::from_chars(name.data() + at + 1, last, value);
    name.remove_suffix(name.size() - at);
    return result.ec == std::errc{} && result.ptr == last ? value : -1;
  };
  if (number('-') < 0) return 0;
  const int process = number('.');
  return process > 0 && name.size() > 1 ? process : 0; // something was named
}

bool is_running(pid_t process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

// Whether nobody writes it: its lock can be had, or the file system knows no locks.
bool is_abandoned(const fs::path& part) {
  const int fd = ::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return false;
  const bool taken = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return !taken;
}

// Removes parts of programs that no longer run from a folder; those of others stay. Fails without a word.
void remove_orphaned_parts(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> orphans;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    const pid_t process = process_of(it->path().filename().string());
    if (process == 0 || is_running(process)) continue;
    std::error_code ignored;
    const fs::file_status status = it->symlink_status(ignored);
    if ((fs::is_regular_file(status) || fs::is_directory(status)) && is_abandoned(it->path()))
      orphans.push_back(it->path());
  }
  std::error_code ignored;
  for (const fs::path& orphan : orphans)
    fs::remove_all(orphan, ignored);
}

[[noreturn]] void fail(const fs::path& file) {
  throw SceneError(file.string(), std::string("cannot write: ") + std::strerror(errno));
}

// The owner first, as a new one takes special permissions away; where only root may give one, at least the
// group.
bool give_what_it_had(int fd, const struct stat& old) {
  if ((old.st_uid != ::geteuid() || old.st_gid != ::getegid()) && ::fchown(fd, old.st_uid, old.st_gid) != 0)
    std::ignore = ::fchown(fd, static_cast<uid_t>(-1), old.st_gid);
  return ::fchmod(fd, old.st_mode & 07777U) == 0;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

} // namespace

PartFile::PartFile(const fs::path& file, const fs::path& target, Kind kind) : file_(file), target_(target) {
  const fs::path folder = folder_of(target);
  // In a folder that is itself a part, with thousands of frames of a film, there is nobody else.
  if (process_of(folder.filename().string()) == 0) remove_orphaned_parts(folder);
  for (int attempt = 0; attempt < 1000 && descriptor_ < 0; ++attempt) {
    path_ = target;
    path_.replace_filename(part_name(target, attempt));
    if (kind == Kind::file) {
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } else if (::mkdir(path_.c_str(), 0777) == 0) {
      descriptor_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (descriptor_ < 0) { // no more descriptors
        const int error = errno;
        ::rmdir(path_.c_str());
        errno = error;
        break;
      }
    }
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) fail(file);
  ::flock(descriptor_, LOCK_EX | LOCK_NB); // where there are no locks, the process's number has to do
  struct stat old {};
  if (kind == Kind::folder || ::stat(target.c_str(), &old) != 0 || give_what_it_had(descriptor_, old)) return;
  const int error = errno;
  ::unlink(path_.c_str());
  ::close(descriptor_);
  errno = error;
  fail(file);
}

PartFile::~PartFile() {
  if (!path_.empty()) {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  if (descriptor_ >= 0) ::close(descriptor_);
}

void PartFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count >= 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) fail(file_);
  }
}

void PartFile::write_at(std::uint64_t place, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (count < 0 && errno != EINTR) fail(file_);
    if (count < 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(count));
    place += static_cast<std::uint64_t>(count);
  }
}

void PartFile::put_in_place() {
  if (::fsync(descriptor_) != 0) fail(file_);
  // Some file systems report a failed write only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(file_);
  if (::rename(path_.c_str(), target_.c_str()) != 0) fail(file_);
  path_.clear();
  // The rename itself outlives a power cut only once the folder is on disk; where a file system cannot do
  // that, the file is whole all the same.
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

} // namespace flyball
