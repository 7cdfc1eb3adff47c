#include "engine/periodic/cycle_guess.hpp"

#include "engine/kkt/constraint_space.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/periodic/shooting.hpp"
#include "engine/report/analysis.hpp"
#include "engine/stability/linear_motion.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace flyball {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double step_tolerance = 1e-8; // of the motion that is followed
constexpr int followed = 10;            // guessed periods between two looks
constexpr int looks = 40;               // at most
constexpr int samples = 96;             // a guessed period
constexpr double returned = 0.03;       // of the way between: near enough
constexpr double at_rest = 1e-6;        // scaled: what moves less does not
constexpr double standing = 1e-5;       // of a turn in the period: a drive that turns by less stands still
constexpr double off_steady = 0.01;     // scaled, from a steady state
constexpr double steadily = 0.01;       // of its size: what changes less in between has settled
constexpr double alike_in_space = 1e-6; // scaled, of motions from two angles
constexpr double alike_in_time = 1e-9;  // and from two phases of drives: a small unbalance is one, too
constexpr int most_periods = 20000;     // in which a drive is to stand otherwise against the others
constexpr double beside_steady = 0.05;  // scaled: where motions are compared, too

// Of the drives by torque, with what loops and gears move along.
Eigen::MatrixXd turning_directions(const Flow& flow, const MotionState& state) {
  const System& system = flow.model().system;
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(system.nv, system.nv);
  if (system.rows > 0) {
    Kinematics<double> k;
    Linearization l;
    forward<double>(system, flow.model().parameters, state.q, state.time, k);
    linearize_constraints(system, flow.model().parameters, k, l);
    const Scaling& scaling = flow.model().scaling;
    ConstraintSpace space;
    space.factor(scaling.row.asDiagonal() * l.constraint * scaling.column.asDiagonal(), 1e-9);
    basis = space.basis();
  }
  const Eigen::MatrixXd given = cyclic_directions(system, basis, false),
                        kept = cyclic_directions(system, basis, true);
  Eigen::MatrixXd out(system.nv, given.cols() + kept.cols());
  out << basis * given, basis * kept;
  return out;
}

// The least damped swing about the steady state.
struct Swing {
  bool stable = false;          // the steady state
  std::optional<double> period; // s; nothing where nothing swings, or there is no steady state
};
Swing least_damped_swing(const Mechanism& mechanism, const std::atomic<bool>* cancel) {
  SolveOptions options;
  options.cancel = cancel;
  const Solution steady = Analysis(mechanism).solve(options);
  Swing out;
  if (steady.status != Status::converged || !steady.eigenvalues) return out;
  out.stable = steady.stable == true;
  double most = -std::numeric_limits<double>::infinity();
  for (const std::complex<double>& s : *steady.eigenvalues)
    if (s.imag() > 0 && s.real() > most) {
      most = s.real();
      out.period = turn / s.imag();
    }
  return out;
}

// Its shape as CycleGuess has it; nothing where that does not swing.
Eigen::VectorXd shape_of_swing(Flow& flow, const StateChart& steady, double period) {
  Orbit orbit;
  orbit.period = period;
  orbit.nodes = {steady};
  ShootingOptions how;
  how.tolerance = step_tolerance * 1e-3;
  const auto beside = monodromy(flow, orbit, how);
  const auto modes = beside ? eigenvectors(beside->matrix) : std::nullopt;
  if (!modes || modes->values.size() == 0) return {};
  Eigen::Index largest = 0;
  modes->values.cwiseAbs().maxCoeff(&largest);
  const Eigen::VectorXd way = modes->vectors.col(largest).real();
  const double size = way.size() > 0 ? way.lpNorm<Eigen::Infinity>() : 0.;
  return size > 0 ? Eigen::VectorXd(way / size) : Eigen::VectorXd();
}

