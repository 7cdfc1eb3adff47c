// The damped motion computed in the background while it plays: requests go in, the run comes out as a value
// that grows, and whoever asks or closes it never waits.
#pragma once

#include "app/live/live_solver.hpp"
#include "engine/dynamics/simulation.hpp"

namespace flyball {

struct MotionNews {
  std::uint64_t ticket = 0;         // of the request it answers
  std::shared_ptr<const Run> run;   // all so far; null where no motion could begin
  bool finished = false;            // nothing more will come
  std::optional<std::string> error; // why no motion could begin, or go on
};

class LiveMotion {
 public:
  // As of a LiveSolver.
  explicit LiveMotion(LiveSolver::Mode mode, std::function<void()> on_news = {});
  ~LiveMotion();
  LiveMotion(const LiveMotion&) = delete;
  LiveMotion& operator=(const LiveMotion&) = delete;

  // A new run of options.duration; what is under way is dropped. Returns the request's ticket: 1, 2, ...
  // `options.cancel` and `options.progress` are not used.
  std::uint64_t start(std::shared_ptr<const Mechanism> mechanism, SimulationOptions options);
  // Goes on from a moment (s) of `run` with other numbers, up to where it would have ended; a new run where
  // there is nothing to go on from.
  std::uint64_t go_on(std::shared_ptr<const Mechanism> mechanism, SimulationOptions options,
                      std::shared_ptr<const Run> run, double time);
  // Keeps what was computed: that is the last news.
  void stop();
  // The newest, once.
  std::optional<MotionNews> take();
  bool running() const;

 private:
  struct State;
  std::shared_ptr<State> state_; // shared with the thread, which may come to its end later
  Worker thread_;
};

} // namespace flyball
