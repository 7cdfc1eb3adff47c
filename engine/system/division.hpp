// A large mechanism in parts that passes over it take side by side: limbs of the tree that hang from the same
// standing or driven links, like the knots of a net. What acts between two of them comes after all.
//
// The division depends on the mechanism alone, and every part adds up for itself: an answer has the same bits
// on any number of cores.
#pragma once

#include "engine/system/side_by_side.hpp"

#include <vector>

namespace flyball {

struct System;

struct SystemPart {
  std::size_t first = 0, last = 0;             // its links; they hang from each other, or from the spine
  std::vector<int> springs, cuts, body_forces; // elements that move nothing beyond it
};

struct Division {
  std::size_t spine = 0;         // links before all parts, none of which any coordinate of q_R moves
  std::vector<SystemPart> parts; // at least one; of all but large mechanisms one, without a spine
  SystemPart between;            // what acts on several parts, or on the spine alone; it has no links
};

// A pass over fewer links is as good as done before another thread has begun (measured on nets of springs).
constexpr std::size_t fewest_links = 4096;

// Divides a compiled system, whose links and elements must be complete, into parts of about as many links,
// and of no fewer than that.
Division divide(const System& system, std::size_t fewest = fewest_links);

// Calls work(part, its index) for every part.
template <class Work>
void for_parts(const Division& division, const Work& work) {
  side_by_side(division.parts.size(), [&](std::size_t i) { work(division.parts[i], i); });
}

// Calls work(first, last) for as many runs of [0, count): for what writes by itself in the order of elements,
// which need not be that of the parts.
template <class Work>
void for_runs(const Division& division, std::size_t count, const Work& work) {
  const std::size_t runs = division.parts.size();
  side_by_side(runs, [&](std::size_t i) { work(count * i / runs, count * (i + 1) / runs); });
}

} // namespace flyball
