#include "engine/linear/interruption.hpp"

namespace flyball {
namespace {

thread_local CancelFlag looked_at = nullptr;

} // namespace

Interruptible::Interruptible(CancelFlag cancel) noexcept : before_(looked_at) {
  if (cancel) looked_at = cancel;
}

Interruptible::~Interruptible() {
  looked_at = before_;
}

Uninterrupted::Uninterrupted() noexcept : before_(looked_at) {
  looked_at = nullptr;
}

Uninterrupted::~Uninterrupted() {
  looked_at = before_;
}

void interruption_point() {
  if (is_cancelled(looked_at)) throw Interrupted();
}

} // namespace flyball
