// A mechanism but for the numbers that a study varies, and for what changes no equilibrium: as long as it
// stays the same the study is up to date.
#pragma once

#include "app/document/explored.hpp"
#include "app/session/shared_mechanism.hpp"

namespace flyball {

class VariedMechanism {
 public:
  // With these numbers. Copied only where the mechanism or they are others than last time.
  const SharedMechanism& of(const std::shared_ptr<const Mechanism>& mechanism, const Explored& numbers);

 private:
  std::shared_ptr<const Mechanism> from_;
  Explored numbers_;
  SharedMechanism varied_;
};

} // namespace flyball
