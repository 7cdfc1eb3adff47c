// Every equilibrium that a bounded search finds. Nothing of it is made before a person asks.
#pragma once

#include "app/live/background.hpp"
#include "engine/report/analysis.hpp"

#include <memory>

namespace flyball {

struct FoundStates {
  AllSolutions all;
  bool cancelled = false; // then the list is not of use
  double run_time_s = 0;
};

struct StatesState {
  std::unique_ptr<Background<FoundStates>> task;
  std::optional<FoundStates> result;
  std::uint64_t asked = 0, of = 0; // revisions of the document: last searched, and of the result
  std::uint64_t lists = 0;         // so far, for the table's widths
  std::string problem;             // why there is no list, in words
};

} // namespace flyball
