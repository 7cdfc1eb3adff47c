// A mechanism that nobody changes any more, compared by its numbers.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <memory>

namespace flyball {

struct SharedMechanism {
  std::shared_ptr<const Mechanism> pointer; // not null where it is compared

  const Mechanism& operator*() const { return *pointer; }
  const Mechanism* operator->() const { return pointer.get(); }
  // The same one is found equal without a look.
  bool operator==(const SharedMechanism& other) const {
    return pointer == other.pointer || *pointer == *other.pointer;
  }
};

} // namespace flyball
