#include "app/platform/encoder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <stdexcept>
#include <string_view>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

extern char** environ;

namespace flyball {

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail_with(const std::string& action, int error) {
  throw std::runtime_error("cannot " + action + ": " + std::strerror(error));
}

class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds), start_(Clock::now()) {}
  double left() const { // s
    return std::max(0., seconds_ - std::chrono::duration<double>(Clock::now() - start_).count());
  }

 private:
  double seconds_;
  Clock::time_point start_;
};

// Writing to a process that has gone raises a signal that would end this one: kept from this thread, and
// taken away if it came.
class WithoutSigpipe {
 public:
  WithoutSigpipe() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    pending_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &former_);
  }
  ~WithoutSigpipe() {
    const timespec now{};
    if (!pending_)
      while (sigtimedwait(&pipe_, nullptr, &now) > 0) {
      }
    pthread_sigmask(SIG_SETMASK, &former_, nullptr);
  }
  WithoutSigpipe(const WithoutSigpipe&) = delete;
  WithoutSigpipe& operator=(const WithoutSigpipe&) = delete;

 private:
  sigset_t pipe_{}, former_{};
  bool pending_ = false;
};

class SpawnActions {
 public:
  // What the child gets as its standard input and error; its output goes nowhere.
  SpawnActions(int input, int error) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_adddup2(&files_, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files_, error, STDERR_FILENO);
    // In a group of its own: Ctrl+C in the terminal is this program's, which ends the child itself.
    posix_spawnattr_init(&attributes_);
    sigset_t none, pipe;
    sigemptyset(&none);
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &pipe);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnActions() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  const posix_spawn_file_actions_t* files() const { return &files_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

} // namespace

struct Encoder::State {
  pid_t child = -1; // -1: has ended
  int status = 0;   // of its end, as waitpid() tells
  int input = -1;   // the pipe to it; -1: closed
  std::vector<char> waiting;
  std::size_t sent = 0;                                        // of these
  std::unique_ptr<std::FILE, CloseFile> words{std::tmpfile()}; // its standard error

  explicit State(const std::vector<std::string>& arguments);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void close_input();
  bool flush(double seconds);
  bool ended(double seconds);
  [[noreturn]] void fail();
};

bool ffmpeg_available() {
  const char* const path = std::getenv("PATH");
  for (std::string_view rest = path ? path : ""; !rest.empty();) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string folder(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string file = (folder.empty() ? "." : folder) + "/ffmpeg";
    struct stat found {};
    if (::stat(file.c_str(), &found) == 0 && S_ISREG(found.st_mode) && ::access(file.c_str(), X_OK) == 0)
      return true;
  }
  return false;
}

Encoder::State::State(const std::vector<std::string>& arguments) {
  if (!words) fail_with("keep what ffmpeg says", errno);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_with("make a pipe", errno);
  input = ends[1];
  ::fcntl(input, F_SETFL, O_NONBLOCK); // of this end alone
  std::vector<std::string> line{"ffmpeg"};
  line.insert(line.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : line)
    argv.push_back(word.data());
  argv.push_back(nullptr);
  const SpawnActions actions(ends[0], ::fileno(words.get()));
  const int error =
      ::posix_spawnp(&child, "ffmpeg", actions.files(), actions.attributes(), argv.data(), environ);
  ::close(ends[0]);
  if (error == 0) return;
  child = -1;
  close_input();
  fail_with("start ffmpeg", error);
}

Encoder::State::~State() {
  close_input();
  if (child < 0) return;
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
}

void Encoder::State::close_input() {
  if (input >= 0) ::close(std::exchange(input, -1));
}

bool Encoder::State::flush(double seconds) {
  const Deadline deadline(seconds);
  const WithoutSigpipe quiet;
  while (sent < waiting.size()) {
    const ssize_t count = ::write(input, waiting.data() + sent, waiting.size() - sent);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {
      const double left = deadline.left();
      if (left <= 0) return false;
      pollfd ready{input, POLLOUT, 0};
      ::poll(&ready, 1, static_cast<int>(std::min(1000 * left + 1, 1000.)));
    } else if (errno != EINTR) {
      fail();
    }
  }
  return true;
}

// Whether the child has ended, waiting at most so long.
bool Encoder::State::ended(double seconds) {
  const Deadline deadline(seconds);
  while (child >= 0) {
    const pid_t which = ::waitpid(child, &status, WNOHANG);
    if (which == child)
      child = -1;
    else if (which < 0 && errno != EINTR)
      fail_with("wait for ffmpeg", errno);
    else if (deadline.left() <= 0)
      return false;
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

// With the last lines of what it has said.
void Encoder::State::fail() {
  close_input();
  constexpr double patience = 5; // s, for it to say why and go
  std::string how = " stopped";
  if (ended(patience)) {
    if (WIFSIGNALED(status))
      how = " was ended by signal " + std::to_string(WTERMSIG(status));
    else if (WEXITSTATUS(status) != 0)
      how = " failed with exit code " + std::to_string(WEXITSTATUS(status));
    else
      how = " ended before it had all frames";
  }
  std::string said;
  std::array<char, 4096> buffer{};
  std::rewind(words.get());
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), words.get()))
    said.append(buffer.data(), count);
  constexpr std::size_t most = 400;
  if (said.size() > most) {
    const std::size_t line = said.find('\n', said.size() - most);
    said.erase(0, line == std::string::npos || line + 1 == said.size() ? said.size() - most : line + 1);
  }
  while (!said.empty() && std::string_view(" \r\n").find(said.back()) != std::string_view::npos)
    said.pop_back();
  throw std::runtime_error("ffmpeg" + how + (said.empty() ? "" : ": " + said));
}

Encoder::Encoder(const std::vector<std::string>& arguments) : state_(std::make_unique<State>(arguments)) {}
Encoder::~Encoder() = default;

void Encoder::send(std::vector<char> bytes) {
  State& s = *state_;
  if (s.sent == s.waiting.size()) {
    s.waiting = std::move(bytes);
    s.sent = 0;
  } else {
    s.waiting.insert(s.waiting.end(), bytes.begin(), bytes.end());
  }
}

bool Encoder::flush(double seconds) {
  return state_->flush(seconds);
}

bool Encoder::finish(double seconds) {
  const Deadline deadline(seconds);
  State& s = *state_;
  if (s.input >= 0 && !s.flush(seconds)) return false;
  s.close_input();
  if (!s.ended(deadline.left())) return false;
  if (!WIFEXITED(s.status) || WEXITSTATUS(s.status) != 0) s.fail();
  return true;
}

} // namespace flyball
