// Solving in the background while a person moves a slider: requests go in, answers come out as values, and
// whoever asks never waits, nor does whoever closes it.
//
// The newest request wins; one that runs is cancelled, unless the one before it was cancelled, too: a person
// who keeps dragging sees an answer every other solve, however long a solve takes.
#pragma once

#include "app/live/background.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/grip.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct LiveRequest {
  std::shared_ptr<const Mechanism> mechanism; // not null
  double time = 0;      // s after the drawn drive phase, at which the answer's poses are wanted
  bool another = false; // another mechanism than before: nothing that runs is worth finishing
  bool warm = true;     // start from the last answer rather than from the drawn pose
  // See SolveOptions. With `warm`, the last answer's branch is followed, stable or not; where it does not go
  // on, an ordinary solve answers and LiveAnswer::left_branch says so.
  bool nearest = false;
  // "joint" or "joint.index" and rad or m: starts there, rather than from the last answer.
  std::vector<std::pair<std::string, double>> start{};
  std::vector<BodyPoint> points{}; // of its bodies, to be told with the solution
  std::optional<BodyPoint> grip{}; // that a hand would take hold of, see LiveAnswer::grip
};

struct LiveAnswer {
  std::uint64_t ticket = 0;                   // of the request it answers; 0: no answer yet
  std::shared_ptr<const Mechanism> mechanism; // as asked: the very one; null where ticket is 0
  Solution solution;
  SystemSummary summary;
  std::vector<Pose> poses;            // at the time asked for; empty where there is no solution
  std::vector<AngularMotion> turning; // of the bodies, at the drawn drive phase; empty likewise
  double time = 0;                    // s
  std::optional<SceneError> error;    // why the mechanism cannot be compiled; then there is no solution
  bool left_branch = false;           // asked for the nearest, but nothing was near
  std::optional<Grip> grip;           // where it was asked for and there is a steady state
};

// Where the last answer's mechanism is at another time.
struct LivePoses {
  std::uint64_t ticket = 0; // of the answer
  double time = 0;          // s
  std::vector<Pose> poses;
};

class LiveSolver {
 public:
  using Mode = BackgroundWorker::Mode;

  // As of a BackgroundWorker.
  explicit LiveSolver(Mode mode, const std::function<void()>& on_news = {});

  // Returns the request's ticket: 1, 2, ...
  std::uint64_t ask(LiveRequest request);
  void ask_poses(double time);
  // The newest, once.
  std::optional<LiveAnswer> take_answer();
  std::optional<LivePoses> take_poses();
  // Whether an answer to the newest request is still to come.
  bool busy() const { return answers_.running(); }

 private:
  // What requests want that may never be answered themselves, so that the next one has it done: each with the
  // ticket of the last that wanted it.
  struct Wishes {
    std::uint64_t another = 0, cold = 0, started = 0; // cold: not warm
    std::vector<std::pair<std::string, double>> start{};
  };
  class Solver;

  std::uint64_t tickets_ = 0;
  Wishes wishes_;
  std::shared_ptr<Solver> solver_; // shared with the threads
  Background<LiveAnswer> answers_;
  Background<LivePoses> poses_;
};

} // namespace flyball
