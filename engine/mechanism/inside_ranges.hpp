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
// none at an end, or as the mechanism stands, is among the system's elements; so are dampers, forces and
// masses that expressions make zero inside, as max(0, n - 6) does, but not everywhere (of some hundred places
// of the ranges): these are as they are at such a place. To compile and for nothing else. Nothing where
// expressions make no mechanism of such numbers. Throws SceneError for an address that names no number.
std::optional<Mechanism> inside_ranges(const Mechanism& mechanism, std::span<const NumberRange> ranges);

// Where the motion and how it changes with these numbers are asked for as the mechanism stands: dampers of
// joints that are zero now and not beside it are 1 in the SI unit. To compile and for nothing else.
Mechanism with_dampers_beside(const Mechanism& mechanism, std::span<const std::string> addresses);

} // namespace flyball
