// The boundary of hunting in the plane of two parameters as a plot in SI units.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/hopf_curve.hpp"

namespace flyball {

// Adds Hopf curves: parts where the loss is soft, hard or left open, and where other eigenvalues grow
// already; with the points at which soft turns into hard, and at which the frequency goes to zero.
void add_hunting_curves(Plot& plot, const PlaneCurves& curves);

Plot hunting_plot(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                  const PlaneCurves& curves);

// "6.55583 rad/s (1.04339 Hz)"
std::string frequency_text(const HopfPoint& point);
// "hard", "undecided", "other motions grow already"
std::string loss_text(const HopfPoint& point);

} // namespace flyball
