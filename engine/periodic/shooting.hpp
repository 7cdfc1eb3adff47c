// Periodic motions by shooting (Stoer and Bulirsch, Introduction to Numerical Analysis, section 7.3; Nayfeh
// and Balachandran, Applied Nonlinear Dynamics, section 6.5): states at evenly spaced times of a period such
// that the motion leads from each to the next and from the last to the first. Newton's method finds unstable
// ones as well as stable ones; with several segments also those that a motion leaves within a period.
#pragma once

#include "engine/periodic/state_chart.hpp"

#include <complex>

namespace flyball {

struct ShootingOptions {
  double period = 0;        // s; where it is found, where its search begins
  bool find_period = false; // of a motion that nothing prescribed turns
  double rate = 1;          // 1/s, the unit of rates
  double tolerance = 1e-12; // of the motion's steps
  int iterations = 25;
  AlikeAngles alike{}; // angles that need not return
};

enum class ShootingEnd {
  converged,
  pumped,    // no step closes the gap, and it is no rounding: a push in step with what nothing holds or damps
  diverged,  // the iteration does not get nearer
  no_motion, // a motion stops within the period; Flow::trouble() says why
  spent,     // the flow's evaluations are
  cancelled,
};

// Why a flow that leads nowhere does: it was cancelled, is spent, or a motion stops.
ShootingEnd end_of(const Flow& flow);

struct Orbit {
  ShootingEnd end = ShootingEnd::diverged;
  double period = 0;             // s
  std::vector<StateChart> nodes; // about the states, the first at the period's beginning
  double residual = 0;           // the largest scaled gap between the segments' ends and the next states
  int iterations = 0;
  std::vector<double> history; // residuals, at the start and after each iteration
  int neutral = 0;             // directions in which other periodic motions lie beside it
};

// From states at evenly spaced times, the first at the period's beginning; as many segments as states.
Orbit shoot(Flow& flow, const std::vector<FlowState>& guess, const ShootingOptions& options);

// How far an orbit may be off: where Newton's method takes it in one step if motions are followed with
// `coarser` times the tolerance. Nearly neutral directions make much of little gaps there, as they do of the
// errors of the orbit's own. Nothing where the flow leads nowhere.
std::optional<Orbit> orbit_beside(Flow& flow, const Orbit& orbit, const ShootingOptions& options,
                                  double coarser);

// What a period makes of what is beside the orbit.
struct Monodromy {
  Eigen::MatrixXd matrix;                        // in the coordinates of the first node
  std::vector<std::complex<double>> multipliers; // the largest first
  double error = 0;                              // estimated, absolute, of the largest
};
// By central differences of the motion, extrapolated twice. Nothing where the flow is spent, or cancelled.
std::optional<Monodromy> monodromy(Flow& flow, const Orbit& orbit, const ShootingOptions& options);

} // namespace flyball