// Of the drives by torque the greatest of what is told of their links, of those at whose angles the motion
// does not go on alike if there are such; zero where none turns.
template <class Told>
double greatest_of_drives(const Flow& flow, const AlikeAngles& alike, const Told& told) {
  double greatest = 0, of_alike = 0;
  for (const DriveTorqueElement& drive : flow.model().system.torques) {
    const Link& link = flow.model().system.links[static_cast<std::size_t>(drive.link)];
    if (link.type != LinkType::revolute) continue;
    const bool matters = alike.anywhere.cols() == 0 || alike.anywhere.row(link.v).norm() < 1e-6;
    double& most = matters ? greatest : of_alike;
    most = std::max(most, std::abs(told(link)));
  }
  return greatest > 0 ? greatest : of_alike;
}

// s, of a turn of the fastest of them.
std::optional<double> turn_of_drives(const Flow& flow, const AlikeAngles& alike, const MotionState& state) {
  const double fastest = greatest_of_drives(flow, alike, [&](const Link& link) { return state.u[link.v]; });
  if (!(fastest > 0)) return {};
  return turn / fastest;
}

// The same on the average of a passage; nothing where none turns by the tenth part of a turn, or in the end
// at the tenth part of that speed: what has come to rest, or swings, turns at no speed.
std::optional<double> turn_of_drives(const Flow& flow, const AlikeAngles& alike, const Passage& passage) {
  const double farthest = greatest_of_drives(
      flow, alike, [&](const Link& link) { return passage.to.q[link.q] - passage.from.q[link.q]; });
  const auto at_end = turn_of_drives(flow, alike, passage.to);
  if (!(farthest > 0.1 * turn) || !at_end) return {};
  const double average = (passage.to.time - passage.from.time) * turn / farthest;
  if (*at_end > 10 * average) return {};
  return average;
}

// What drives by torque do in a motion that has settled: where those stand that came to rest, as "p at
// 0.5 rad", and how fast the others turn, as "p at 6 rad/s". `rate` (1/s) as is_steady() has it.
struct SettledDrives {
  std::vector<std::string> resting, turning;
};
SettledDrives settled_drives(const Flow& flow, const MotionState& state, double rate) {
  const MotionModel& model = flow.model();
  SettledDrives out;
  for (const DriveTorqueElement& drive : model.system.torques) {
    if (drive.implied) continue;
    const Link& link = model.system.links[static_cast<std::size_t>(drive.link)];
    const TreeJoint& joint = model.system.tree_joints[static_cast<std::size_t>(link.tree_joint)];
    const std::string drive_at =
        coordinate_label(joint.name, link.coordinate, coordinate_count(joint.type)) + " at ";
    const bool angle = link.type == LinkType::revolute;
    const double speed = state.u[link.v];
    if (std::abs(speed) > standing * rate * model.scaling.column[link.v]) {
      out.turning.push_back(drive_at + rounded_text(speed, 6) + (angle ? " rad/s" : " m/s"));
    } else if (!drive.keeps_momentum) {
      const double known = 1e-6 * (angle ? 1 : model.parameters.length), at = state.q[link.q];
      out.resting.push_back(drive_at + rounded_text(std::abs(at) < known ? 0 : at, 6) +
                            (angle ? " rad" : " m"));
    }
  }
  return out;
}

// The first time that a motion comes near where it began, having been away.
struct Return {
  double farthest = 0, nearest = std::numeric_limits<double>::infinity(); // scaled
  std::size_t sample = 0;                                                 // 0: it does not
};
Return first_return(const StateChart& begin, const std::vector<MotionState>& trace) {
  Return out;
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double away = begin.distance(trace[i]);
    if (away > out.farthest)
      out = {away, std::numeric_limits<double>::infinity(), 0};
    else if (away < out.nearest) {
      out.nearest = away;
      out.sample = i;
    }
    if (out.nearest < returned * out.farthest && away > 2 * out.nearest) break;
  }
  return out;
}

