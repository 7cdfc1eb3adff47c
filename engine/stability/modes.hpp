// Shapes of the linearised motion about a steady state, and what its eigenvalues say in an engineer's words.
#pragma once

#include <Eigen/Core>

#include <complex>
#include <limits>
#include <string>
#include <vector>

namespace flyball {

class FactoredState;
struct Problem;
struct Unknowns;
struct Workspace;

// |s|, rad/s: of an undamped motion its frequency, of a damped one that of the mass and spring behind it.
double natural_frequency(std::complex<double> eigenvalue);
// |Im s|, rad/s: of the motion as it is seen.
double damped_frequency(std::complex<double> eigenvalue);
// -Re s / |s|: 0 undamped, 1 no oscillation, negative where it grows; 0 for s = 0.
double damping_ratio(std::complex<double> eigenvalue);
// rad/s to Hz.
double hertz(double angular_frequency);

// One coordinate's part in a mode: it moves as Re(value e^(s t)) about its steady value.
struct ModeAmplitude {
  std::string joint;
  int index = 0, count = 1; // which of the joint's coordinates
  bool angle = false;       // rad rather than m
  std::complex<double> value;
};

// (The window calls building and exploring its modes.)
struct VibrationMode {
  std::complex<double> eigenvalue; // 1/s, imaginary part zero or positive
  double frequency = 0;            // rad/s, damped
  double natural_frequency = 0;    // rad/s
  double damping_ratio = 0;
  // Largest entry 1, measured in radians and in the mechanism's reach; complex where coordinates move out of
  // phase (dampers, gyroscopic forces).
  std::vector<ModeAmplitude> amplitudes;   // of the free coordinates, in the scene's order; rad, m
  std::vector<std::complex<double>> shape; // the same as a step of q_R; rad, m
  double reach = 1;                        // m, the mechanism's, by which slides are measured
  double residual = 0;                     // of (s^2 M + s D + K) v, relative to its terms
  bool oscillates() const { return eigenvalue.imag() > 0; }
  // An amplitude in radians or reaches; the coordinate that moves most, the first of those that move alike,
  // none without a shape.
  std::complex<double> measured(std::size_t i) const {
    return amplitudes[i].angle ? amplitudes[i].value : amplitudes[i].value / reach;
  }
  const ModeAmplitude* leading() const;
};

// The mode of the eigenvalue s (1/s) and the shape `scaled`, a scaled step of q_R about the configuration q.
VibrationMode describe_mode(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXcd& scaled,
                            std::complex<double> s, double residual);

// Leaves those nearest to zero, `most` of them, in their order.
void keep_nearest(std::vector<std::complex<double>>& eigenvalues, std::size_t most);

// By frequency, and of one frequency the fastest growing first.
void sort_modes(std::vector<VibrationMode>& modes);

// Of one steady state of a dense problem: one mode a conjugate pair and one a real eigenvalue, by frequency.
// A repeated eigenvalue counts as often as it has shapes of its own. Infinite eigenvalues (massless
// coordinates) have no mode; massless coordinates follow the others. Of more than `most` those nearest to
// zero.
std::vector<VibrationMode> find_modes(const FactoredState& at,
                                      std::size_t most = std::numeric_limits<std::size_t>::max());

// q moved by amplitude Re(v e^(i phase)) along a mode, its loops closed at `t` seconds of driving. A large
// amplitude that the loops do not allow is halved until they do. `amplitude` is that of the largest entry,
// in radians or parts of the mechanism's reach.
Eigen::VectorXd along_mode(const Problem& problem, const Eigen::VectorXd& q, const VibrationMode& mode,
                           double amplitude, double phase, double t, Workspace& w);

// What the two criteria say about one steady state, side by side.
struct StabilityEvidence {
  bool potential = false;        // the amended potential exists, so that its Hessian may be asked
  int downhill = 0;              // directions on the constraints in which it falls
  int null = 0;                  // in which it stays the same to second order
  int growing = 0, standing = 0; // eigenvalues right of and on the imaginary axis
  bool agree = true;             // both say stable, or both unstable, or there is one only
  std::string reason;            // a sentence: why they agree or not
};
StabilityEvidence stability_evidence(const FactoredState& at); // of a dense problem

} // namespace flyball
