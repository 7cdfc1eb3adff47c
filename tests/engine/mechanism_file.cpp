#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace flyball;
using namespace flyball::test;
namespace fs = std::filesystem;

namespace {

// A folder of its own, gone afterwards.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "flyball-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  std::ptrdiff_t count() const {
    return std::distance(fs::directory_iterator(path_), fs::directory_iterator());
  }

 private:
  fs::path path_;
};

std::string message_of(auto&& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("Bytes come back as they were written") {
  const Folder folder;
  const std::string bytes("a\0\r\n\xFF", 5);
  write_bytes(folder / "file", bytes);
  CHECK(read_bytes(folder / "file") == bytes);
  write_bytes(folder / "file", "");
  CHECK(read_bytes(folder / "file").empty());
  CHECK(folder.count() == 1);
}

TEST_CASE("A reader never sees half a file") {
  const Folder folder;
  const fs::path file = folder / "file";
  write_bytes(file, std::string(100000, 'a'));
  std::atomic<bool> done = false;
  std::thread writer([&] {
    for (int i = 0; i < 50; ++i)
      write_bytes(file, std::string(100000, static_cast<char>('a' + i % 26)));
    done = true;
  });
  int torn = 0;
  while (!done) {
    const std::string bytes = read_bytes(file);
    if (bytes.size() != 100000 ||
        std::any_of(bytes.begin(), bytes.end(), [&](char c) { return c != bytes[0]; }))
      ++torn;
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(folder.count() == 1);
}

TEST_CASE("A write that fails leaves the old file and nothing else") {
  const Folder folder;
  const fs::path file = folder / "file";
  write_bytes(file, "old");
  rlimit old_limit{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = old_limit;
  limit.rlim_cur = 1000;
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  const std::string message = message_of([&] { write_bytes(file, std::string(5000, 'x')); });
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &old_limit) == 0);
  std::signal(SIGXFSZ, old_handler);
  CHECK(message == file.string() + ": cannot write: File too large");
  CHECK(read_bytes(file) == "old");
  CHECK(folder.count() == 1);
}

TEST_CASE("Permissions and symbolic links outlive a save") {
  const Folder folder;
  write_bytes(folder / "file", "old");
  fs::permissions(folder / "file", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("file", folder / "link");
  fs::create_symlink("new", folder / "dangling");
  write_bytes(folder / "link", "through");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(read_bytes(folder / "file") == "through");
  CHECK(fs::status(folder / "file").permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  write_bytes(folder / "dangling", "made");
  CHECK(read_bytes(folder / "new") == "made");
}

TEST_CASE("A pipe is written directly") {
  const Folder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::string received;
  std::thread reader([&] { received = read_bytes(pipe); });
  write_bytes(pipe, "through the pipe");
  reader.join();
  CHECK(received == "through the pipe");
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("A pipe that does not block is waited for") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  for (const int end : ends)
    REQUIRE(::fcntl(end, F_SETFL, O_NONBLOCK) == 0);
  const std::string sent(1'000'000, 'x'); // more than it holds
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    write_bytes("/dev/fd/" + std::to_string(ends[1]), sent);
    ::close(ends[1]);
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::string received = read_bytes("/dev/fd/" + std::to_string(ends[0]));
  writer.join();
  ::close(ends[0]);
  CHECK(received == sent);
}

TEST_CASE("The longest names that a file system takes can be written") {
  const Folder folder;
  for (const std::string letter : {"x", "\u00e4"}) {
    std::string name = "n";
    while (name.size() + letter.size() <= 255)
      name += letter;
    write_bytes(folder / name, "there");
    CHECK(read_bytes(folder / name) == "there");
  }
  CHECK(folder.count() == 2);
}

TEST_CASE("Standard output goes on where it was, also when it is a file") {
  const Folder folder;
  const fs::path file = folder / "out";
  std::fflush(stdout);
  const int saved = ::dup(STDOUT_FILENO);
  std::FILE* out = std::fopen(file.c_str(), "w");
  REQUIRE(out != nullptr);
  ::dup2(::fileno(out), STDOUT_FILENO);
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1"})
    write_bytes(name, std::string(name) + "\n");
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  std::fclose(out);
  CHECK(read_bytes(file) == "-\n/dev/stdout\n/dev/fd/1\n");
}

TEST_CASE("What cannot be read or written is told with the file and the reason") {
  const Folder folder;
  const std::string missing = (folder / "missing").string();
  const std::string beyond = (folder / "no/such/folder").string();
  const std::string itself = (folder / ".").string();
  CHECK(message_of([&] { read_bytes(missing); }) == missing + ": cannot read: No such file or directory");
  CHECK(message_of([&] { read_bytes(itself); }) == itself + ": cannot read: Is a directory");
  CHECK(message_of([&] { write_bytes(beyond, "x"); }) ==
        beyond + ": cannot write: No such file or directory");
  CHECK(message_of([&] { write_bytes(itself, "x"); }) == itself + ": cannot write: Is a directory");
  CHECK(message_of([&] { write_bytes("", "x"); }) == "cannot write: No such file or directory");
  CHECK(message_of([&] { load_scene(missing); }) == missing + ": cannot read: No such file or directory");
}

TEST_CASE("Mistakes in a scene file begin with the file") {
  const Folder folder;
  const fs::path file = folder / "scene.json";
  write_bytes(file, "{\"flyball\": 1,");
  CHECK_THAT(message_of([&] { load_scene(file); }),
             ContainsSubstring(file.string() + ": line 1, column 15: not JSON"));
  write_bytes(file, R"({"flyball": 1, "name": "x", "bodies": [], "joints": [], "forces": 3})");
  CHECK(message_of([&] { load_scene(file); }) ==
        file.string() + ": forces: expected an array of objects, found 3");
  write_bytes(file, "");
  CHECK_THAT(message_of([&] { load_scene(file); }), ContainsSubstring(file.string() + ": empty; expected"));
}

TEST_CASE("A scene is saved and loaded") {
  const Folder folder;
  const Mechanism governor = shipped("governor");
  save_scene(governor, folder / "copy.json");
  CHECK(load_scene(folder / "copy.json") == governor);
}

TEST_CASE("What has no end is not read") {
  CHECK_THAT(message_of([] { read_bytes("/dev/zero"); }),
             ContainsSubstring("/dev/zero: expected at most 256 MB"));
  const Folder folder;
  write_bytes(folder / "large", "");
  fs::resize_file(folder / "large", largest_file + 1); // nothing of it is on disk
  CHECK_THAT(message_of([&] { read_bytes(folder / "large"); }), ContainsSubstring("expected at most 256 MB"));
}

TEST_CASE("A pipe without a writer is not waited for longer than asked, and none is replaced") {
  const Folder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(message_of([&] { read_bytes(pipe, 0.01); }),
             ContainsSubstring("nothing came from it for 0.01 s"));
  CHECK_THAT(message_of([&] { replace_file(pipe, "text"); }), ContainsSubstring("no regular file"));
  CHECK_THAT(message_of([&] { replace_file("/dev/null", "text"); }), ContainsSubstring("no regular file"));
  CHECK_THAT(message_of([&] { replace_file("-", "text"); }), ContainsSubstring("no regular file"));
  CHECK_THAT(message_of([&] { write_bytes(pipe, "text"); }), ContainsSubstring("no program reads from"));
  std::string read;
  std::thread reader([&] { read = read_bytes(pipe); });
  write_bytes(pipe, "through the pipe");
  reader.join();
  CHECK(read == "through the pipe");
  replace_file(folder / "file", "text");
  CHECK(read_bytes(folder / "file") == "text");
}

TEST_CASE("Two names of a file are known to be the same") {
  const Folder folder;
  const fs::path file = folder / "file";
  write_bytes(file, "text");
  fs::create_symlink("file", folder / "link");
  fs::create_hard_link(file, folder / "hard");
  CHECK(same_file(file, folder / "link"));
  CHECK(same_file(file, folder / "hard"));
  CHECK(same_file(folder / "new", folder / "./new"));
  CHECK_FALSE(same_file(file, folder / "new"));
  CHECK_FALSE(same_file("/dev/null", "/dev/null"));
  CHECK_FALSE(same_file(file, "-"));
}

TEST_CASE("Parts that a killed program left go when the next one writes there") {
  const Folder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  const std::string dead = std::to_string(child);
  write_bytes(folder / (".scene.json." + dead + "-0.part"), "half");
  fs::create_directory(folder / (".film.png." + dead + "-12.part"));
  write_bytes(folder / (".film.png." + dead + "-12.part/film-0001.png"), "half");
  const std::vector<std::string> kept{".scene.json." + std::to_string(::getpid()) + "-0.part",
                                      ".scene.json." + dead + ".part", "scene.json." + dead + "-0.part",
                                      "." + dead + "-0.part", ".scene.json." + dead + "-0.part.txt"};
  for (const std::string& name : kept)
    std::ofstream(folder / name) << "not ours";
  // Another machine's process on a shared disk has a number of its own, and a lock.
  const fs::path locked = folder / (".locked." + dead + "-0.part");
  const int lock = ::open(locked.c_str(), O_CREAT | O_WRONLY, 0600);
  REQUIRE(::flock(lock, LOCK_EX) == 0);
  write_bytes(folder / "scene.json", "text");
  CHECK(folder.count() == static_cast<std::ptrdiff_t>(kept.size()) + 2);
  CHECK(fs::exists(locked));
  ::close(lock);
  write_bytes(folder / "scene.json", "text");
  CHECK_FALSE(fs::exists(locked));
}
