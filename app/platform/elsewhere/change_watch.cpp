// One has to look now and then.
#include "app/platform/change_watch.hpp"

namespace flyball {

struct ChangeWatch::State {};

ChangeWatch::ChangeWatch() = default;
ChangeWatch::ChangeWatch(std::function<void()>) {}
ChangeWatch::~ChangeWatch() = default;
ChangeWatch::ChangeWatch(ChangeWatch&&) noexcept = default;
ChangeWatch& ChangeWatch::operator=(ChangeWatch&&) noexcept = default;

void ChangeWatch::watch(const std::filesystem::path&) {}

bool ChangeWatch::tells() const {
  return false;
}

bool ChangeWatch::changed() const {
  return false;
}

void ChangeWatch::take_change() {}

} // namespace flyball
