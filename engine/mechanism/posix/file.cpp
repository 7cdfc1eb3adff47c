#include "engine/mechanism/file.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/part_file.hpp"
#include "engine/mechanism/text.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <thread>
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

[[noreturn]] void fail_too_large(const fs::path& file) {
  throw SceneError(file.string(),
                   "expected at most " + std::to_string(largest_file / 1'000'000) + " MB, and there is more");
}

// Whether to go on after a call that failed: a signal came between, or the descriptor does not block, as who
// started the program may have set it, and is now ready.
bool try_again(int fd, short ready) {
  if (errno != EAGAIN) return errno == EINTR;
  pollfd it{.fd = fd, .events = ready, .revents = 0};
  ::poll(&it, 1, -1);
  return true;
}

// Until the end, waiting for more at most `patience` seconds at a time.
std::string read_all(const fs::path& file, int fd, std::optional<double> patience) {
  std::string bytes;
  std::array<char, 65536> buffer{};
  for (;;) {
    if (patience) {
      pollfd more{.fd = fd, .events = POLLIN, .revents = 0};
      const int found = ::poll(&more, 1, static_cast<int>(std::ceil(*patience * 1e3)));
      if (found == 0)
        throw SceneError(file.string(), "cannot read: it is no regular file, and nothing came from it for " +
                                            rounded_text(*patience, 2) + " s");
      if (found < 0 && errno != EINTR) fail(file, "read", errno);
      if (found < 0) continue;
    }
    const ssize_t count = ::read(fd, buffer.data(), buffer.size());
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
    if (count == 0) return bytes;
    if (count < 0 && !try_again(fd, POLLIN)) fail(file, "read", errno);
    if (bytes.size() > largest_file) fail_too_large(file);
  }
}

void write_all(const fs::path& file, int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count >= 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && !try_again(fd, POLLOUT)) fail(file, "write", errno);
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

// Of a regular file, or one that is not there yet.
void check_replaceable(const fs::path& file, const fs::path& target, bool exists) {
  // A file marked read-only is meant to stay; renaming over it would not ask.
  if (exists && ::access(target.c_str(), W_OK) != 0) fail(file, "write", errno);
  if (!target.has_filename()) fail(file, "write", ENOENT);
}

// What a path stands for, through links; nothing where there is nothing.
std::optional<struct stat> find(const fs::path& file, int standard) {
  struct stat found {};
  const int own = own_descriptor(file, standard);
  const int result = own >= 0 ? ::fstat(own, &found) : ::stat(file.c_str(), &found);
  return result == 0 ? std::optional(found) : std::nullopt;
}

} // namespace

std::string read_bytes(const fs::path& file, std::optional<double> patience) {
  if (const int own = own_descriptor(file, STDIN_FILENO); own >= 0) return read_all(file, own, std::nullopt);
  // A named pipe that nobody writes to would not even open.
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | (patience ? O_NONBLOCK : 0)));
  if (in.get() < 0) fail(file, "read", errno);
  struct stat found {};
  if (::fstat(in.get(), &found) != 0) fail(file, "read", errno);
  if (S_ISREG(found.st_mode) && static_cast<std::size_t>(found.st_size) > largest_file) fail_too_large(file);
  return read_all(file, in.get(), S_ISREG(found.st_mode) ? std::nullopt : patience);
}

namespace {

// A pipe without a reader would hold the program for ever: it has a second to come.
int open_for_writing(const fs::path& file, const fs::path& target, bool pipe) {
  for (int tries = 0;; ++tries) {
    const int opened = ::open(target.c_str(), O_WRONLY | O_CLOEXEC | (pipe ? O_NONBLOCK : 0));
    if (opened >= 0) {
      if (pipe) ::fcntl(opened, F_SETFL, O_WRONLY);
      return opened;
    }
    if (!pipe || errno != ENXIO) fail(file, "write", errno);
    if (tries == 20) throw SceneError(file.string(), "cannot write: it is a pipe that no program reads from");
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

} // namespace

struct FileWriter::State {
  fs::path file;
  std::optional<PartFile> part{}; // else written directly
  std::optional<Descriptor> opened{};
  int direct = -1;

  explicit State(const fs::path& f) : file(f) {
    direct = own_descriptor(file, STDOUT_FILENO);
    if (direct >= 0) {
      std::fflush(nullptr);
      return;
    }
    const fs::path target = follow_links(file);
    struct stat old {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (exists && S_ISDIR(old.st_mode)) fail(file, "write", EISDIR);
    if (!exists || S_ISREG(old.st_mode)) {
      check_replaceable(file, target, exists);
      part.emplace(file, target, PartFile::Kind::file);
    } else {
      opened.emplace(open_for_writing(file, target, S_ISFIFO(old.st_mode)));
      direct = opened->get();
    }
  }
};

FileWriter::FileWriter(const fs::path& file) : state_(std::make_unique<State>(file)) {}
FileWriter::~FileWriter() = default;
FileWriter::FileWriter(FileWriter&&) noexcept = default;
FileWriter& FileWriter::operator=(FileWriter&&) noexcept = default;

void FileWriter::write(std::string_view bytes) {
  if (state_->part)
    state_->part->write(bytes);
  else
    write_all(state_->file, state_->direct, bytes);
}

void FileWriter::write_at(std::uint64_t place, std::string_view bytes) {
  if (!state_->part)
    throw SceneError(state_->file.string(), "cannot write: it is no regular file, but a pipe or a device");
  state_->part->write_at(place, bytes);
}

void FileWriter::finish() {
  if (state_->part) state_->part->put_in_place();
  if (state_->opened && !state_->opened->close()) fail(state_->file, "write", errno);
}

void write_bytes(const fs::path& file, std::string_view bytes) {
  FileWriter out(file);
  out.write(bytes);
  out.finish();
}

void replace_file(const fs::path& file, std::string_view bytes) {
  const fs::path target = follow_links(file);
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) fail(file, "write", EISDIR);
  if (own_descriptor(file, STDOUT_FILENO) >= 0 || (exists && !S_ISREG(old.st_mode)))
    throw SceneError(file.string(), "cannot write: it is no regular file, but a pipe or a device");
  check_replaceable(file, target, exists);
  PartFile part(file, target, PartFile::Kind::file);
  part.write(bytes);
  part.put_in_place();
}

bool same_file(const fs::path& input, const fs::path& output) {
  const auto in = find(input, STDIN_FILENO), out = find(output, STDOUT_FILENO);
  if (in && out) return S_ISREG(in->st_mode) && in->st_dev == out->st_dev && in->st_ino == out->st_ino;
  if (in || out || input == "-" || output == "-") return false;
  std::error_code failed;
  const fs::path one = fs::weakly_canonical(input, failed);
  return !failed && one == fs::weakly_canonical(output, failed) && !failed;
}

} // namespace flyball
