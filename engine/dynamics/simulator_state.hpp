// What a running motion is made of, and its parts: how it begins, dry friction, events, steps.
#pragma once

#include "engine/dynamics/friction_modes.hpp"
#include "engine/dynamics/motion_ode.hpp"
#include "engine/dynamics/pace.hpp"
#include "engine/dynamics/recorder.hpp"
#include "engine/dynamics/runaway.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/dynamics/watch.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Simulator::State {
  State(const SimulationOptions& wanted)
      : options(wanted), damped(wanted.damped), watch(wanted.cancel), pace(wanted.max_steps) {}

  // What turns back comes to a stop, or has passed a dead point on the way.
  enum class Turned { stopped, passed };
  // The way over a singular position, for samples that fall on it.
  struct Bridge {
    double time;
    Eigen::VectorXd y, rate, end, end_rate;
  };

  // simulator_begin.cpp
  void open(MotionModel compiled, const SimulationOptions& how);
  // A model with all of its friction slipping nowhere, which gives nothing.
  void take(std::shared_ptr<MotionModel> made);
  // From q and a velocity u that keep the loops closed.
  void begin_motion(double t, const Eigen::VectorXd& u, const Eigen::Vector3d& energies);
  void use_method(Integrator chosen);
  void start_stepper(double t);
  // Stops by where q stands and goes; then independent rows and idle coordinates. Leaves s.
  void restructure(double t, const Eigen::VectorXd& u);

  // simulator_friction.cpp
  // Which joints with friction stick and which way others slip, from q and u on: those that stand still
  // stick, unless that takes more than their limits. The one that it takes most of gives way, with what loops
  // tie to it, again and again. Leaves model, equations and s.
  void settle_frictions(double t, Eigen::VectorXd u, Turned turned_back = Turned::stopped);
  // The first of those that begin to slip, at rest still, whose acceleration is against the way they do.
  std::optional<std::size_t> goes_against_slip(const std::vector<bool>& begins) const;
  // Which way coordinates go on from dead points, where their friction does nothing: as they bend away from
  // there, with the rates of the evaluated state or, where these do not move them, with what they become by
  // its accelerations. True where one is found.
  bool leave_dead_points(double t);
  bool has_left_dead_point(const Eigen::VectorXd& state) const;
  bool some_slip_has_turned(const Eigen::VectorXd& u) const;
  // From the evaluated state on.
  void change_frictions(double t, const Eigen::VectorXd& u, Turned turned_back = Turned::stopped);
  int v_of(const FrictionElement& friction) const;
  // N m or N, of friction on the coordinate that is held, at the evaluated state.
  double force_of(const FrictionHold& hold) const;

  // simulator_events.cpp
  void handle_event(const StepOutcome& outcome);
  void set_stop(std::size_t i, bool touches, double t);
  // A stop that the step went past and no event reported, as where it is grazed.
  bool find_missed_stops(double t);
  // Where a slip turns back as the loops come to a singular position it has not stopped: the step is taken
  // back, and the way there halved until it can be leapt over.
  bool comes_to_singular_position(const StepOutcome& outcome);
  // The last step, which is to end halfway at most.
  bool take_back(double end);
  // After a step: whether all is well.
  bool check_step(double t);
  // What the last step calls for. Put off until the samples within it are taken, for afterwards the
  // integrator may start anew.
  bool finish_step();

  // simulator_steps.cpp
  bool step_to(double t);
  // A motion may become stiff on its way. Thought over after ever more steps; to BDF where that suits it now.
  void review_method();
  // Why a step failed, from where it was well last.
  std::string reason_of(const StepOutcome& failure);
  // The state at t within the last step, on the manifold and evaluated. False where it cannot be.
  bool settle(double t, double* shift);
  bool record(double t);
  // Where nobody wants it any more, or its time is over, that is why it stops, whatever failed for it.
  bool interrupt();
  bool diverge(double t, const std::string& why);
  // What has run away, as a clause; empty as a rule.
  std::string runaway() const;

  double grid(long sample) const { return begin + static_cast<double>(sample) / options.rate; }

  SimulationOptions options;
  bool damped = true;
  Watch watch;
  Pace pace;
  std::shared_ptr<const MotionModel> model;
  std::unique_ptr<Equations> equations;
  std::unique_ptr<MotionOde> ode;
  std::unique_ptr<Stepper> stepper;
  std::vector<StopElement> stops;
  std::vector<bool> touching; // by stop
  std::vector<FlipElement> flips;
  BearingTurns bearing_turns;
  std::shared_ptr<const MotionModel> free; // without what friction adds; null where there is none
  std::vector<FrictionElement> frictions;
  std::vector<int> slips;             // by friction, see with_modes()
  std::vector<std::size_t> undecided; // frictions at dead points that nothing moves
  std::vector<FrictionHold> holds;
  double rate_scale = 1, energy_scale = 1;
  double fastest = 0; // 1/s, of the linearised motion where the method was chosen; 0: not known
  Integrator method = Integrator::automatic;

  Run run;
  std::unique_ptr<Recorder> recorder;
  double begin = 0, stepped_to = 0;   // s; where the integrator stands
  long next_sample = 0;               // on the grid, from `begin`
  std::optional<StepOutcome> pending; // the last step's, to be looked at
  double best_independence = 0, started_at = 0;
  bool torn = false; // the last step was given up within
  std::optional<Bridge> bridge;
  Eigen::VectorXd y, q, s;
  long review_at = 0;    // steps
  Eigen::VectorXd whole; // where the last step began
  double began = 0;      // s, when
  // The next step goes no further (s); how often it was cut short since a singular position was passed.
  double before_singular = -std::numeric_limits<double>::infinity();
  int halvings = 0;
};

} // namespace flyball
