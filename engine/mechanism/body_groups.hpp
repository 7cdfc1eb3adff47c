// Which bodies hang together.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace flyball {

// Bodies by name: the ground is number 0, body i is i + 1.
class BodyNumbers {
 public:
  explicit BodyNumbers(const Mechanism& mechanism) {
    numbers_.reserve(mechanism.bodies.size() + 1);
    numbers_.emplace(ground_name, 0);
    for (const Body& body : mechanism.bodies)
      numbers_.emplace(body.name, numbers_.size());
  }
  bool has(std::string_view name) const { return numbers_.contains(name); }
  std::size_t operator[](std::string_view name) const { return numbers_.at(name); }
  std::size_t size() const { return numbers_.size(); }

 private:
  std::unordered_map<std::string_view, std::size_t> numbers_;
};

// Sets of connected bodies, merged as connections become known.
class BodyGroups {
 public:
  explicit BodyGroups(const BodyNumbers& numbers) : numbers_(numbers), parent_(numbers.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  // False if the two hung together already.
  bool join(const std::array<std::string, 2>& bodies) {
    const std::size_t a = root(numbers_[bodies[0]]), b = root(numbers_[bodies[1]]);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  bool on_ground(std::string_view body) { return first_of(body) == 0; }
  // The number of the first that it hangs together with; 0 where that is the ground.
  std::size_t first_of(std::string_view body) { return root(numbers_[body]); }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  const BodyNumbers& numbers_;
  std::vector<std::size_t> parent_;
};

} // namespace flyball