// Whether motions from beside a state go alike when they begin then (s) as at first; `rate` (1/s) is the
// fastest drive's.
bool goes_alike_at(Flow& flow, const MotionState& state, double rate, const std::array<double, 3>& times) {
  const double span = 0.1 / rate;
  const StateChart chart(flow.problem(), state, rate, {});
  MotionState beside =
      chart.displaced(Eigen::VectorXd::LinSpaced(chart.size(), beside_steady, -beside_steady));
  beside.time = 0;
  const auto here = flow.pass(beside, span, step_tolerance * 1e-3);
  if (!here) return false;
  const StateChart after(flow.problem(), here->to, rate, {});
  return std::ranges::all_of(times, [&](double time) {
    beside.time = time;
    const auto there = flow.pass(beside, span, step_tolerance * 1e-3);
    return there && after.distance(there->to) < alike_in_time;
  });
}

} // namespace

bool is_steady(const Flow& flow, const std::vector<MotionState>& states, double rate) {
  const Eigen::VectorXd& unit = flow.model().scaling.column;
  return std::ranges::all_of(states, [&](const MotionState& state) {
    return (state.u - states.front().u).cwiseQuotient(unit).lpNorm<Eigen::Infinity>() <= at_rest * rate;
  });
}

std::string settled_message(const Flow& flow, CycleStart start, const MotionState& state, double rate) {
  const std::string motion = start == CycleStart::steady ? "The motion that leaves the steady state"
                                                         : "The motion from the drawn pose";
  const auto list = [](const std::vector<std::string>& all) {
    return word_list(std::vector<std::string_view>(all.begin(), all.end()), "and");
  };
  const auto [resting, turning] = settled_drives(flow, state, rate);
  if (!resting.empty())
    return motion + " settles, and its drive by a torque comes to rest: " + list(resting) +
           ". To have that as a steady state leave the drive out; a spring of a constant force is a torque, "
           "too.";
  return motion + " settles in " + (start == CycleStart::steady ? "another one" : "a steady state") +
         (turning.empty() ? "." : ", " + list(turning) + ".");
}

AlikeAngles angles_alike(Flow& flow, const MotionState& state, double rate) {
  const System& system = flow.model().system;
  const Eigen::VectorXd& unit = flow.model().scaling.column;
  const Eigen::MatrixXd all = turning_directions(flow, state);
  AlikeAngles out;
  out.anywhere.resize(all.rows(), 0);
  out.turns.resize(all.rows(), 0);
  const double span = 0.1 / rate;
  const auto here = flow.pass(state, span, step_tolerance * 1e-3);
  for (Eigen::Index i = 0; here && i < all.cols(); ++i) {
    const Eigen::VectorXd way = all.col(i).normalized();
    const auto goes_alike = [&](const Eigen::VectorXd& on) {
      MotionState turned = state;
      retract<double>(system, unit.cwiseProduct(on), turned.q);
      const auto there = flow.pass(turned, span, step_tolerance * 1e-3);
      if (!there) return false;
      const StateChart chart(flow.problem(), here->to, rate, {way, {}, {}});
      return chart.distance(there->to) < alike_in_space;
    };
    if (goes_alike(0.7 * way) && goes_alike(2.2 * way)) {
      out.anywhere.conservativeResize(Eigen::NoChange, out.anywhere.cols() + 1);
      out.anywhere.rightCols<1>() = way;
      continue;
    }
    // By the drive that turns most along it.
    Eigen::Index most = -1;
    for (const DriveTorqueElement& drive : system.torques)
      if (const Link& link = system.links[static_cast<std::size_t>(drive.link)];
          link.type == LinkType::revolute && (most < 0 || std::abs(way[link.v]) > std::abs(way[most])))
        most = link.v;
    if (most < 0 || std::abs(way[most]) < 1e-6) continue;
    const Eigen::VectorXd once = turn / (unit[most] * way[most]) * way;
    if (!goes_alike(once) || !goes_alike(-2 * once)) continue;
    out.turns.conservativeResize(Eigen::NoChange, out.turns.cols() + 1);
    out.turns.rightCols<1>() = once;
    out.drives.push_back(most);
  }
  return out;
}

