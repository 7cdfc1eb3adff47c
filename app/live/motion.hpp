// The damped motion computed while it plays: the run comes out as a value that grows.
#pragma once

#include "app/live/background.hpp"
#include "engine/dynamics/simulation.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

struct MotionRequest {
  std::shared_ptr<const Mechanism> mechanism; // not null
  SimulationOptions options;                  // `cancel` and `progress` are not used
  // To go on from its moment `time` (s), up to where it would have ended; null: a new run.
  std::shared_ptr<const Run> before;
  double time = 0;
  // A run ends where its samples take more memory (bytes): some copies of it are held while it grows. Of
  // large mechanisms a few thousand samples are kept whatever they take.
  std::size_t most_memory = 256'000'000;
};

struct Motion {
  std::shared_ptr<const Run> run; // all so far; null where no motion could begin
  bool finished = false;          // nothing more will come
  std::string problem;            // why no motion could begin, or go on
  // Of a damped run that is finished: the steady state that is found from its end, as far as that is about
  // to come to rest; null else.
  std::shared_ptr<const Solution> rests_in;
};

// Memory of a run's samples (bytes).
std::size_t memory_of(const Run& run);

// The steady state that solving finds from a damped run's end, where that is about to come to rest; null
// else.
std::shared_ptr<const Solution> resting_state(const Run& run,
                                              const std::shared_ptr<const Mechanism>& mechanism,
                                              const std::atomic<bool>* cancel);

// Publishes what there is from time to time. Cancelled, it returns what was computed.
Motion compute_motion(const MotionRequest& request, const TaskContext<Motion>& context);

} // namespace flyball
