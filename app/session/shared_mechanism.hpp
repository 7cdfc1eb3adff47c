// A mechanism that nobody changes any more, compared by its numbers: what it is called makes no difference.
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
    if (pointer == other.pointer) return true;
    if (pointer->name == other->name && pointer->description == other->description)
      return *pointer == *other.pointer;
    if (pointer->bodies != other->bodies || pointer->joints != other->joints) return false; // mostly
    Mechanism called = *other.pointer;
    called.name = pointer->name;
    called.description = pointer->description;
    return *pointer == called;
  }
};

} // namespace flyball
