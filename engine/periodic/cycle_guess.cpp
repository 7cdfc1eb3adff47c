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
constexpr double alike_loads = 1e-6;    // of the largest, as steps' errors leave them
constexpr double beside_steady = 0.05;  // scaled: where motions are compared, too
constexpr double least_share = 1e-6;    // of a unit vector: less is rounding
constexpr int most_ways = 64, most_tries = 4096; // of turning: that are tried, and sets of what stands still
constexpr double short_time = 1. / 64;           // of a drive's turn through a radian
constexpr double least_swinging = 1e-3; // of an eigenvalue's size its imaginary part: with less it creeps
constexpr double evenly = 1e-4;         // of a mean speed: what changes less between two looks has settled

void append(Eigen::MatrixXd& columns, const Eigen::VectorXd& column) {
  columns.conservativeResize(column.size(), columns.cols() + 1);
  columns.rightCols<1>() = column;
}

// What of a vector is at right angles to these columns.
Eigen::VectorXd beyond(const Eigen::MatrixXd& columns, const Eigen::VectorXd& way) {
  if (columns.cols() == 0) return way;
  const auto shares = least_squares(columns, way);
  return shares ? Eigen::VectorXd(way - columns * *shares) : way;
}

// Links of the drives by torque, and then of what loops and gears turn at speeds of their own with them.
std::vector<int> turning_links(const System& system) {
  std::vector<int> out;
  for (const DriveTorqueElement& drive : system.torques)
    out.push_back(drive.link);
  for (int l = 0; l < static_cast<int>(system.links.size()); ++l) {
    const Link& link =
        system.links[static_cast<std::size_t>(l)]; // a frame that moves freely: see TorqueDriven
    if (link.v >= 0 && link.frame == l && std::ranges::find(out, l) == out.end()) out.push_back(l);
  }
  return out;
}

Eigen::Index entry_of(const System& system, int link) {
  return system.links[static_cast<std::size_t>(link)].v;
}

// Of the drives by torque, with what loops and gears move along, and of what these leave to itself, as the
// other wheel of a differential.
Eigen::MatrixXd turning_directions(const Flow& flow, const FlowState& state) {
  const System& system = flow.model().system;
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(system.nv, system.nv);
  if (system.rows > 0) {
    Kinematics<double> k;
    Linearization l;
    forward<double>(system, flow.model().parameters, state.q, state.time, k);
    linearize_constraints(system, flow.model().parameters, k, l);
    const Scaling& scaling = flow.model().scaling;
    ConstraintSpace space;
    space.factor(scaling.row.asDiagonal() * l.constraint * scaling.column.asDiagonal(), 1e-9, row_rounding);
    basis = space.basis();
  }
  const Eigen::MatrixXd given = cyclic_directions(system, basis, false),
                        kept = cyclic_directions(system, basis, true);
  Eigen::MatrixXd out(system.nv, given.cols() + kept.cols());
  out << basis * given, basis * kept;
  for (const int link : turning_links(system)) {
    const Eigen::VectorXd way = basis * basis.row(entry_of(system, link)).transpose(),
                          left = beyond(out, way);
    if (left.norm() > least_share * std::max(1., way.norm())) append(out, left.normalized());
  }
  return out;
}

// Entries of revolute drives, what loops turn along included, by how far they turn along a direction.
std::vector<Eigen::Index> drives_by_turn(const System& system, const Eigen::VectorXd& way) {
  std::vector<Eigen::Index> out;
  for (const int l : turning_links(system))
    if (const Link& link = system.links[static_cast<std::size_t>(l)];
        link.type == LinkType::revolute && std::abs(way[link.v]) > least_share)
      out.push_back(link.v);
  std::ranges::stable_sort(out, std::greater(), [&](Eigen::Index v) { return std::abs(way[v]); });
  return out;
}

