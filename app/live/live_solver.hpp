// Solving in the background while a person moves a slider: requests go in, answers come out as values, and
// whoever asks never waits.
//
// The newest request wins. One that has not begun is replaced; one that runs is cancelled, unless the one
// before it was cancelled too: a person who keeps dragging sees an answer every other solve, however long
// a solve takes.
#pragma once

#include "engine/equilibrium/analysis.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace flyball {

struct LiveRequest {
  Mechanism mechanism;
  double time = 0;      // s after the drawn drive phase, at which the answer's poses are wanted
  bool another = false; // another mechanism than before: nothing that runs is worth finishing
  bool warm = true;     // start from the last answer rather than from the drawn pose
  // See SolveOptions. With `warm`, the last answer's branch is followed, stable or not; where it does not go
  // on, an ordinary solve answers and LiveAnswer::left_branch says so.
  bool nearest = false;
  // "joint" or "joint.index" and rad or m: starts there, rather than from the last answer.
  std::vector<std::pair<std::string, double>> start{};
};

struct LiveAnswer {
  std::uint64_t ticket = 0; // of the request it answers; 0: no answer yet
  Mechanism mechanism;      // as asked
  Solution solution;
  SystemSummary summary;
  std::vector<Pose> poses;          // at the time asked for; empty where there is no solution
  double time = 0;                  // s
  std::optional<std::string> error; // why the mechanism cannot be compiled; then there is no solution
  bool left_branch = false;         // asked for the nearest, but nothing was near
};

// Where the last answer's mechanism is at another time.
struct LivePoses {
  std::uint64_t ticket = 0; // of the answer
  double time = 0;          // s
  std::vector<Pose> poses;
};

class LiveSolver {
 public:
  enum class Mode {
    background, // on a thread of its own
    immediate,  // before ask() returns: for pictures and tests, which come out the same every time
  };

  // `on_news` is called on the background thread whenever there is something to take.
  explicit LiveSolver(Mode mode, std::function<void()> on_news = {});
  ~LiveSolver();
  LiveSolver(const LiveSolver&) = delete;
  LiveSolver& operator=(const LiveSolver&) = delete;

  // Returns the request's ticket: 1, 2, ...
  std::uint64_t ask(LiveRequest request);
  void ask_poses(double time);
  // The newest, once.
  std::optional<LiveAnswer> take_answer();
  std::optional<LivePoses> take_poses();
  // Whether an answer to the newest request is still to come.
  bool busy() const;

 private:
  struct Job {
    std::uint64_t ticket = 0;
    LiveRequest request;
  };
  void work(const std::stop_token& stop);
  LiveAnswer solve(const Job& job);
  LivePoses poses_at(double time) const;
  Solution solve_nearest(const LiveRequest& request, bool& left_branch);

  // Used by whoever solves: the background thread, or the caller in immediate mode.
  std::optional<Analysis> analysis_;
  std::uint64_t analysed_ = 0; // ticket of the last answer with a solution; 0: no poses to be had
  std::vector<std::pair<std::string, double>> last_; // free coordinates of the last steady state
  std::atomic<bool> cancel_{false};

  const Mode mode_;
  const std::function<void()> on_news_;

  mutable std::mutex mutex_; // guards all below
  std::condition_variable_any wake_;
  std::uint64_t tickets_ = 0, answered_ = 0;
  bool running_ = false, spare_ = false; // spare_: what runs follows a cancelled solve
  std::optional<Job> next_;
  std::vector<std::pair<std::string, double>> running_start_; // of what runs
  std::optional<double> next_time_;
  std::optional<LiveAnswer> answer_;
  std::optional<LivePoses> poses_;

  std::jthread thread_; // last, so that it ends before what it uses
};

} // namespace flyball
