// A run that went on from an earlier moment of another: what a person sees who changes a number while it
// plays.
#pragma once

#include "engine/dynamics/simulation.hpp"

namespace flyball {

// A time no further from a sample than this part of the distance of samples is that sample's.
inline constexpr double same_sample = 1e-6;

// Index of the last sample at or before `time` (s), or at it by same_sample; 0 where all are later. The run
// must have samples.
std::size_t sample_before(const Run& run, double time);

// The first samples of `before`, the one of index `last` included, followed by `after`, which was started
// from state_at(before, last) and so repeats that sample. Energies go on where they stood. Just `after` where
// the two have different coordinates.
Run joined(const Run& before, std::size_t last, const Run& after);

} // namespace flyball
