// The band that friction holds, as a ribbon over a response curve.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/friction_ribbon.hpp"

namespace flyball {

// Of one coordinate or measure, over points that follow one another along a branch, in SI units. Edges are
// named by when they are reached: the quantity lags behind, as friction opposes it; those over which it runs
// away are not drawn. Of the one joint with friction the way is drawn along which it goes as the number rises
// slowly from end to end of a stretch and falls again.
void add_ribbon(Plot& plot, std::span<const RibbonPoint> points, std::string_view name);

} // namespace flyball
