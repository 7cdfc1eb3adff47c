// What goals, minima and shares of friction move.
#pragma once

#include <optional>
#include <string>

namespace flyball {

// A number that may be moved, by its address, in its unit; from < to.
struct FreeNumber {
  std::string address;
  double from = 0, to = 0;
  // Where change is counted from; as a rule the mechanism's own.
  std::optional<double> reference{};
  bool operator==(const FreeNumber&) const = default;
};

} // namespace flyball
