// Of what a system is compiled whose numbers go over ranges.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <span>
#include <string>

namespace flyball {

struct NumberRange {
  std::string address;
  double from = 0, to = 0; // in its unit, either way round
};

// The mechanism with all these numbers inside their ranges and none of them zero, so that a damper that is
// none at an end, or as the mechanism stands, is among the system's elements. Nothing where expressions make
// no mechanism of such numbers. Throws SceneError for an address that names no number.
std::optional<Mechanism> inside_ranges(const Mechanism& mechanism, std::span<const NumberRange> ranges);

} // namespace flyball
