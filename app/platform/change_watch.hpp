// Tells that something has happened to a file, by inotify: in its folder, so that a file that is replaced or
// comes back is seen, and in those of the links that lead to it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

namespace flyball {

class ChangeWatch {
 public:
  ChangeWatch(); // tells nothing
  // `on_change` is called from a thread of its own, once until take_change().
  explicit ChangeWatch(std::function<void()> on_change);
  ~ChangeWatch();
  ChangeWatch(ChangeWatch&&) noexcept;
  ChangeWatch& operator=(ChangeWatch&&) noexcept;

  // This file instead of the one before; nothing for an empty path. To be called again when something has
  // happened: a new file or folder of the same name is another one.
  void watch(const std::filesystem::path& file);
  // Whether all changes of the file are told. Those that other machines make on a shared disk are not, nor is
  // anything where the system is out of watches: then one has to look now and then.
  bool tells() const;
  // Whether something has happened, until take_change().
  bool changed() const;
  void take_change();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
