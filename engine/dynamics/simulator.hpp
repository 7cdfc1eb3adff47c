// The damped motion, computed in as many slices as one likes: for the window, which goes on in the background
// while playing, and for simulate(), which does all at once.
#pragma once

#include "engine/dynamics/simulation.hpp"

namespace flyball {

class Simulator {
 public:
  // Compiles and finds the start. Throws SceneError, naming the part, for a mechanism that has no equations
  // of motion or a start that cannot be taken. Cancelled, or out of time, before there is a start it keeps a
  // run without samples that says so, which cannot be gone on with.
  Simulator(const Mechanism& mechanism, const SimulationOptions& options);
  // Of a model compiled before, with dampers as `options.damped` says: for many motions of one mechanism.
  Simulator(const MotionModel& model, const SimulationOptions& options);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  // Goes on to the last sample at or before `until` (s) on the grid of samples; slices give the same samples
  // as one call. Also to `until` itself, off the grid, where `sample_end` says so. False once it has
  // diverged, been cancelled or run out of time; a cancelled run may be gone on with. A step that was
  // cancelled within is begun anew then, with the errors of another first step.
  bool advance(double until, bool sample_end = false);

  // All so far.
  const Run& run() const;
  double time() const; // s, of the last sample; zero without
  // Throws SceneError where there is no sample.
  SimulationState state() const;

  // Goes on from the last sample with new numbers or dampers on or off; coordinates and their rates stay, and
  // the drives where they are. Throws SceneError where parts changed: then a new simulation is due.
  void change(const Mechanism& mechanism, bool damped);

 private:
  struct State;
  template <class Compile>
  void open(const SimulationOptions& options, const Compile& compile);

  std::unique_ptr<State> state_;
};

// The whole run of options.duration.
Run simulate(const Mechanism& mechanism, const SimulationOptions& options);

} // namespace flyball
