#include "engine/system/division.hpp"

#include "engine/system/system.hpp"

#include <algorithm>
#include <bit>

namespace flyball {
namespace {

constexpr std::size_t most_parts = 16;

// Where parts may begin: links that hang from the spine, with nothing beyond them that hangs from before.
std::vector<std::size_t> limbs_of(const System& system, std::size_t spine) {
  std::vector<std::size_t> limbs;
  std::size_t earliest = system.links.size(); // link off the spine that this one or those beyond hang from
  for (std::size_t i = system.links.size(); i-- > spine;) {
    const int parent = system.links[i].parent;
    const bool off_spine = parent >= 0 && static_cast<std::size_t>(parent) >= spine;
    if (off_spine) earliest = std::min(earliest, static_cast<std::size_t>(parent));
    if (!off_spine && earliest >= i) limbs.push_back(i);
  }
  std::ranges::reverse(limbs);
  return limbs;
}

} // namespace

Division divide(const System& system, std::size_t fewest) {
  Division out;
  const std::size_t count = system.links.size(),
                    wanted = std::bit_floor(std::min(count / fewest, most_parts));
  std::vector<std::size_t> begins;
  if (wanted > 1) {
    while (out.spine < count && !system.links[out.spine].mobile)
      ++out.spine;
    const std::vector<std::size_t> limbs = limbs_of(system, out.spine);
    for (std::size_t k = 0; k < wanted; ++k) {
      const std::size_t even = out.spine + k * (count - out.spine) / wanted;
      const auto limb = std::ranges::lower_bound(limbs, even);
      if (limb != limbs.end() && (begins.empty() || *limb > begins.back())) begins.push_back(*limb);
    }
  }
  if (begins.size() < 2) {
    out.spine = 0;
    begins = {0};
  }
  for (std::size_t k = 0; k < begins.size(); ++k) {
    SystemPart part;
    part.first = begins[k];
    part.last = k + 1 < begins.size() ? begins[k + 1] : count;
    out.parts.push_back(std::move(part));
  }

  const bool whole = out.parts.size() == 1;
  constexpr int standing = -1, several = -2;
  const auto part_of = [&](int link) -> int {
    if (link < 0 || static_cast<std::size_t>(link) < out.spine) return standing;
    return static_cast<int>(std::ranges::upper_bound(begins, static_cast<std::size_t>(link)) -
                            begins.begin()) -
           1;
  };
  const auto common = [&](const PairEnds& ends) {
    const int a = part_of(ends.a), b = part_of(ends.b);
    return a == b || b == standing ? a : a == standing ? b : several;
  };
  const auto place = [&](int part, std::vector<int> SystemPart::*list, std::size_t element) {
    SystemPart& owner = whole       ? out.parts[0]
                        : part >= 0 ? out.parts[static_cast<std::size_t>(part)]
                                    : out.between;
    (owner.*list).push_back(static_cast<int>(element));
  };
  for (std::size_t i = 0; i < system.springs.size(); ++i)
    place(common(system.springs[i].ends), &SystemPart::springs, i);
  for (std::size_t i = 0; i < system.cuts.size(); ++i)
    place(system.cuts[i].type == JointType::gear ? several : common(system.cuts[i].ends), &SystemPart::cuts,
          i);
  for (std::size_t i = 0; i < system.body_forces.size(); ++i)
    place(part_of(system.body_forces[i].link), &SystemPart::body_forces, i);
  return out;
}

} // namespace flyball
