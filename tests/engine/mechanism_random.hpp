// Seeded random mechanisms, any value in any field: well-formed, but rarely meaningful.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <random>
#include <string>
#include <vector>

namespace flyball::test {

class RandomMechanism {
 public:
  explicit RandomMechanism(std::uint32_t seed) : engine_(seed) {}
  Mechanism operator()();

 private:
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(count)); }
  bool maybe() { return below(2) == 0; }
  double number();
  std::string text();
  std::string description() { return maybe() ? "" : text(); }
  Vec3 vector() { return {number(), number(), number()}; }
  Shape shape();
  Body body();
  Coordinate coordinate();
  Joint joint();
  Force force();

  std::mt19937 engine_;
};

} // namespace flyball::test
