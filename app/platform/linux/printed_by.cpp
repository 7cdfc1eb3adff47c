#include "app/platform/printed_by.hpp"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace flyball {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds look_again{20};

// Ends the child if it has not ended, and waits for it.
bool ended_well(pid_t child, bool stop) {
  if (stop) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return !stop && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

} // namespace

std::optional<std::string> printed_by(const std::vector<std::string>& command,
                                      std::chrono::milliseconds limit,
                                      const std::function<bool()>& given_up) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, ends[1], 1);
  ::posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
  std::vector<char*> words;
  for (const std::string& word : command)
    words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  pid_t child = 0;
  const bool runs = ::posix_spawnp(&child, words[0], &files, nullptr, words.data(), environ) == 0;
  ::posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  std::string text;
  const Clock::time_point end = Clock::now() + limit;
  bool finished = !runs;
  while (!finished && Clock::now() < end && !(given_up && given_up())) {
    pollfd wait{ends[0], POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(look_again.count())) <= 0) continue;
    char some[512];
    const ssize_t count = ::read(ends[0], some, sizeof some);
    finished = count == 0 || (count < 0 && errno != EINTR);
    if (count > 0) text.append(some, static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  return runs && ended_well(child, !finished) ? std::optional(text) : std::nullopt;
}

} // namespace flyball
