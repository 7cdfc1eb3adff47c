// A ribbon of friction at as few points as a picture needs: close together where its edges bend.
#pragma once

#include "engine/study/friction_ribbon.hpp"

namespace flyball {

// friction_ribbon() at some of the places, and at those between where an edge bends, the number turns back or
// the band ends: until a line between neighbours leaves out no more than a hundredth of an edge's height over
// the places along which the number goes one way, as far as there are places; and where bands meet.
// `first`: with which it begins, ascending, both ends among them.
std::vector<RibbonPoint> friction_ribbon_at_bends(const Mechanism& mechanism, const std::string& address,
                                                  std::span<const RibbonPlace> places,
                                                  std::span<const std::size_t> first,
                                                  const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
