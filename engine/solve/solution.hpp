// What a solve found, by names and in plain numbers: for the command line, the panels and tests. Nothing in
// it refers back to the compiled system.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/mechanism/pose.hpp"
#include "engine/solve/open_directions.hpp"

#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flyball {

enum class Status {
  converged,       // a steady state, or with `stable == false` an unstable one
  not_converged,   // no answer, though one may exist; `message` says what was tried
  no_steady_state, // the balance turns with the drives: no constant coordinates can hold it
  infeasible,      // the loops cannot be closed
};

// What found the answer where plain Newton-Raphson did not.
enum class Fallback {
  stops, // from what hangs loose between its stops pressed onto those that the forces push it to
  damped,
  homotopy,
  descent,
  slow_motion, // of what torques drive, from the start
  search,      // the others led to no steady state: one of those that a search all over the ranges found
};

enum class StabilityReason {
  minimum,         // strict minimum of the amended potential on the constraints
  asymptotic,      // all eigenvalues to the left
  gyroscopic_only, // not a minimum, but the eigenvalues lie on the imaginary axis: any damping destabilises
                   // it
  neutral,         // stable but for directions that nothing resists
  marginal,        // eigenvalues too close to the axis to tell, or a singular state (a fold or branch point)
  unstable,
  floquet, // the linearised motion turns with the drives: by its multipliers, whichever way they decide
  varying, // it turns with the drives, and no multipliers tell of it: the drives have no common period
};

// Where the linearised motion turns with the drives: what a period makes of it.
struct Floquet {
  double period = 0;                             // s, common to the drives
  std::vector<std::complex<double>> multipliers; // of the monodromy matrix, the largest first
  std::vector<double> growth; // 1/s, ln|multiplier| / period; without those of rounding size
  double error = 0;           // estimated, absolute, of the largest multiplier
};

// Why a search for all equilibria stopped (all_equilibria.hpp).
enum class SearchEnd {
  settled, // no more than SearchOptions::unseen are expected to be missing
  starts,  // as many starts as asked for
  budget,  // the budget is spent
  time,    // it took many times longer than its budget says; another run may end elsewhere
  cancelled,
};

std::string_view word(Status status);
std::string_view word(Fallback fallback);
std::string_view word(StabilityReason reason);
std::string_view word(SearchEnd end);

struct CoordinateSolution {
  std::string joint;
  int index = 0, count = 1; // which of the joint's coordinates
  bool angle = false;       // rad rather than m
  bool driven = false;      // then `value` is at the drawn drive phase and `error` is zero
  double value = 0;         // rad or m
  double error = 0;         // estimated absolute error, rad or m
  // rad/s or m/s: of a drive by torque, as found, and of a joint that closes a loop and goes on at a constant
  // rate.
  std::optional<double> speed{};
  double speed_error = 0; // estimated, absolute
  bool dependent = false; // of a joint that closes a loop: follows from the others, and starts nothing
  // What differences are measured by (solution_difference.hpp): 1 rad, or m, the mechanism's reach; and of a
  // speed that is found rad/s or m/s, that where the search for it begins.
  double scale = 1, speed_scale = 1;
};

// Whether a steady state finds something of a coordinate, which no drive prescribes: where it stands, or how
// fast it goes on.
inline bool is_found(const CoordinateSolution& coordinate) {
  return coordinate.speed || !coordinate.driven;
}

struct FoundNumber {
  std::string name; // "slide", "spin.speed"; with the index where the joint has several
  double value = 0, error = 0;
  std::string_view unit; // "rad", "m", "rad/s", "m/s"
};
// Nothing where it finds none.
std::optional<FoundNumber> found_number(const CoordinateSolution& coordinate);

struct JointMultipliers {
  std::string joint;          // a cut joint
  std::vector<double> values; // N or N m, one per constraint equation
};

// Of what changes with the phase of the drives, over all that they can take.
struct PhaseRange {
  double mean = 0, least = 0, most = 0;
};

struct DriveTorque {
  std::string joint;
  int index = 0, count = 1;
  bool angle = true;    // N m rather than N
  double value = 0;     // by the drive, positive along the coordinate
  bool varying = false; // changes with the phase of the drives; `value` is at the drawn phase
  // Over all phases of the drives, where it varies and they return: nothing at a sliding drive, or with more
  // than three drives of which no two return together.
  std::optional<PhaseRange> range{};
  bool nonunique = false; // loops are redundant, and share it among several drives: the minimum-norm share
  // Of a drive by torque, in the state: what it gives, and the load against it, whose difference is `value`.
  struct Given {
    double torque = 0, load = 0;
  };
  std::optional<Given> given{};
};

// Of a joint with dry friction that a state rests on: there is none without it.
struct FrictionForce {
  std::string joint;
  int index = 0, count = 1;
  bool angle = true;             // N m rather than N
  std::optional<double> value{}; // positive along the coordinate; where it changes with the phase of the
                                 // drives the largest. Nothing where loops leave it open
  double limit = 0;              // N m or N
  bool slips = false;            // gives its limit against the coordinate's rate; else holds it as drawn
};

// What the parent exerts on the child through a joint, its spring, stop, damper, drive and gears included.
struct Reaction {
  std::string joint;
  Vec3 force = Vec3::Zero();  // N, world axes at the drawn drive phase
  Vec3 torque = Vec3::Zero(); // N m, about `at` as carried by the child
  bool varying = false;       // changes with the phase of the drives
  // Redundant loops leave these directions of it open: there it is the one of the minimum-norm multipliers,
  // of many. World axes as of `force`.
  OpenWrench open{};

