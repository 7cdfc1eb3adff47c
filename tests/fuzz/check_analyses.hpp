// What must hold for every analysis of a valid mechanism: it ends soon after it is cancelled, by an answer
// without a number that is none or by a refusal in words.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace flyball::fuzz {

inline constexpr int analysis_count = 10;

// What does not hold, in words. `which` is below analysis_count and chooses among all equilibria, modes,
// branches, all branches, design, motion, comparison, sweep, linear models and the map's curves; what they
// vary is chosen by `seed`. Bytes that are no valid small mechanism are passed over. Cancelled after `limit`.
std::optional<std::string> check_analysis(std::string_view bytes, int which, unsigned seed,
                                          std::chrono::milliseconds limit);

} // namespace flyball::fuzz
