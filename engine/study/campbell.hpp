// The Campbell diagram: the modes of a steady state over a drive's speed, each followed through crossings,
// and the speeds at which one swings as often as something excites it.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/stability/mode_motion.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flyball {

struct CampbellPoint {
  std::vector<VibrationMode> modes; // shapes left out where the linearised motion turns with the drives
  std::vector<std::optional<Whirl>> whirls; // by mode, about the axis of the drive
  std::vector<int> lines;                   // by line of the branch: which of the modes, or -1
  const VibrationMode* on(std::size_t line) const {
    return lines[line] < 0 ? nullptr : &modes[static_cast<std::size_t>(lines[line])];
  }
};

struct CampbellBranch {
  std::vector<CampbellPoint> points; // as those of the response's branch
  // By line: "mode 2, slide", by frequency where the branch begins and by what moves most where it first
  // swings; empty for lines that swing nowhere.
  std::vector<std::string> names;
};

// A speed of the drive at which a mode swings `order` times a turn: its line crosses the order's, only
// touches it, or runs along it, as that of a tuned centrifugal pendulum does.
struct CriticalSpeed {
  int branch = 0, line = 0;
  double order = 1;
  double value = 0; // of the number along the axis, at `speed`: the same, where that is the drive's itself
  double speed = 0, frequency = 0; // rad/s
  // rad/s: the highest of the speeds, from `speed` on, at which the mode's line runs along the order's.
  std::optional<double> until;
  double error = 0; // rad/s, of the speed, estimated; of both ends where it runs along
  double damping_ratio = 0;
  bool touches = false;       // a double root: on either side the mode swings more often, or less
  bool stable = true;         // not known to be unstable there
  std::optional<Whirl> whirl; // about the drive's axis
};

struct CampbellDiagram {
  ResponseDiagram response;
  std::vector<CampbellBranch> branches; // as the response's; of points without modes no lines
  // By branch and speed. Orders count turns in the frame that the modes are of: that of what carries them.
  std::vector<CriticalSpeed> critical;
  double run_time_s = 0; // that of the response included
};

// By line of a branch: which of the modes of a state at `value`, between its points `after` and `after + 1`,
// lies on it, or -1.
std::vector<int> modes_on_lines(const ResponseBranch& followed, const CampbellBranch& branch,
                                std::size_t after, double value, std::span<const VibrationMode> modes);

// Whether an unbalance, which turns with the drive, can excite the critical speed: once a turn, and what does
// not go round against it in circles. Not known where modes are seen from what turns along, to which an
// unbalance stands.
bool unbalance_excites(const CriticalSpeed& critical);

// A sentence or two on the points of a branch that have no modes because its loops are singular there; empty
// where there are none. `speed_text` writes a speed as a number of `unit`.
std::string left_out(const ResponseBranch& branch, const std::function<std::string(double)>& speed_text,
                     const std::string& unit);

// The modes along the branches of `response`, which were followed over `address`. `orders` (any positive
// numbers) count turns of the drive of DriveSpeed, and need one. Where `cancel` is set there are branches as
// far as it came.
CampbellDiagram campbell_diagram(const Mechanism& mechanism, const std::string& address,
                                 ResponseDiagram response, std::span<const double> orders,
                                 const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
