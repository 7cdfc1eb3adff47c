// The band of friction beyond the folds of a response curve. There no state is in balance without friction,
// but one joint with friction still holds some: up to where the band's edges, which are response curves of
// their own at the friction's limit, fold in their turn.
#pragma once

#include "engine/study/friction_ribbon.hpp"

namespace flyball {

// One tip for each fold of the diagram beyond which the band goes on, from beside the fold outwards. None
// with several joints that have friction, and where the band at the fold reaches another branch, whose ribbon
// goes on there. Cancelled, tips are missing. Throws SceneError for a number that the mechanism does not
// take.
std::vector<std::vector<RibbonPoint>> ribbon_tips(const Mechanism& mechanism, const std::string& address,
                                                  double from, double to, const ResponseDiagram& diagram,
                                                  const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
