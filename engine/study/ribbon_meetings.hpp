// Where bands of friction meet along a response curve: the band of one branch grows together with that of
// another at a value of the varied number, where their edges fold, and jumps there from one to both.
#pragma once

#include "engine/study/friction_ribbon.hpp"

namespace flyball {

// Adds to the points at all places two where bands meet between them: at numbers that no one tells apart in a
// picture, one with the band of several branches and one with that of one of them. Cancelled, meetings are
// missing. Throws SceneError for a number that the mechanism does not take.
void add_meetings(const Mechanism& mechanism, const std::string& address, std::span<const RibbonPlace> places,
                  std::vector<RibbonPoint>& points, const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
