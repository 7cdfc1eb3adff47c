// Room for numbers with rates, none of them set: expressions are so short that zeroing their room would take
// longer than to evaluate them.
#pragma once

#include "engine/mechanism/dual.hpp"

#include <cstddef>

namespace flyball {

template <std::size_t count>
struct UnsetDuals {
  UnsetDuals() {}
  Dual& operator[](std::size_t i) { return values[i]; }
  union {
    Dual values[count];
  };
};

} // namespace flyball
