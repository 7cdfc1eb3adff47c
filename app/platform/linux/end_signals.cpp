#include "app/platform/end_signals.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <utility>

namespace flyball {

namespace {

constexpr std::array ends{SIGINT, SIGTERM, SIGHUP};

// Signals find their handler by these alone: the pipe carries the number of each that came, 0 from the
// destructor.
std::array<int, 2> ends_of_pipe{-1, -1};
std::array<struct sigaction, ends.size()> former{};

// The signal that came, while they are put off.
std::atomic<int> put_off = 0;
static_assert(std::atomic<int>::is_always_lock_free, "or a signal's handler may not touch it");

// Those that are not ignored, as under nohup.
void handle_with(void (*handler)(int), int flags) {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    struct sigaction noted {};
    noted.sa_handler = handler;
    noted.sa_flags = flags;
    sigemptyset(&noted.sa_mask);
    sigaction(ends[i], nullptr, &former[i]);
    if (former[i].sa_handler != SIG_IGN) sigaction(ends[i], &noted, nullptr);
  }
}

void handle_as_before() {
  for (std::size_t i = 0; i < ends.size(); ++i)
    sigaction(ends[i], &former[i], nullptr);
}

void send(int number) {
  const auto byte = static_cast<unsigned char>(number);
  // A full pipe has enough to be read.
  [[maybe_unused]] const ssize_t written = ::write(ends_of_pipe[1], &byte, 1);
}

void note(int signal) {
  const int error = errno;
  send(signal);
  errno = error;
}

// The number read from the pipe, or -1 where nothing came in time; `seconds` below zero wait for ever.
int receive(double seconds) {
  pollfd wanted{.fd = ends_of_pipe[0], .events = POLLIN, .revents = 0};
  int found = 0;
  do
    found = ::poll(&wanted, 1, seconds < 0 ? -1 : static_cast<int>(seconds * 1e3));
  while (found < 0 && errno == EINTR);
  unsigned char byte = 0;
  return found > 0 && ::read(ends_of_pipe[0], &byte, 1) == 1 ? byte : -1;
}

// Not that of a library, which may have a handler of its own: UCX, that MPI brings, goes on with traces after
// SIGHUP.
void take_usual_course(int signal) {
  std::signal(signal, SIG_DFL);
  ::kill(::getpid(), signal);
}

} // namespace

EndSignals::EndSignals(std::function<void()> wake, std::function<void()> keep, double patience)
    : wake_(std::move(wake)), keep_(std::move(keep)), patience_(patience) {
  if (::pipe2(ends_of_pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) return; // they end the program as usual
  thread_ = std::thread([this] { listen(); });
  handle_with(note, SA_RESTART);
}

EndSignals::~EndSignals() {
  if (!thread_.joinable()) return;
  handle_as_before();
  send(0);
  thread_.join();
  for (int& end : ends_of_pipe)
    ::close(std::exchange(end, -1));
  if (came_ != 0) take_usual_course(came_);
}

void EndSignals::listen() {
  int signal = 0;
  do
    signal = receive(-1);
  while (signal < 0);
  if (signal == 0) return;
  came_ = signal;
  wake_();
  const int next = receive(patience_);
  if (next == 0) return; // the loop has ended
  keep_();
  take_usual_course(next > 0 ? next : signal);
}

EndSignalsPutOff::EndSignalsPutOff() {
  put_off = 0;
  handle_with([](int signal) { put_off = signal; }, 0);
}

EndSignalsPutOff::~EndSignalsPutOff() {
  handle_as_before();
  if (put_off != 0) take_usual_course(put_off);
}

bool EndSignalsPutOff::came_one() {
  return put_off != 0;
}

} // namespace flyball
