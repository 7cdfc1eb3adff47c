// Names nobody has yet.
#pragma once

#include "app/document/part.hpp"

#include <string>
#include <unordered_set>

namespace flyball {

// The names of one kind of part, to be taken one by one.
class UsedNames {
 public:
  UsedNames(const Mechanism& mechanism, PartKind kind);

  bool has(const std::string& name) const { return names_.contains(name); }
  // The name itself if it is free, otherwise the next one; in use from now on.
  std::string take(const std::string& name);
  // "arm2" after "arm1" and after "arm", or the first free one after it; in use from now on.
  std::string take_next(const std::string& name);
  // "arm1", "arm2", ...: the first free one; in use from now on.
  std::string take_first(const std::string& stem) { return take_numbered(stem, 1); }

 private:
  std::string take_numbered(const std::string& stem, int number);

  std::unordered_set<std::string> names_;
};

} // namespace flyball
