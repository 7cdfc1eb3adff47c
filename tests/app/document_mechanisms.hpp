// Seeded random mechanisms that settle near their drawn pose, and what an isometry must do to them.
#pragma once

#include "app/document/isometry.hpp"
#include "app/document/part.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/support/dice.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace flyball::test {

struct RandomOptions {
  // What acts along the components of spherical and free joints is the same along all three, so that it can
  // be turned into any direction.
  bool alike = false;
};

// A table on the ground, at rest or turning about the vertical, with up to four bodies on it by joints of
// all types, springs on every coordinate, stops, loops, gears, and forces of all types. No names end in
// digits.
Mechanism random_mechanism(std::uint32_t seed, const RandomOptions& options = {});

// All its bodies, joints and forces.
Selection everything_of(const Mechanism& mechanism);

// Checks that the second mechanism settles as the image of the first: every body, and every coordinate that
// stands for one of the first. `rename` gives the parts' names in the second. False where the first has no
// steady state to compare with.
bool check_settles_as_image(const Mechanism& first, const Mechanism& second, const Isometry& isometry,
                            const std::function<std::string(const std::string&)>& rename);

} // namespace flyball::test
