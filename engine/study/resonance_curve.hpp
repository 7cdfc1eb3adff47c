// Periodic motions over one number, where drives make the balance turn: of each output the mean, least and
// most over a period. Every point is found from the drawn pose, as find_periodic_state() does on its own;
// where there is a steady state that is the point, unless it holds within its errors only. Between points the
// curve is refined where it bends most.
#pragma once

#include "engine/periodic/periodic_state.hpp"
#include "engine/task/progress.hpp"

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

enum class OutputKind {
  coordinate,
  measure,
  drive,          // its torque or force
  power,          // of a drive
  force,          // through a joint: its size, as of the next three
  moment,         // through a joint
  bearing_force,  // of a bearing
  bearing_moment, // of a bearing
  motion,         // of all of it, such as its period
};

struct ResonanceOutput {
  OutputKind kind = OutputKind::coordinate;
  std::string name, unit; // "whirl", "spin.speed"; SI
  PeriodicRange range;    // without width in a steady state, and where it is one number of the motion

  bool is(OutputKind of, std::string_view called) const { return kind == of && name == called; }
};

struct ResonancePoint {
  double number = 0;          // of what is varied
  std::string trouble;        // why there is neither a motion nor a steady state, a sentence; else empty
  bool steady = false;        // a steady state
  std::optional<bool> stable; // by Floquet's multipliers; of a steady state as its solution says
  // Coordinates that are found, with rates of what goes on; measures; drive torques and powers; what joints
  // and bearings bear; the motion's period and largest multiplier.
  std::vector<ResonanceOutput> outputs;
  long evaluations = 0; // of the equations of motion

  bool found() const { return trouble.empty(); }
  // Null: there is none.
  const PeriodicRange* range_of(OutputKind kind, std::string_view name) const;
};

struct ResonanceCurve {
  std::vector<std::shared_ptr<const ResonancePoint>> points; // in the order of the range
  std::vector<double> places;                                // of each, as a part of the range
  bool whole = false;                                        // nothing was cancelled, and no bound reached
  double run_time_s = 0;
};

// A stretch of the range in which no point has an answer.
struct ResonanceGap {
  double from = 0, to = 0; // the first and the last such point
  std::string why;         // of the first
};
std::vector<ResonanceGap> resonance_gaps(const ResonanceCurve& curve);

struct ResonanceOptions {
  bool logarithmic = false; // evenly spaced in the number's logarithm; both ends are positive then
  int coarse = 33;          // points in order over the range, at least 2; then others between them
  int most = 257;           // in all
  double tolerance = 0.01;  // how far a point may be off the line through its neighbours, of what an output
                            // goes through over the range
  // Of the equations of motion, of all points together: then no other point is begun.
  long most_evaluations = std::numeric_limits<long>::max();
  const std::atomic<bool>* cancel = nullptr; // the point under way is dropped, those before stay
  const ResonanceCurve* begun = nullptr;     // a part of this very curve: its points are taken over
  ReportProgress progress{};                 // `part`: of the points that are known to be wanted
  std::function<void(const ResonanceCurve&)> publish{}; // after each point
};

// Of a state that is found at `number`.
ResonancePoint resonance_point(const PeriodicState& motion, double number);
ResonancePoint resonance_point(const Solution& steady, double number);

// Throws SceneError for an address that the mechanism does not take.
ResonanceCurve resonance_curve(const Mechanism& mechanism, const std::string& address, double from, double to,
                               const ResonanceOptions& options = {});

} // namespace flyball
