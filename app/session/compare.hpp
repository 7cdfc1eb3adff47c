// Error against run time: the direct solution and the motion, measured on the scene as it is. Nothing is
// measured before a person asks.
#pragma once

#include "app/live/background.hpp"
#include "engine/study/compare.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace flyball {

struct Session;

struct CompareState {
  std::unique_ptr<Background<Comparison>> task; // made when it is first asked for
  std::optional<Comparison> result;
  std::uint64_t results = 0;           // so far
  std::shared_ptr<const Mechanism> of; // what was compared
  std::string problem;
  int repeats = 5;
};

void begin_comparison(Session& session);
// Takes what was measured.
void update_comparison(Session& session);
bool comparing(const Session& session);
// Whether the result is of the mechanism as it is now.
bool comparison_is_current(const Session& session);

} // namespace flyball