  bool nonunique() const { return open.any(); }
};

// What a gear does, as a torque or force along the coordinates of its two joints: there it is part of the
// reaction. On each joint's child by its parent.
struct GearReaction {
  std::string joint;                                // the gear
  double a = 0, b = 0;                              // positive along the coordinates
  bool angle_a = true, angle_b = true;              // N m rather than N
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero(); // of b as vectors: N, N m, world axes
  bool varying = false, nonunique = false;          // as of a Reaction
};

// What a bearing exerts on its second body.
struct BearingForce {
  std::string bearing;
  Vec3 force = Vec3::Zero();  // N, world axes at the drawn drive phase
  Vec3 torque = Vec3::Zero(); // N m, about `at` as carried by the second body
  bool varying = false;       // changes with the phase of the drives
};

// A point asked for, at the drawn drive phase.
struct PointSolution {
  BodyPoint point;
  PointMotion motion;
};

// One of the scene's measures, at the drawn drive phase.
struct MeasureSolution {
  std::string name, unit;      // an SI unit
  std::optional<double> value; // nothing where `reason` says why
  std::optional<double>
      error;              // estimated, absolute, by the errors of the coordinates; nothing where not known
  std::string reason;     // a sentence, or empty
  bool nonunique = false; // rests on reactions of redundant loops: the minimum-norm ones
};

// Of a steady state whose loops lose an equation that they have beside it.
inline constexpr std::string_view singular_loops_message =
    "The loops stand in a singular pose, as arms that hang straight do; the linearised motion has no modes "
    "there.";

// Rates of the coordinates with one parameter: rad or m per its unit. Rotation vectors are left out.
struct Sensitivity {
  std::string address;
  struct Rate {
    std::string joint;
    int index = 0, count = 1;
    double value = 0;
    bool speed = false; // of the speed that a torque gives: rad/s or m/s per its unit
  };
  std::vector<Rate> rates;
  std::vector<double> measures{}; // of the scene's measures, in its order; not a number where one has no rate
};

// A coordinate along which the forces push on without end: nothing opposes them, so nothing settles.
struct UnheldCoordinate {
  std::string joint;
  int index = 0, count = 1; // which of the joint's coordinates
  bool angle = false;       // N m rather than N
  double force = 0;         // generalised, positive along the coordinate: what would have to hold it
};

// Where drives give a torque: the same state with their speeds prescribed, at what was found.
struct AtConstantSpeed {
  std::optional<bool> stable;
  std::optional<StabilityReason> stability_reason;
  std::optional<std::vector<std::complex<double>>> eigenvalues; // 1/s
};

// The free ones by name, as SolveOptions::start wants them: not driven, not dependent; and speeds that were
// found as "joint.speed".
std::vector<std::pair<std::string, double>> start_values(const std::vector<CoordinateSolution>& coordinates);

struct Solution {
  Status status = Status::not_converged;
  std::string message;                         // always a sentence
  std::vector<CoordinateSolution> coordinates; // in the scene's order; empty where there is no answer
  std::vector<JointMultipliers> multipliers;
  double residual = 0; // largest scaled equation of eq. 23
  int iterations = 0;
  std::vector<double> history; // scaled residual at the start and after each iteration
  std::optional<Fallback> fallback;
  double run_time_s = 0; // from the start to the accepted answer
  std::optional<bool> stable;
  std::optional<StabilityReason> stability_reason;
  // 1/s, of the linearised motion; with `floquet` its exponents ln(multiplier) / period.
  std::optional<std::vector<std::complex<double>>> eigenvalues;
  std::optional<Floquet> floquet; // where the linearised motion turns with the drives
  // `stable` and what is beside it answer with drives that give their torques; this without them.
  std::optional<AtConstantSpeed> at_constant_speed;
  std::vector<std::string> neutral; // joints that take part in a direction nothing resists
  // Without an answer: what runs away, and whether it would not without gravity; whether what turns with the
  // drives is the weight alone.
  std::vector<UnheldCoordinate> unheld;
  bool unheld_by_weight = false, weight_turns = false;
  std::vector<DriveTorque> drive_torques;
  // Where without dry friction there is no steady state: what this one rests on.
  std::vector<FrictionForce> frictions;
  // It holds at every phase of the drives within the errors that it tells, which say how far it moves with
  // them: a motion is exact (periodic_state.hpp).
  bool varies = false;
  // What turns at speeds that are found stands at other angles than drawn (phase_search.hpp), as a flexible
  // coupling between two shafts asks for: at other numbers it stands at others.
  bool turned = false;
  std::vector<Reaction> reactions;
  std::vector<GearReaction> gears;
  std::vector<BearingForce> bearings;
  bool reactions_nonunique = false;       // of any joint: the minimum-norm multipliers
  std::vector<Pose> poses;                // in the order of the bodies, at the drawn drive phase
  std::vector<PointMotion> centres;       // mass centres likewise; with details only
  std::vector<PointSolution> points;      // those of SolveOptions::points
  std::vector<MeasureSolution> measures;  // the scene's, in its order; errors with details only
  std::vector<Sensitivity> sensitivities; // to the scene's sliders; none at a singular state
  std::optional<double> potential;        // J, amended, where there is one
  std::optional<double> condition;        // 2-norm, of the scaled equations
  bool singular_loops = false;            // no modes and eigenvalues: see singular_loops_message
};

} // namespace flyball
