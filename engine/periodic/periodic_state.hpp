// Periodic steady states: where drives at constant speed make the balance turn nothing stands still, but
// there are motions that come back to themselves after a period of the drives. Where torques drive there are
// such with a period of their own, where a steady state hunts: limit cycles. This finds one, with the mean
// and range of everything over a period, and says by its Floquet multipliers whether it is stable.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/solve/solution.hpp"
#include "engine/task/progress.hpp"

#include <array>
#include <optional>

namespace flyball {

struct PeriodicOptions {
  bool nearest = false; // the one by Newton's method from the drawn pose, stable or not
  // What the search may take: one is some seconds by the size of the mechanism, counted in evaluations of the
  // equations of motion, so that every run finds the same.
  double patience = 1;
  const std::atomic<bool>* cancel = nullptr;
  ReportProgress progress{}; // by phases, of which nobody knows how long they are
};

enum class PeriodicStatus {
  found,        // with `stable == false` an unstable one
  not_found,    // though there may be one; the message says what was tried
  not_periodic, // the drives do not return together, or nothing is periodic where they pump a motion up
};
std::string_view word(PeriodicStatus status);

// Of what changes over a period. Not numbers where it is undefined somewhere, nor where it does not come back
// with the motion, as where a point of a balanced wheel is.
struct PeriodicRange {
  double mean = 0, least = 0, most = 0;
  double error = 0; // estimated, absolute, of each; not a number where it was not found
};

// Of a joint; rad or m, as it labels it. What goes on from period to period counts less its even share of
// that.
struct PeriodicCoordinate {
  std::string joint;
  int index = 0, count = 1;
  bool angle = false, dependent = false;
  double scale = 1;   // as of a CoordinateSolution: 1 rad, or m, the mechanism's reach
  double advance = 0; // rad or m a period
  PeriodicRange range;
  PeriodicRange rate; // rad/s or m/s

  bool goes_on() const { return advance != 0; }
};

struct PeriodicMeasure {
  std::string name, unit;
  PeriodicRange range;
};

// N m or N, by the drive, positive along its coordinate.
struct PeriodicTorque {
  std::string joint;
  int index = 0, count = 1;
  bool angle = true;
  PeriodicRange range;
  PeriodicRange power;    // W: its mean is what the drive gives
  bool nonunique = false; // as of a DriveTorque
};

// A force or moment: its size, and x, y, z of the world.
struct PeriodicVector {
  PeriodicRange size;
  std::array<PeriodicRange, 3> component;
  // Components that redundant loops leave open, as of a Reaction; where they leave others unique, the size of
  // what these make.
  std::array<bool, 3> open{};
  std::optional<PeriodicRange> unique_size{};

  bool nonunique() const { return open[0] || open[1] || open[2]; }
};

// What a joint's parent exerts on its child, as a Reaction tells it, or a bearing on its second body.
struct PeriodicReaction {
  std::string name;             // the joint or bearing
  PeriodicVector force, torque; // N, N m

  bool nonunique() const { return force.nonunique() || torque.nonunique(); }
};

// What the spring, damper and stop of a joint's coordinate exert on its child, positive along the coordinate;
// or those between two points, where tension is positive. Those that act, and their sum where it is of
// several. Of joints but ball joints, and of those that close loops the dampers alone.
struct PeriodicSpring {
  std::string joint;        // or the spring between two points
  int index = 0, count = 1; // which of the joint's coordinates
  bool between_points = false;
  bool angle = false;                                     // N m rather than N
  std::optional<PeriodicRange> spring, damper, stop, sum; // N or N m
};

// What a gear does along the coordinates of its two joints, as a GearReaction tells it.
struct PeriodicGear {
  std::string joint;
  bool angle_a = true, angle_b = true; // N m rather than N
  PeriodicRange a, b;                  // not numbers where others lead there
  bool nonunique = false;
};

struct PeriodicState {
  PeriodicStatus status = PeriodicStatus::not_found;
  std::string message;     // always sentences
  double period = 0;       // s
  double period_error = 0; // s, estimated; none where it is that of the drives
  int drive_periods = 1;   // of the drives' common period, in one of the motion's; 0: of a limit cycle
  SimulationState start;   // at the drawn phase
  std::vector<PeriodicCoordinate> coordinates; // free ones, in the scene's order
  std::vector<PeriodicTorque> drive_torques;
  std::vector<PeriodicReaction> reactions, bearings;
  std::vector<PeriodicGear> gears;
  std::vector<PeriodicSpring> springs;
  std::vector<PeriodicMeasure> measures;
  double residual = 0; // by how much it fails to come back: the largest scaled coordinate or rate
  std::optional<bool> stable;
  std::optional<StabilityReason> stability_reason; // floquet or neutral
  Floquet floquet;                                 // without multipliers where nothing moves freely
  int iterations = 0, segments = 1;
  std::vector<double> history; // residuals
  long evaluations = 0;        // of the equations of motion
  double run_time_s = 0;
  std::shared_ptr<const Run> motion; // a period, evenly sampled from the drawn phase on
};

// Throws SceneError for a mechanism that cannot be compiled.
PeriodicState find_periodic_state(const Mechanism& mechanism, const PeriodicOptions& options = {});

} // namespace flyball