// Of the space of these columns the directions in which as many drives stand still as can: of a differential
// those with one wheel at rest, since what a drive carries depends on its own angle alone. Unit vectors.
std::vector<Eigen::VectorXd> ways_of_turning(const System& system, const Eigen::MatrixXd& space) {
  std::vector<Eigen::VectorXd> out;
  if (space.cols() == 1) out.push_back(space.col(0).normalized());
  if (space.cols() < 2) return out;
  const std::vector<int> links = turning_links(system);
  const auto drives = static_cast<int>(links.size());
  const auto still_count = static_cast<int>(space.cols()) - 1;
  std::vector<bool> chosen(static_cast<std::size_t>(drives), false);
  std::fill_n(chosen.begin(), std::min(still_count, drives), true);
  int tries = 0;
  do {
    Eigen::MatrixXd rows(still_count, space.cols());
    Eigen::Index row = 0;
    for (std::size_t d = 0; d < chosen.size() && row < still_count; ++d)
      if (chosen[d]) rows.row(row++) = space.row(entry_of(system, links[d]));
    ConstraintSpace still;
    still.factor(rows.topRows(row), 1e-9);
    if (still.basis().cols() != 1) continue; // some move along with others
    const Eigen::VectorXd way = (space * still.basis()).normalized();
    if (std::ranges::none_of(
            out, [&](const Eigen::VectorXd& known) { return beyond(known, way).norm() <= least_share; }))
      out.push_back(way);
  } while (static_cast<int>(out.size()) < most_ways && ++tries < most_tries &&
           std::prev_permutation(chosen.begin(), chosen.end()));
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

// Where the fastest growing motion about a steady state swings: that one, by multipliers of a time so short
// that none is taken for a slower swing.
Swing fastest_growing_swing(Flow& flow, const UnstableState& steady) {
  Orbit orbit;
  orbit.period = short_time / steady.rate;
  orbit.nodes = {StateChart(flow.problem(), steady.state, steady.rate, {})};
  ShootingOptions how;
  how.tolerance = step_tolerance * 1e-3;
  Swing out;
  const auto beside = monodromy(flow, orbit, how);
  if (!beside || beside->multipliers.empty()) return out;
  if (const std::complex<double> s = std::log(beside->multipliers.front()) / orbit.period;
      s.real() > 0 && std::abs(s.imag()) > least_swinging * std::abs(s))
    out.period = turn / std::abs(s.imag());
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
// does not go on alike if there are such, or else of what turns with them likewise; zero where none turns.
template <class Told>
double greatest_of_drives(const Flow& flow, const AlikeAngles& alike, const Told& told) {
  const System& system = flow.model().system;
  double greatest = 0, of_others = 0, of_alike = 0;
  for (const int l : turning_links(system)) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (link.type != LinkType::revolute) continue;
    const bool matters = alike.anywhere.cols() == 0 || alike.anywhere.row(link.v).norm() < 1e-6,
               drives =
                   std::ranges::find(system.torques, l, &DriveTorqueElement::link) != system.torques.end();
    if (!matters && !drives) continue;
    double& most = !matters ? of_alike : drives ? greatest : of_others;
    most = std::max(most, std::abs(told(link)));
  }
  return greatest > 0 ? greatest : of_others > 0 && alike.anywhere.cols() > 0 ? of_others : of_alike;
}

// s, of a turn of the fastest of them.
std::optional<double> turn_of_drives(const Flow& flow, const AlikeAngles& alike, const FlowState& state) {
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
SettledDrives settled_drives(const Flow& flow, const FlowState& state, double rate) {
  const MotionModel& model = flow.model();
  SettledDrives out;
  for (const DriveTorqueElement& drive : model.system.torques) {
    if (drive.implied) continue;
    const Link& link = model.system.links[static_cast<std::size_t>(drive.link)];
    const std::string drive_at = coordinate_label(model.system, link) + " at ";
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
Return first_return(const StateChart& begin, const std::vector<FlowState>& trace) {
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

// The mean of the rates with the weights exp(-1 / (t (1 - t))) over the time from 0 to 1: of a motion of
// several incommensurable periods it converges faster than any power of the time (Das, Sander, Saiki and
// Yorke, Nonlinearity 30, 2017). Empty where there are no states.
Eigen::VectorXd mean_speeds(const std::vector<FlowState>& trace) {
  Eigen::VectorXd sum;
  double weights = 0;
  for (std::size_t i = 1; i + 1 < trace.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(trace.size() - 1),
                 weight = std::exp(-1 / (t * (1 - t)));
    if (sum.size() == 0) sum.setZero(trace[i].u.size());
    sum += weight * trace[i].u;
    weights += weight;
  }
  return weights > 0 ? Eigen::VectorXd(sum / weights) : Eigen::VectorXd();
}

// What is said where the speeds have settled and the motion does not return.
std::string quasi_periodic_message(const Flow& flow, const AlikeAngles& alike,
                                   const Eigen::VectorXd& speeds) {
  const System& system = flow.model().system;
  std::vector<std::string> turning;
  for (const int l : turning_links(system)) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    const bool drives =
        std::ranges::find(system.torques, l, &DriveTorqueElement::link) != system.torques.end();
    const bool named =
        alike.drives.empty() ? drives : std::ranges::find(alike.drives, link.v) != alike.drives.end();
    if (!named || link.type != LinkType::revolute) continue;
    turning.push_back(coordinate_label(system, link) + " at " + rounded_text(speeds[link.v], 6) + " rad/s");
  }
  return "The motion from the drawn pose settles, but does not repeat itself within three turns: it depends "
         "on "
         "several angles that go on each at a mean speed of its own, " +
         word_list(std::vector<std::string_view>(turning.begin(), turning.end()), "and") +
         ", and is quasi-periodic unless these are locked in a ratio of higher numbers.";
}

// Whether what drives give, at the beginning and end of two runs, is the same.
bool loads_alike(const Run& a, const Run& b, double reach) {
  double largest = a.energy.kinetic.front(); // J, and so N m
  for (const DriveTrack& drive : a.drives)
    for (const double torque : drive.torque)
      largest = std::max(largest, std::abs(torque) * (drive.angle ? 1 : reach));
  for (std::size_t d = 0; d < a.drives.size(); ++d)
    for (std::size_t i = 0; i < a.drives[d].torque.size(); ++i)
      if (!(std::abs(a.drives[d].torque[i] - b.drives[d].torque[i]) * (a.drives[d].angle ? 1 : reach) <=
            alike_loads * largest))
        return false;
  return true;
}

// Whether motions from beside a state go alike when they begin then (s) as at first, and what drives give;
// `rate` (1/s) is the fastest drive's.
bool goes_alike_at(Flow& flow, const FlowState& state, double rate, const std::array<double, 3>& times) {
  const double span = 0.1 / rate;
  const StateChart chart(flow.problem(), state, rate, {});
  FlowState beside = chart.displaced(Eigen::VectorXd::LinSpaced(chart.size(), beside_steady, -beside_steady));
  beside.time = 0;
  const auto here = flow.pass(beside, span, step_tolerance * 1e-3);
  if (!here) return false;
  const StateChart after(flow.problem(), here->to, rate, {});
  const Run loads = flow.record(beside, span, 1, step_tolerance);
  if (loads.time.empty()) return false;
  return std::ranges::all_of(times, [&](double time) {
    beside.time = time;
    const auto there = flow.pass(beside, span, step_tolerance * 1e-3);
    if (!there || !(after.distance(there->to) < alike_in_time)) return false;
    const Run others = flow.record(beside, span, 1, step_tolerance);
    return !others.time.empty() && loads_alike(loads, others, flow.model().parameters.length);
  });
}

} // namespace

bool is_steady(const Flow& flow, const std::vector<FlowState>& states, double rate) {
  const Eigen::VectorXd& unit = flow.model().scaling.column;
  return std::ranges::all_of(states, [&](const FlowState& state) {
    return (state.u - states.front().u).cwiseQuotient(unit).lpNorm<Eigen::Infinity>() <= at_rest * rate;
  });
}

std::string settled_message(const Flow& flow, CycleStart start, const FlowState& state, double rate) {
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

AlikeAngles angles_alike(Flow& flow, const FlowState& state, double rate) {
  const System& system = flow.model().system;
  const Eigen::VectorXd& unit = flow.model().scaling.column;
  AlikeAngles out;
  out.anywhere.resize(system.nv, 0);
  out.turns.resize(system.nv, 0);
  const double span = 0.1 / rate;
  const auto here = flow.pass(state, span, step_tolerance * 1e-3);
  if (!here) return out;
  const auto goes_alike = [&](const Eigen::VectorXd& way, const Eigen::VectorXd& on) {
    FlowState turned = state;
    retract<double>(system, unit.cwiseProduct(on), turned.q);
    const auto there = flow.pass(turned, span, step_tolerance * 1e-3);
    if (!there) return false;
    const StateChart chart(flow.problem(), here->to, rate, {way, {}, {}});
    return chart.distance(there->to) < alike_in_space;
  };
  const Eigen::MatrixXd all = turning_directions(flow, state);
  const std::vector<Eigen::VectorXd> ways = ways_of_turning(system, all);
  for (const Eigen::VectorXd& way : ways)
    if (out.anywhere.cols() < all.cols() && beyond(out.anywhere, way).norm() > least_share &&
        goes_alike(way, 0.7 * way) && goes_alike(way, 2.2 * way))
      append(out.anywhere, way);
  // Of the others turns of drives, each with no part in those before.
  for (const Eigen::VectorXd& way : ways) {
    if (out.anywhere.cols() + out.turns.cols() == all.cols()) break;
    const Eigen::VectorXd beside = beyond(out.anywhere, way);
    if (beside.norm() <= least_share) continue;
    for (const Eigen::Index drive : drives_by_turn(system, way)) {
      const Eigen::VectorXd whole = turn / (unit[drive] * way[drive]) * way,
                            once = beyond(out.anywhere, whole);
      const bool apart = std::ranges::all_of(out.drives, [&](Eigen::Index v) {
        const auto i = std::ranges::find(out.drives, v) - out.drives.begin();
        return std::abs(once[v]) < least_share && std::abs(out.turns(drive, i)) < least_share;
      });
      if (!apart || std::abs(once[drive]) < least_share || !goes_alike(way, whole) ||
          !goes_alike(way, -2 * whole))
        continue;
      append(out.turns, once);
      out.drives.push_back(drive);
      break;
    }
  }
  return out;
}

bool goes_alike_at_phases(Flow& flow, const FlowState& state, double period) {
  return goes_alike_at(flow, state, turn / period, {0.21 * period, 0.56 * period, 0.83 * period});
}

bool goes_alike_without(Flow& flow, const FlowState& state, double period, double speed) {
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
                         const std::atomic<bool>* cancel, const ReportProgress& progress,
                         const std::optional<UnstableState>& around) {
  CycleOutcome out;
  report_progress(progress, "swings about the steady state");
  const auto refused = [&](const std::string& why) {
    out.guess.reset();
    out.trouble = why;
    return out;
  };
  const Swing swing = around ? fastest_growing_swing(flow, *around) : least_damped_swing(mechanism, cancel);
  const bool leaves = start == CycleStart::steady;
  std::optional<FlowState> steady;
  if (leaves && swing.period) steady = around ? around->state : flow.steady();
  if (leaves && !steady) return refused("Nothing swings about a steady state.");
  std::optional<FlowState> state = leaves ? steady : flow.drawn();
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
  // With two angles or more on which the motion depends, each turning on, it covers a torus as a rule.
  const bool torus = turning_directions(flow, *state).cols() - alike_along.anywhere.cols() > 1;
  Eigen::VectorXd speeds; // on a weighted average, at the last look
  const double first = *period;
  double before = 0; // how far it went away at the last look
  report_progress(progress, following_phase);
  for (int look = 0; look < looks; ++look) {
    const auto passage = flow.pass(*state, followed * *period, step_tolerance);
    if (!passage) return refused("The motion does not last: " + flow.trouble());
    const FlowState from = *state;
    state = passage->to;
    state->time = 0;
    // What turns may have become faster or slower.
    if (!swing.period) period = turn_of_drives(flow, alike_along, *passage).value_or(*period);
    const std::vector<FlowState> trace = flow.trace(*state, 3 * *period, 3 * samples, step_tolerance);
    if (trace.empty()) return refused("The motion does not last: " + flow.trouble());
    const StateChart chart(flow.problem(), *state, turn / *period, alike_along);
    const Return back = first_return(chart, trace);
    if (is_steady(flow, trace, turn / std::min(*period, first))) // steps leave noise of faster turning, too
      return refused(settled_message(flow, start, *state, turn / *period));
    const bool grows = std::abs(back.farthest - before) > steadily * back.farthest;
    before = back.farthest;
    const bool returns = back.sample > 0 && back.nearest <= returned * back.farthest;
    if (torus && !returns && !swing.period) {
      const Eigen::VectorXd now =
          mean_speeds(flow.trace(from, followed * *period, followed * samples, step_tolerance));
      const bool settled =
          now.size() > 0 && now.size() == speeds.size() &&
          (now - speeds).cwiseQuotient(flow.model().scaling.column).lpNorm<Eigen::Infinity>() <
              evenly * turn / *period;
      if (settled) return refused(quasi_periodic_message(flow, alike_along, now));
      speeds = now;
    }
    if (!returns || (grows && look + 1 < looks)) continue;
    out.guess = {*period * static_cast<double>(back.sample) / samples, alike_along, steady, state, {}};
    return out;
  }
  return refused("The motion did not come to repeat itself.");
}

} // namespace flyball
