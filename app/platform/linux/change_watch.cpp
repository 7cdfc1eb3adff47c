#include "app/platform/change_watch.hpp"

#include <array>
#include <atomic>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <mutex>
#include <poll.h>
#include <set>
#include <string>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t of_folders = IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO | IN_MODIFY |
                                     IN_CLOSE_WRITE | IN_ATTRIB | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
// Of the file itself, too: another hard link may lie in another folder.
constexpr std::uint32_t of_files = IN_MODIFY | IN_CLOSE_WRITE | IN_ATTRIB;

// File systems that other machines write to as well, by statfs's numbers (see statfs(2)).
bool is_shared(const fs::path& folder) {
  struct statfs found {};
  if (::statfs(folder.c_str(), &found) != 0) return true;
  constexpr std::array<std::uint32_t, 9> shared{0x6969,     0xFF534D42, 0xFE534D42, 0x517B,    0x65735546,
                                                0x01021997, 0x5346414F, 0x00C36400, 0x47504653};
  for (const std::uint32_t type : shared) // NFS, CIFS, SMB2, SMB, FUSE, 9P, AFS, Ceph, GPFS
    if (static_cast<std::uint32_t>(found.f_type) == type) return true;
  return false;
}

// The file and what its links lead to in turn.
std::vector<fs::path> chain_of(fs::path file) {
  std::vector<fs::path> chain;
  for (int links = 0; links < 40; ++links) {
    chain.push_back(file);
    std::error_code none;
    const fs::path next = fs::read_symlink(file, none);
    if (none) break;
    file = next.is_absolute() ? next : file.parent_path() / next;
  }
  return chain;
}

} // namespace

struct ChangeWatch::State {
  std::function<void()> on_change;
  int events = -1, stop = -1;
  std::mutex mutex;                           // of names
  std::map<int, std::set<std::string>> names; // by watch: what matters in a folder; none for a file itself
  std::atomic<bool> changed = false;
  bool tells = false;
  std::thread thread;

  explicit State(std::function<void()> call) : on_change(std::move(call)) {
    events = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    stop = ::eventfd(0, EFD_CLOEXEC);
    if (events >= 0 && stop >= 0) thread = std::thread([this] { listen(); });
  }
  ~State() {
    if (thread.joinable()) {
      ::eventfd_write(stop, 1);
      thread.join();
    }
    if (events >= 0) ::close(events);
    if (stop >= 0) ::close(stop);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void listen() {
    std::array<pollfd, 2> wanted{
        {{.fd = events, .events = POLLIN, .revents = 0}, {.fd = stop, .events = POLLIN, .revents = 0}}};
    for (;;) {
      if (::poll(wanted.data(), wanted.size(), -1) < 0) continue;
      if (wanted[1].revents != 0) return;
      if (read_events() && !changed.exchange(true)) on_change();
    }
  }

  // Whether one of them matters.
  bool read_events() {
    alignas(inotify_event) std::array<char, 4096> buffer;
    bool matters = false;
    for (;;) {
      const ssize_t count = ::read(events, buffer.data(), buffer.size());
      if (count <= 0) return matters;
      for (std::size_t at = 0; at < static_cast<std::size_t>(count);) {
        inotify_event event{};
        std::memcpy(&event, buffer.data() + at, sizeof(event));
        const char* name = event.len > 0 ? buffer.data() + at + sizeof(event) : "";
        matters = matters || concerns(event, name);
        at += sizeof(event) + event.len;
      }
    }
  }

  bool concerns(const inotify_event& event, const char* name) {
    if ((event.mask & IN_Q_OVERFLOW) != 0) return true;
    const std::lock_guard lock(mutex);
    const auto found = names.find(event.wd);
    if (found == names.end()) return false; // of the file before
    return found->second.empty() || *name == 0 || found->second.contains(name);
  }

  void watch(const fs::path& file) {
    const std::lock_guard lock(mutex);
    std::map<int, std::set<std::string>> wanted;
    tells = events >= 0 && thread.joinable();
    if (!file.empty()) {
      for (const fs::path& path : chain_of(file)) {
        const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
        const int in_folder = ::inotify_add_watch(events, folder.c_str(), of_folders);
        if (in_folder < 0 || is_shared(folder)) tells = false;
        if (in_folder >= 0) wanted[in_folder].insert(path.filename().string());
      }
      if (const int itself = ::inotify_add_watch(events, file.c_str(), of_files);
          itself >= 0 && !wanted.contains(itself))
        wanted[itself];
    }
    for (const auto& [descriptor, unused] : names)
      if (!wanted.contains(descriptor)) ::inotify_rm_watch(events, descriptor);
    names = std::move(wanted);
  }
};

ChangeWatch::ChangeWatch() = default;
ChangeWatch::ChangeWatch(std::function<void()> on_change)
    : state_(std::make_unique<State>(std::move(on_change))) {}
ChangeWatch::~ChangeWatch() = default;
ChangeWatch::ChangeWatch(ChangeWatch&&) noexcept = default;
ChangeWatch& ChangeWatch::operator=(ChangeWatch&&) noexcept = default;

void ChangeWatch::watch(const fs::path& file) {
  if (state_) state_->watch(file);
}

bool ChangeWatch::tells() const {
  return state_ && state_->tells;
}

bool ChangeWatch::changed() const {
  return state_ && state_->changed;
}

void ChangeWatch::take_change() {
  if (state_) state_->changed = false;
}

} // namespace flyball
