#include "engine/mechanism/file.hpp"

#include "engine/mechanism/error.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace flyball {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, std::string_view action, int error) {
  throw SceneError(file.string(), "cannot " + std::string(action) + ": " + std::strerror(error));
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  // Some file systems report a failed write only here.
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

// The descriptor of this process that a path stands for, or -1. Opening such a path anew would start over
// at the beginning of a file that standard output was sent to.
int own_descriptor(const fs::path& file, int standard) {
  const std::string name = file.string();
  if (name == "-") return standard;
  constexpr std::array<std::string_view, 3> names{"/dev/stdin", "/dev/stdout", "/dev/stderr"};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i]) return static_cast<int>(i);
  constexpr std::string_view folder = "/dev/fd/";
  if (!name.starts_with(folder)) return -1;
  int fd = -1;
  const char* last = name.data() + name.size();
  const auto result = std::from_chars(name.data() + folder.size(), last, fd);
  return result.ec == std::errc{} && result.ptr == last ? fd : -1;
}

std::string read_all(const fs::path& file, int fd) {
  std::string bytes;
  std::array<char, 65536> buffer{};
  for (;;) {
    const ssize_t count = ::read(fd, buffer.data(), buffer.size());
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
    if (count == 0) return bytes;
    if (count < 0 && errno != EINTR) fail(file, "read", errno);
  }
}

void write_all(const fs::path& file, int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count >= 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) fail(file, "write", errno);
  }
}

// Where a chain of symbolic links ends, whether or not anything is there yet.
fs::path follow_links(const fs::path& file) {
  fs::path path = file;
  for (int links = 0; links < 40; ++links) {
    std::error_code error;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return path;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  fail(file, "write", ELOOP);
}

// A name beside `target` that nothing has, opened for writing.
std::pair<fs::path, int> open_beside(const fs::path& file, const fs::path& target, mode_t mode) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    fs::path path = target;
    path.replace_filename("." + target.filename().string() + "." + std::to_string(::getpid()) + "-" +
                          std::to_string(attempt) + ".part");
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (fd >= 0) return {path, fd};
    if (errno != EEXIST) fail(file, "write", errno);
  }
  fail(file, "write", EEXIST);
}

void replace(const fs::path& file, const fs::path& target, const struct stat* old, std::string_view bytes) {
  auto [part, fd] = open_beside(file, target, 0666);
  try {
    Descriptor out(fd);
    if (old != nullptr && ::fchmod(fd, old->st_mode & 07777U) != 0) fail(file, "write", errno);
    write_all(file, fd, bytes);
    if (::fsync(fd) != 0) fail(file, "write", errno);
    if (!out.close()) fail(file, "write", errno);
    if (::rename(part.c_str(), target.c_str()) != 0) fail(file, "write", errno);
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
  // The rename itself outlives a power cut only once the folder is on disk; where a file system cannot do
  // that, the file is whole all the same.
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() >= 0) ::fsync(directory.get());
}

} // namespace

std::string read_bytes(const fs::path& file) {
  if (const int own = own_descriptor(file, STDIN_FILENO); own >= 0) return read_all(file, own);
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (in.get() < 0) fail(file, "read", errno);
  return read_all(file, in.get());
}

void write_bytes(const fs::path& file, std::string_view bytes) {
  if (const int own = own_descriptor(file, STDOUT_FILENO); own >= 0) {
    std::fflush(nullptr);
    return write_all(file, own, bytes);
  }
  const fs::path target = follow_links(file);
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) fail(file, "write", EISDIR);
  if (exists && !S_ISREG(old.st_mode)) {
    Descriptor out(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.get() < 0) fail(file, "write", errno);
    write_all(file, out.get(), bytes);
    if (!out.close()) fail(file, "write", errno);
    return;
  }
  // A file marked read-only is meant to stay; renaming over it would not ask.
  if (exists && ::access(target.c_str(), W_OK) != 0) fail(file, "write", errno);
  if (!target.has_filename()) fail(file, "write", ENOENT);
  replace(file, target, exists ? &old : nullptr, bytes);
}

} // namespace flyball
