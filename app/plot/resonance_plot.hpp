// A resonance curve: the mean of an output over a number, and the band that it moves through in a period.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/resonance_curve.hpp"

namespace flyball {

// Adds it to a plot of the output over the number, in SI units: means solid where the motion is stable,
// dashed where it is not, dotted where that is undecided; nothing where there is neither a motion nor a
// steady state. Motions and steady states are not joined. What is one number of each motion has no band.
void add_resonance(Plot& plot, const ResonanceCurve& curve, OutputKind kind, const std::string& name);

} // namespace flyball