bool goes_alike_at_phases(Flow& flow, const MotionState& state, double period) {
  return goes_alike_at(flow, state, turn / period, {0.21 * period, 0.56 * period, 0.83 * period});
}

bool goes_alike_without(Flow& flow, const MotionState& state, double period, double speed) {
  // After whole periods of the others, where this one stands as nearly as it comes to these parts of a turn.
  std::array<double, 3> times{};
  std::ranges::transform(std::array{0.21, 0.56, 0.83}, times.begin(), [&](double part) {
    double best = 0, nearest = 1;
    for (int k = 1; k <= most_periods; ++k) {
      const double turns = k * period * speed / turn, off = std::abs(std::remainder(turns - part, 1.));
      if (off >= nearest) continue;
      nearest = off;
      best = k * period;
    }
    return best;
  });
  return goes_alike_at(flow, state, std::max(turn / period, std::abs(speed)), times);
}

CycleOutcome guess_cycle(Flow& flow, const Mechanism& mechanism, CycleStart start,
                         const std::atomic<bool>* cancel) {
  CycleOutcome out;
  const auto refused = [&](const std::string& why) {
    out.guess.reset();
    out.trouble = why;
    return out;
  };
  const Swing swing = least_damped_swing(mechanism, cancel);
  const bool leaves = start == CycleStart::steady;
  const std::optional<MotionState> steady = leaves && swing.period ? flow.steady() : std::nullopt;
  if (leaves && !steady) return refused("Nothing swings about a steady state.");
  std::optional<MotionState> state = leaves ? steady : flow.drawn();
  if (!state) return refused(flow.trouble());
  std::optional<double> period = swing.period;
  if (!period) period = turn_of_drives(flow, {}, *state);
  if (!period)
    return refused(
        "No drive turns, and nothing swings about a steady state, so that there is no period to look for.");
  const AlikeAngles alike_along = angles_alike(flow, *state, turn / *period);
  if (!swing.period) period = turn_of_drives(flow, alike_along, *state).value_or(*period);
  if (steady) {
    const StateChart chart(flow.problem(), *steady, turn / *period, alike_along);
    if (swing.stable) {
      out.guess = {*period, alike_along, steady, {}, shape_of_swing(flow, chart, *period)};
      if (out.guess->swing.size() == 0)
        return refused("Nothing swings about the steady state, which is stable.");
      return out;
    }
    state = chart.displaced(Eigen::VectorXd::Constant(chart.size(), off_steady));
  }
  const double first = *period;
  double before = 0; // how far it went away at the last look
  for (int look = 0; look < looks; ++look) {
    const auto passage = flow.pass(*state, followed * *period, step_tolerance);
    if (!passage) return refused("The motion does not last: " + flow.trouble());
    state = passage->to;
    state->time = 0;
    // What turns may have become faster or slower.
    if (!swing.period) period = turn_of_drives(flow, alike_along, *passage).value_or(*period);
    const std::vector<MotionState> trace = flow.trace(*state, 3 * *period, 3 * samples, step_tolerance);
    if (trace.empty()) return refused("The motion does not last: " + flow.trouble());
    const StateChart chart(flow.problem(), *state, turn / *period, alike_along);
    const Return back = first_return(chart, trace);
    if (is_steady(flow, trace, turn / std::min(*period, first))) // steps leave noise of faster turning, too
      return refused(settled_message(flow, start, *state, turn / *period));
    const bool grows = std::abs(back.farthest - before) > steadily * back.farthest;
    before = back.farthest;
    if (back.sample == 0 || back.nearest > returned * back.farthest || (grows && look + 1 < looks)) continue;
    out.guess = {*period * static_cast<double>(back.sample) / samples, alike_along, steady, state, {}};
    return out;
  }
  return refused("The motion did not come to repeat itself.");
}

} // namespace flyball
