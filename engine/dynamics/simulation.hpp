// What a simulation of the damped motion (eq. 19) is asked, and what it found, in plain values.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/mechanism/pose.hpp"

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flyball {

struct MotionModel;

enum class Integrator {
  automatic,   // by the linearised motion at the start
  bdf,         // CVODE's backward differentiation formulas, for stiff scenes
  adams,       // CVODE's Adams-Moulton formulas
  runge_kutta, // ARKODE's explicit Runge-Kutta method of order 8
};

enum class Start {
  rest,        // the drawn pose, carried along by the drives: q_R' = 0, as in the paper
  drawn,       // the drawn pose standing still in the world, when the drives set off with a jerk
  equilibrium, // the steady state; a kick sets it going
  state,       // a saved state
};

std::string_view word(Integrator integrator); // "bdf"
std::string_view word(Start start);

// A coordinate of a saved state; driven ones say where the drives stand.
struct StateCoordinate {
  std::string joint;
  int index = 0;
  double value = 0; // rad or m, as the joint labels it
  double rate = 0;  // its rate of change
  bool operator==(const StateCoordinate&) const = default;
};

struct SimulationState {
  double time = 0; // s
  std::vector<StateCoordinate> coordinates;
  bool operator==(const SimulationState&) const = default;
};

struct SimulationOptions {
  double duration = 10;     // s
  double rate = 100;        // samples a second; 0: the start and the end alone
  double tolerance = 1e-10; // of the error of a step, relative to a radian, the mechanism's reach and speeds
  Integrator method = Integrator::automatic;
  double fixed_step = 0; // s; Runge-Kutta only: steps of this size instead of a tolerance
  bool damped = true;    // false: all dampers off; drag stays, it is a force like others
  Start start = Start::rest;
  std::vector<std::pair<std::string, double>> at;   // joint = value (rad, m) over the drawn pose
  std::vector<std::pair<std::string, double>> kick; // joint = rate (rad/s, m/s) over the start's
  SimulationState state;                            // for Start::state
  bool reactions = false; // record what all joints transmit, and what bearings, gears and springs exert
  bool measures = true;   // record the scene's measures
  std::vector<BodyPoint> points{}; // record how these move
  long max_steps = 50'000'000;
  double time_limit =
      std::numeric_limits<double>::infinity(); // s by the clock on the wall, for all of the run
  const std::atomic<bool>* cancel = nullptr;   // polled at every evaluation, inside steps too
  std::function<void(double time)> progress{}; // called at every sample
};

// One coordinate over time, by sample. Angles go on beyond a turn; rotation vectors have length at most pi.
struct CoordinateTrack {
  std::string joint;
  int index = 0, count = 1; // which of the joint's coordinates
  bool angle = false;       // rad rather than m
  bool driven = false;
  bool rotation = false;           // a component of a rotation vector
  bool dependent = false;          // of a joint that closes a loop: follows from the others
  bool turns = false;              // whole turns do not matter
  double scale = 1;                // as of a CoordinateSolution: 1 rad, or m, the mechanism's reach
  std::vector<double> value, rate; // rad or m; a second
};

struct DriveTrack {
  std::string joint;
  int index = 0, count = 1;
  bool angle = true;          // N m rather than N
  std::vector<double> torque; // by the motor, positive along its coordinate, gears' loads included
  // Of a drive by torque, what acts against what it gives; `torque` is the difference. Else empty.
  std::vector<double> load;
};

// What the parent exerts on the child through a joint, as in Reaction: world axes of the moment.
struct ReactionTrack {
  std::string joint;
  std::vector<Vec3> force, torque; // N, N m
};

// What a bearing exerts on its second body, as in BearingForce.
struct BearingTrack {
  std::string bearing;
  std::vector<Vec3> force, torque; // N, N m
};

// What a gear does along the coordinates of its two joints, as in GearReaction; not numbers where it is
// without load because others lead there.
struct GearTrack {
  std::string joint;
  bool angle_a = true, angle_b = true; // N m rather than N
  std::vector<double> a, b;
};

// What the spring, damper and stop of a joint's coordinate exert on the joint's child, positive along the
// coordinate (of joints in the tree but ball joints, and dampers of those that close loops); or spring and
// damper between two points, where tension is positive. Zeros of what there is not.
struct SpringTrack {
  std::string joint;        // or the spring between two points
  int index = 0, count = 1; // which of the joint's coordinates
  bool between_points = false;
  bool angle = false;                       // N m rather than N
  std::vector<double> spring, damper, stop; // N or N m
};

// How a point moves, in the world frame.
struct PointTrack {
  BodyPoint point;
  std::vector<Vec3> position, velocity; // m, m/s
  // m/s^2; empty where bodies without mass are, whose velocities are no states and have no known rates.
  std::vector<Vec3> acceleration;
};

// One of the scene's measures over time.
struct MeasureTrack {
  std::string name, unit;
  std::vector<double> value; // in SI units; not a number where it is undefined or not known
};

// J, by sample.
struct EnergyTracks {
  std::vector<double> kinetic, potential;
  std::vector<double> jacobi; // T_2 + V - T_0; empty where it is not defined
  // Since the start: taken by dampers and drag, given by the drives, and by torques and forces fixed in
  // bodies. Integrated along with the motion.
  std::vector<double> dissipated, delivered, applied;
  // Stored + dissipated - delivered - applied, less its value at the start: zero but for the integrator's
  // errors.
  std::vector<double> balance;
};

// A coordinate came to a stop or left it.
struct StopEvent {
  double time = 0; // s
  std::string joint;
  int index = 0;
  bool upper = false;
  bool touching = false;
};

// A joint with dry friction came to stand still, or began to slip.
struct FrictionEvent {
  double time = 0; // s
  std::string joint;
  int index = 0;
  int slips = 0; // 1: the coordinate begins to grow, -1: to fall, 0: it sticks
};

struct RunStatistics {
  long steps = 0, evaluations = 0, jacobians = 0, rejected = 0, restarts = 0;
  long singular_positions = 0; // passed, where a linkage could part into branches
  double run_time_s = 0;
  // Worst of all samples: how far the loops are open (m, rad or 1), and how fast they open (a second).
  double position_drift = 0, velocity_drift = 0;
  // How far a sample was shifted to close its loops, at most: relative to radians and the mechanism's reach.
  double correction = 0;
};

enum class RunStatus {
  completed, // all that was asked for
  cancelled,
  time_limit, // SimulationOptions::time_limit came before the end
  diverged,   // the message says when and why
};

std::string_view word(RunStatus status);

struct Run {
  RunStatus status = RunStatus::completed;
  std::string message; // always a sentence
  bool damped = true;
  Integrator method = Integrator::automatic; // the one used
  std::string method_reason;                 // a sentence
  std::vector<std::string> notes;            // choices worth telling
  std::vector<double> time;                  // s, by sample; what follows has as many entries
  std::vector<CoordinateTrack> coordinates;  // in the scene's order, driven ones included
  std::vector<DriveTrack> drives;
  std::vector<ReactionTrack> reactions; // where asked for, as the next three
  std::vector<BearingTrack> bearings;
  std::vector<GearTrack> gears;
  std::vector<SpringTrack> springs;
  std::vector<PointTrack> points; // those asked for
  std::vector<MeasureTrack> measures;
  EnergyTracks energy;
  std::vector<StopEvent> stops;
  std::vector<FrictionEvent> frictions; // those that already stick or slip at the start are not among them
  RunStatistics statistics;

  // What was compiled, from each of these samples on, and the configuration and velocity of every sample:
  // for poses_at().
  struct Segment {
    std::size_t first = 0;
    std::shared_ptr<const MotionModel> model;
  };
  std::vector<Segment> segments;
  std::vector<double> states;
};

// Poses of all bodies at a time (s) within the run, between samples by the cubic that fits their velocities;
// drives turn exactly. Empty for an empty run.
std::vector<Pose> poses_at(const Run& run, double time);

// The state at a sample, to start from again.
SimulationState state_at(const Run& run, std::size_t sample);

} // namespace flyball
