// What the paper claims, measured: the error of the direct solution against its run time, one Newton
// iteration after the other, beside the error of the damped motion against its run time, for every integrator
// over its tolerances and over simulated durations.
//
// Everything runs in this process on one thread, from the same drawn pose; times are medians over repeats and
// leave out what both do once: reading and compiling the scene.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

struct CompareOptions {
  std::vector<double> tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
  std::vector<double> durations; // s; empty: by the slowest motion, until it has shrunk to 1e-2 ... 1e-10
  std::vector<Integrator> integrators{Integrator::bdf, Integrator::adams, Integrator::runge_kutta};
  int repeats = 5;
  long max_steps = 2'000'000; // of one run; longer ones are given up
  // s by the clock on the wall, for all of it. A run is given up after a tenth of that, and tighter
  // tolerances with it; one that takes over a hundredth is not repeated.
  double time_limit = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(std::size_t done, std::size_t all)> progress{};
};

// Errors are the largest of all coordinates, in radians or relative to the mechanism's reach. Those of
// measures are of each in its unit, as of a steady state with these coordinates; not a number where one has
// no value.
struct DirectMark {
  int iterations = 0;
  double error = 0, run_time_s = 0;
  std::vector<double> measure_errors{};
};

struct MotionMark {
  double tolerance = 0;
  double error = 0; // NaN where the run did not come to its end
  double run_time_s = 0;
  long steps = 0, evaluations = 0;
  RunStatus status = RunStatus::completed;
  std::vector<double> measure_errors{}; // none where the run did not come to its end
  // The largest rate at the end by that of the slowest motion about the steady state: about how far it goes
  // on from there, as errors are. 0 where no eigenvalues are known.
  double goes_on = 0;
};

struct MotionCurve {
  Integrator method = Integrator::bdf;
  double duration = 0;            // s, simulated
  std::vector<MotionMark> points; // fewer than tolerances where it was given up
};

// The motion that comes nearest, against the direct solution that comes as near.
struct SpeedRatio {
  Integrator method = Integrator::bdf;
  double duration = 0, tolerance = 0, error = 0;
  double motion_s = 0, direct_s = 0;
  double ratio() const { return motion_s / direct_s; }
};

struct Comparison {
  Status status = Status::not_converged; // of the direct solution
  bool complete = true;                  // neither cancelled nor out of time, when the message says so
  std::string message;                   // a sentence
  // The reference q*, iterated in extended precision until it stood: values rounded to double, `error` how
  // far the last correction moved it.
  std::vector<CoordinateSolution> reference;
  std::vector<MeasureSolution> measures; // there, rounded; without errors
  double reference_error = 0;            // the largest of these, scaled
  double reference_residual = 0;         // of q* in extended precision, scaled
  std::vector<DirectMark> direct; // by iteration; none where a fallback was needed, or it stands turned
  DirectMark answer;              // with refinement, existence and the sign of stability
  std::vector<MotionCurve> motion;
  std::optional<SpeedRatio> best; // where a motion comes to stand within 0.01 of it; else the message says so
};

// Throws SceneError for a mechanism that cannot be compiled or has no equations of motion.
Comparison compare(const Mechanism& mechanism, const CompareOptions& options = {});

} // namespace flyball
