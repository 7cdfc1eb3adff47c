// A mechanism opened for solving again and again while its numbers move: the convenient front of
// the solvers for the command line and the window.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"
#include "engine/stability/mode_motion.hpp"
#include "engine/task/progress.hpp"

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flyball {

struct SolveOptions {
  bool nearest = false; // the plain Newton-Raphson answer, stable or not
  bool warm = false;    // start from this analysis' last converged answer instead of the drawn pose
  bool details = true;  // eigenvalues, reactions and drive torques; not needed by a sweep
  // Eigenvalues asked for where there are more than 200 coordinates: those nearest to zero.
  int modes = 0;
  std::vector<BodyPoint> points{};                   // to be reported with the solution
  std::vector<std::pair<std::string, double>> start; // "joint" or "joint.index" = value, over the drawn pose
  const std::atomic<bool>* cancel = nullptr;         // looked at all the time; then not_converged
  ReportProgress progress{};
  // Where no steady state is found from the start: how long others are looked for before refusing, in seconds
  // of one core, counted in operations (see SearchOptions). Zero: not at all.
  double search = 0.2;
  bool newton_only = false; // from the start by Newton-Raphson, with nothing that catches it
  // Where there is no steady state without dry friction, and not for `nearest`: whether one that rests on it
  // is looked for (friction_state.hpp). Of solve_all: whether those are listed.
  bool friction = true;
  bool explain = true; // why there is no steady state, which takes time: else the message is empty
  // Of solve_all, see SearchOptions.
  double search_time = 1;
  int search_starts = 0;
};

// What was compiled and what was left out, for `flyball check`.
struct SystemSummary {
  std::vector<std::string> in, left_out; // passes, in words
  int bodies = 0, free_coordinates = 0, driven_coordinates = 0, constraint_equations = 0;
  std::vector<CoordinateSolution> coordinates; // names and kinds; values of the drawn pose
  std::vector<std::string> tree_joints, cut_joints, implicit_joints;
  std::vector<std::string> notes; // choices worth telling: "the bearing was cut so that ..."
};

// All equilibria of a bounded search, lowest potential first where there is one, else as found; then steady
// states that rest on dry friction: what slips, and where there is no other, what it holds as drawn.
struct AllSolutions {
  std::vector<Solution> equilibria;
  struct Bound {
    std::string joint;
    int index = 0, count = 1;
    bool angle = false;
    double lower = 0, upper = 0; // rad or m
    bool speed = false;          // of a drive by torque: rad/s or m/s
  };
  std::vector<Bound> bounds; // free coordinates
  int starts = 0;            // Newton-Raphson runs
  int passing = 0;           // equilibria of the drawn phase that do not hold as the drives turn: not listed
  double unseen = 0;         // expected to be missing (SearchReport::unseen)
  SearchEnd end = SearchEnd::settled;
  std::string message; // a sentence
  int lost = 0;        // states in which what acts is lost in rounding (is_pushed_where_soft()): not listed
};

// Of a body, in the world frame: rad/s, rad/s^2.
struct AngularMotion {
  Vec3 velocity = Vec3::Zero(), acceleration = Vec3::Zero();
};

class Analysis {
 public:
  // Compiles. Throws SceneError (validate first for all mistakes at once). A mechanism given by pointer (not
  // null) is shared, any other is copied; here and in update().
  explicit Analysis(const Mechanism& mechanism);
  explicit Analysis(std::shared_ptr<const Mechanism> mechanism);
  ~Analysis();
  Analysis(Analysis&&) noexcept;
  Analysis& operator=(Analysis&&) noexcept;

  // Takes new numbers. Cheap where only numbers changed; recompiles where parts or topology did, and solving
  // does where numbers set turning what stood. Keeps the last answer as a warm start where it still fits.
  void update(const Mechanism& mechanism);
  void update(std::shared_ptr<const Mechanism> mechanism);

  // Numbers that are going to be set again and again, until another mechanism is taken. Throws SceneError as
  // VariedNumbers does.
  void vary(std::span<const std::string> addresses);
  // Takes new values of them, as update() takes a mechanism with these, at a fraction of the cost. Throws
  // SceneError for values of which no mechanism can be made; then others have to be set before it is solved.
  void set(std::span<const double> values);

  // Throws SceneError for starts and points that name nothing.
  Solution solve(const SolveOptions& options = {});

  // `options`: details, modes, points, cancel, search_time, search_starts and progress count.
  AllSolutions solve_all(const SolveOptions& options = {});

  SystemSummary summary() const;

  // Poses of all bodies at time t (s) after the drawn drive phase: drives turn, the other coordinates stand
  // at their last answer (at the drawn pose before there is one).
  std::vector<Pose> poses_at(double t);
  // How they turn then.
  std::vector<AngularMotion> turning_at(double t);

  // Modes of the linearised motion about the last answer (modes.hpp); of more than 200 coordinates the
  // `count` whose eigenvalues are nearest to zero. Empty where the last solve has none, or numbers have
  // changed since. Of another equilibrium: solve with its coordinates as start and `nearest`.
  std::vector<VibrationMode> modes(int count = 20);

  // Poses of all bodies in a mode of the last answer at `phase` (rad): the coordinates moved along Re(v e^(i
  // phase)), the loops closed, the drives `t` seconds on. `amplitude` is that of the largest entry, in rad or
  // parts of the mechanism's reach. For a mode that grows or decays multiply the amplitude by e^(Re s t).
  std::vector<Pose> mode_poses(const VibrationMode& mode, double amplitude, double phase, double t);

  // How the bodies move in a mode of the last answer, in the mechanism's order.
  std::vector<BodyAmplitude> body_amplitudes(const VibrationMode& mode);
  // Its whirl about the axis of the drive of a joint; an empty name is the first that turns. Nothing as
  // find_whirl() says, and where there is no such drive.
  std::optional<Whirl> whirl(const VibrationMode& mode, std::string_view joint = {});

  // What the potential and the eigenvalues say about the last answer; nothing where modes() is empty for want
  // of one.
  std::optional<StabilityEvidence> stability_evidence();

 private:
  // The same, to the end or an interruption.
  Solution solve_through(const SolveOptions& options);
  AllSolutions solve_all_through(const SolveOptions& options);
  // Compiles anew where numbers that have changed since make something else turn; returns whether.
  bool turn_otherwise();

  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
