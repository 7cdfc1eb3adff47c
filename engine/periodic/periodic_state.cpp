#include "engine/periodic/periodic_state.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/periodic/cycle_guess.hpp"
#include "engine/periodic/drive_period.hpp"
#include "engine/periodic/measured_orbit.hpp"
#include "engine/periodic/shooting.hpp"
#include "engine/stability/floquet.hpp"
#include "engine/system/dampers.hpp"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <utility>

namespace flyball {
namespace {

constexpr int settling_periods = 200; // of a motion that is to come near a periodic one
constexpr double settling = 1e-8;     // tolerance of its steps
constexpr double settled = 1e-3;      // scaled: from here on it is Newton's method's
constexpr int longest_multiple = 4;   // of the drives' period that is looked for
constexpr double push_off = 0.02;     // scaled, from an unstable one
constexpr double strong_growth = 1e3; // in a segment
constexpr double inexact = 1e-4;      // relative error of a multiplier: too much
constexpr double least_swing = 0.01;  // scaled, of the first guess around a stable steady state
constexpr double furthest = 64;       // times as far is the last guess of a limit cycle
constexpr int pulling_periods = 32;   // in which a push on and on is to outweigh what dies out
constexpr int frozen_segments = 8;    // of a guess that stands as drawn
constexpr double pumping = 1.5;       // times as far after twice as many periods: what is pumped up goes on

double tolerance_of(const Flow& flow) {
  return flow.is_stiff() ? 1e-10 : 1e-12;
}

struct Candidate {
  Orbit orbit;
  Monodromy beside;
  ShootingOptions how;
  int periods = 1; // of the drives; 0: of a limit cycle
  std::optional<bool> stable;
};

class Search {
 public:
  Search(const Mechanism& mechanism, const PeriodicOptions& options)
      : options_(options), flow_(mechanism, options.patience, options.cancel),
        drives_(drive_period(flow_.model())) {}

  PeriodicState run() {
    PeriodicState out;
    if (has_friction(flow_.model().mechanism)) {
      out.status = PeriodicStatus::not_periodic;
      out.message = "Periodic motions are not looked for where dry friction sticks and slips; the motion "
                    "beside shows them.";
      return out;
    }
    leave_out_even_drives();
    if (!drives_.trouble.empty()) {
      out.status = PeriodicStatus::not_periodic;
      out.message = drives_.trouble;
      return out;
    }
    const std::optional<Candidate> found = of_its_own() ? find_cycle() : find();
    out.evaluations = flow_.evaluations();
    if (!found) {
      refuse(out);
      return out;
    }
    tell(*found, out);
    if (const auto track = std::ranges::find_if(
            out.drive_torques, [](const PeriodicTorque& each) { return std::isnan(each.range.mean); });
        track != out.drive_torques.end()) {
      PeriodicState none;
      none.status = PeriodicStatus::not_periodic;
      none.evaluations = out.evaluations;
      none.message =
          "What moves freely comes back after " + rounded_text(found->how.period, 6) +
          " s, but what the drive " + coordinate_label(track->joint, track->index, track->count) +
          " gives does not, as gears or other drives stand otherwise then: of this no period is known.";
      return none;
    }
    return out;
  }

 private:
  double rate() const { return drives_.fastest; }
  // Nothing prescribed turns, or nothing depends on where it stands: the motion has a period of its own, if
  // it has one.
  bool of_its_own() const { return drives_.period == 0 || untimed_; }

  // Where several drives turn, those at whose angles all goes on alike have no part in the period.
  void leave_out_even_drives() {
    for (std::size_t i = 0; drives_.speeds.size() > 1 && i < drives_.speeds.size();) {
      DrivePeriod rest = drives_;
      rest.speeds.erase(rest.speeds.begin() + static_cast<std::ptrdiff_t>(i));
      rest.names.erase(rest.names.begin() + static_cast<std::ptrdiff_t>(i));
      rest.find_common();
      const auto start = rest.trouble.empty() && rest.period != drives_.period ? flow_.drawn() : std::nullopt;
      if (start && goes_alike_without(flow_, *start, rest.period, drives_.speeds[i]))
        drives_ = std::move(rest);
      else
        ++i;
    }
  }

  // A stable one where a motion leads to it, else the one nearest to the drawn pose.
  std::optional<Candidate> find() {
    const auto start = flow_.drawn();
    if (!start) {
      end_ = flow_.cancelled() ? ShootingEnd::cancelled : ShootingEnd::no_motion;
      return {};
    }
    if (!flow_.model().system.torques.empty()) alike_ = angles_alike(flow_, *start, rate());
    std::optional<Candidate> first = attempt({*start}, 1);
    if (!first && end_ != ShootingEnd::pumped)
      if (const auto steady = flow_.steady()) first = attempt({*steady}, 1);
    if (!first && !flow_.model().system.torques.empty() && !flow_.spent() && !flow_.cancelled() &&
        goes_alike_at_phases(flow_, *start, drives_.period)) {
      untimed_ = true;
      if (auto cycle = find_cycle()) return cycle;
    }
    if (!first && end_ != ShootingEnd::pumped)
      if (const auto guess = frozen(*start); !guess.empty()) first = attempt(guess, 1);
    if (options_.nearest || (first && first->stable != false) || flow_.spent() || flow_.cancelled())
      return first;
    const auto [state, periods] = settle(first ? pushed_off(*first) : *start);
    if (!state) return first;
    auto second = attempt({*state}, 1);
    // It may come back sooner than it was seen to: the least number of periods is tried first.
    for (int count = 2; count <= periods && (!second || second->stable == false); ++count)
      if (periods % count == 0)
        if (auto longer = attempt({*state}, count); longer && (longer->stable != false || count == periods))
          second = std::move(longer);
    if (first && (!second || second->stable == false) && stands(*first) &&
        goes_alike_at_phases(flow_, first->orbit.nodes.front().base(), drives_.period)) {
      auto cycle = find_cycle(CycleStart::steady);
      // The mechanism's solution may be another one, about which nothing swings.
      if (!cycle)
        cycle = find_cycle(CycleStart::steady, UnstableState{first->orbit.nodes.front().base(), rate()});
      if (cycle) {
        left_first_ = true;
        return cycle;
      }
    }
    if (!second || (first && second->stable == false)) return first;
    left_first_ = first.has_value();
    return second;
  }

  // Around the steady state, or where a motion leads to: first one that leaves it.
  std::optional<Candidate> find_cycle() {
    for (const CycleStart start : {CycleStart::steady, CycleStart::drawn}) {
      if (auto cycle = find_cycle(start)) return cycle;
      if (flow_.spent() || flow_.cancelled()) break;
    }
    return {};
  }

  std::optional<Candidate> find_cycle(CycleStart start, const std::optional<UnstableState>& around = {}) {
    CycleOutcome began =
        guess_cycle(flow_, flow_.model().mechanism, start, options_.cancel, options_.progress, around);
    cycle_trouble_ = began.trouble;
    around_stable_ = began.guess && !began.guess->state;
    if (!began.guess) return {};
    ShootingOptions how;
    how.period = began.guess->period;
    how.find_period = true;
    how.rate = 2 * std::numbers::pi / how.period;
    how.alike = began.guess->alike;
    // The iteration may fall into the steady state, which comes back after any time: then from further away.
    for (double part = 1; part <= furthest; part *= 1.4) {
      auto cycle = complete({at_distance(*began.guess, part, how)}, how, 0);
      if (cycle && !stands(*cycle)) return cycle;
      if (cycle && start == CycleStart::drawn)
        cycle_trouble_ = settled_message(flow_, start, cycle->orbit.nodes.front().base(), how.rate);
      if (!began.guess->steady || flow_.spent() || flow_.cancelled()) break;
    }
    return {};
  }

  // The guess `part` times as far from the steady state.
  FlowState at_distance(const CycleGuess& guess, double part, const ShootingOptions& how) const {
    if (!guess.steady) return *guess.state;
    const StateChart chart(flow_.problem(), *guess.steady, how.rate, how.alike);
    return chart.displaced(guess.state ? Eigen::VectorXd(part * chart.coordinates(*guess.state))
                                       : Eigen::VectorXd(part * least_swing * guess.swing));
  }

  // The steady state, which comes back after any time.
  bool stands(const Candidate& c) {
    const std::vector<FlowState> trace =
        flow_.trace(c.orbit.nodes.front().base(), c.orbit.period, 8, settling);
    return trace.empty() || is_steady(flow_, trace, 2 * std::numbers::pi / c.orbit.period);
  }

  std::optional<Candidate> attempt(const std::vector<FlowState>& guess, int periods) {
    ShootingOptions how;
    how.period = drives_.period * periods;
    how.rate = rate();
    how.alike = alike_;
    return complete(guess, how, periods);
  }

  std::optional<Candidate> complete(const std::vector<FlowState>& guess, const ShootingOptions& how,
                                    int periods) {
    Candidate c;
    c.periods = periods;
    c.how = how;
    if (!flow_.pass(guess.front(), c.how.period / 16, settling)) { // finds the method
      end_ = end_of(flow_);
      return {};
    }
    c.how.tolerance = tolerance_of(flow_);
    report_progress(options_.progress, "closing a period");
    c.orbit = shoot(flow_, guess, c.how);
    end_ = c.orbit.end;
    if (end_ == ShootingEnd::pumped) {
      if (grows_on(c.orbit.nodes.front().base()))
        pulled_along_ = pulled_along(c.orbit.nodes.front().base());
      else
        end_ = ShootingEnd::diverged;
    }
    if (c.orbit.end != ShootingEnd::converged) return {};
    report_progress(options_.progress, "motions beside it");
    auto beside = monodromy(flow_, c.orbit, c.how);
    // Where much grows within a segment, differences tell nothing: shorter ones keep the digits.
    for (const int segments : {4, 16, 64})
      if (beside && grows_too_much(*beside, static_cast<int>(c.orbit.nodes.size())) &&
          segments > static_cast<int>(guess.size()))
        divide(c, segments, beside);
    if (!beside) {
      end_ = end_of(flow_);
      return {};
    }
    c.beside = std::move(*beside);
    if (periods == 0) leave_out_phase(c);
    c.stable = verdict(c);
    return c;
  }

  std::optional<bool> verdict(const Candidate& c) const {
    const auto& [matrix, multipliers, error] = c.beside;
    if (multipliers.empty()) return true;
    // Inexact ones, as of motions that pass singular positions, tell little.
    if (error > 1e-3 && std::abs(multipliers.front()) < 1 + 10 * error) return {};
    return stable_by_multipliers(multipliers, error, c.orbit.neutral,
                                 is_hamiltonian(flow_.model().system, flow_.model().parameters));
  }

  // A motion that nothing times may be anywhere along itself: that is no growth, and its multiplier 1 tells
  // about how well the others are known.
  static void leave_out_phase(Candidate& c) {
    auto& multipliers = c.beside.multipliers;
    const auto phase =
        std::ranges::min_element(multipliers, {}, [](const auto& mu) { return std::abs(mu - 1.); });
    if (phase == multipliers.end()) return;
    c.beside.error = std::max(c.beside.error, std::abs(*phase - 1.));
    multipliers.erase(phase);
  }

  static bool grows_too_much(const Monodromy& beside, int segments) {
    if (beside.multipliers.empty()) return false;
    const double size = std::abs(beside.multipliers.front());
    return size > std::pow(strong_growth, segments) || beside.error > inexact * std::max(1., size);
  }

  // The same orbit in more segments.
  void divide(Candidate& c, int segments, std::optional<Monodromy>& beside) {
    c.how.period = c.orbit.period;
    std::vector<FlowState> states{c.orbit.nodes.front().base()};
    for (int i = 1; i < segments; ++i) {
      const auto passage = flow_.pass(states.back(), c.how.period / segments, c.how.tolerance);
      if (!passage) return;
      states.push_back(passage->to);
    }
    Orbit divided = shoot(flow_, states, c.how);
    if (divided.end != ShootingEnd::converged) return;
    auto better = monodromy(flow_, divided, c.how);
    if (!better) return;
    c.orbit = std::move(divided);
    beside = std::move(better);
  }

  // As drawn at every phase.
  std::vector<FlowState> frozen(const FlowState& start) {
    std::vector<FlowState> out{start};
    for (int i = 1; i < frozen_segments; ++i) {
      const auto next = flow_.carried(out.back(), drives_.period * i / frozen_segments);
      if (!next) return {};
      out.push_back(*next);
    }
    return out;
  }

  // Off an unstable one, the way it is left.
  FlowState pushed_off(const Candidate& c) {
    const auto modes = eigenvectors(c.beside.matrix);
    const StateChart& node = c.orbit.nodes.front();
    if (!modes) return node.base();
    Eigen::Index worst = 0;
    modes->values.cwiseAbs().maxCoeff(&worst);
    Eigen::VectorXd way = modes->vectors.col(worst).real();
    if (way.norm() < 0.1) way = modes->vectors.col(worst).imag();
    return node.displaced(push_off * way / std::max(way.lpNorm<Eigen::Infinity>(), 1e-300));
  }

  struct Settling {
    std::optional<FlowState> state;
    int periods = 1; // after so many of the drives it is nearly where it was
  };
  // Where a motion comes to, period by period.
  Settling settle(FlowState state) {
    report_progress(options_.progress, following_phase);
    std::vector<FlowState> past{state};
    int best = 1; // of the last periods, after so many it was nearest to where it had been
    for (int k = 1; k <= settling_periods; ++k) {
      const auto passage = flow_.pass(past.back(), drives_.period, settling);
      if (!passage) return {};
      FlowState now = passage->to;
      now.time = state.time;
      const StateChart here(flow_.problem(), now, rate(), alike_);
      double nearest = std::numeric_limits<double>::infinity();
      for (int p = 1; p <= std::min(k, longest_multiple); ++p) {
        const double away = here.distance(past[past.size() - static_cast<std::size_t>(p)]);
        if (away < settled) return {std::move(now), p};
        if (away < 0.5 * nearest) {
          nearest = away;
          best = p;
        }
      }
      past.push_back(std::move(now));
    }
    return {past.back(), best};
  }

  // Whether a motion gets faster and faster, as linear theory says of what is pushed in step and nothing
  // damps; what turns by a torque beside the drives leaves gaps, too, and settles.
  bool grows_on(const FlowState& start) {
    double before = 0;
    FlowState state = start;
    for (const int periods : {pulling_periods / 4, pulling_periods / 4, pulling_periods / 2}) {
      const auto passage = flow_.pass(state, periods * drives_.period, settling);
      if (!passage) return false;
      state = passage->to;
      const double now =
          (state.u - start.u).cwiseQuotient(flow_.model().scaling.column).lpNorm<Eigen::Infinity>();
      if (now <= pumping * before) return false;
      before = now;
    }
    return true;
  }

  // The coordinate on which something pulls on and on, so that the motion gains speed alike at every phase of
  // the drives; empty where what grows swings, and gains the opposite half a swing later.
  std::string pulled_along(const FlowState& start) {
    const auto gain = [&](double phase) -> std::optional<Eigen::VectorXd> {
      const auto from = flow_.pass(start, phase * drives_.period, settling),
                 to = from ? flow_.pass(from->to, pulling_periods * drives_.period, settling) : std::nullopt;
      if (!to) return {};
      return (to->to.u - to->from.u).cwiseQuotient(flow_.model().scaling.column);
    };
    const auto first = gain(1);
    if (!first) return {};
    for (const double part : {0.5, 0.25, 0.125}) // a half of a swing once, twice, ... a period
      if (const auto other = gain(1 + part); !other || (*other - *first).norm() > 0.3 * first->norm())
        return {};
    Eigen::Index most = 0;
    first->cwiseAbs().maxCoeff(&most);
    const System& system = flow_.model().system;
    for (const CoordinateInfo& c : system.coordinates) {
      const Link& link = system.links[static_cast<std::size_t>(c.link)];
      const int count = link.type == LinkType::spherical ? 3 : 1;
      if (link.v < 0 || most < link.v || most >= link.v + count) continue;
      const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
      return count > 1 ? joint.name : coordinate_label(joint, c.index);
    }
    return {};
  }

  void refuse_cycle(PeriodicState& out) const {
    if (flow_.cancelled())
      out.message = "Looking for a limit cycle was cancelled.";
    else if (flow_.spent())
      out.message = "No limit cycle was found within " + std::to_string(flow_.most_evaluations()) +
                    " evaluations of the equations of motion.";
    else if (!cycle_trouble_.empty())
      out.message = "No limit cycle was found. " + cycle_trouble_;
    else
      out.message = "No limit cycle was found: the iteration did not converge from where the motion nearly "
                    "repeats itself.";
  }

  void refuse(PeriodicState& out) const {
    if (of_its_own()) return refuse_cycle(out);
    const std::string period = rounded_text(drives_.period, 6) + " s";
    switch (flow_.spent() ? ShootingEnd::spent : end_) {
    case ShootingEnd::pumped:
      out.status = PeriodicStatus::not_periodic;
      if (!pulled_along_.empty()) {
        out.message = "No periodic motion either: something pulls on and on along " + pulled_along_ +
                      ", which nothing holds or damps, and the motion there gains speed without end.";
        return;
      }
      out.message = "No periodic motion either: the drives push in step with a motion that nothing damps or "
                    "holds, and it grows without end. Some damping, or another speed, gives it an end.";
      return;
    case ShootingEnd::no_motion:
      out.message = "No periodic motion was found: the motion does not last a period of " + period + ": " +
                    flow_.trouble();
      break;
    case ShootingEnd::spent:
      out.message = "No periodic motion was found within " + std::to_string(flow_.most_evaluations()) +
                    " evaluations of the equations of motion; the period is " + period + ".";
      break;
    case ShootingEnd::cancelled: out.message = "Looking for a periodic motion was cancelled."; break;
    case ShootingEnd::converged:
    case ShootingEnd::diverged:
      out.message = "No periodic motion with the period of the drives, " + period +
                    ", was found from the drawn pose, nor from where a motion from there came in " +
                    std::to_string(settling_periods) + " periods.";
    }
    if (out.message.back() != '.') out.message += ".";
  }

  void tell(const Candidate& c, PeriodicState& out) {
    out.period = c.orbit.period;
    out.drive_periods = c.periods;
    out.residual = c.orbit.residual;
    out.iterations = c.orbit.iterations;
    out.history = c.orbit.history;
    out.segments = static_cast<int>(c.orbit.nodes.size());
    out.stable = c.stable;
    out.stability_reason =
        c.orbit.neutral > 0 && c.stable != false ? StabilityReason::neutral : StabilityReason::floquet;
    out.floquet.period = c.orbit.period;
    out.floquet.multipliers = c.beside.multipliers;
    out.floquet.error = c.beside.error;
    for (const auto& mu : out.floquet.multipliers)
      if (std::abs(mu) > 1e-9 * std::abs(out.floquet.multipliers.front()))
        out.floquet.growth.push_back(std::log(std::abs(mu)) / c.orbit.period);
    const FlowState& start = c.orbit.nodes.front().base();
    out.start = name_state(flow_.model(), 0, start.q, start.u);
    report_progress(options_.progress, "ranges over a period");
    if (!measure_orbit(flow_, c.orbit, c.how, rate(), out)) {
      out.message = "A periodic motion was found, but not what it measures: " + flow_.trouble();
      return;
    }
    if (out.motion->statistics.singular_positions > 0 &&
        c.beside.error > inexact) { // differences do not agree
      out.stable.reset();
      out.stability_reason.reset();
      out.floquet.multipliers.clear();
      out.floquet.growth.clear();
      out.floquet.error = std::numeric_limits<double>::quiet_NaN();
    }
    out.evaluations = flow_.evaluations();
    out.status = PeriodicStatus::found;
    out.message =
        words(c, out, c.periods > 0 && !c.beside.multipliers.empty() && stands(c) && torques_stand(out));
  }

  // Where little moves, as of a disc that turns fast about its diameter, what drives give may swing all the
  // same.
  bool torques_stand(const PeriodicState& out) const {
    constexpr double noise = 1e-3; // of the largest that a joint bears
    const double reach = flow_.model().parameters.length;
    double largest = 0; // N
    for (const PeriodicReaction& r : out.reactions)
      largest = std::max({largest, r.force.size.most, r.torque.size.most / reach});
    return std::ranges::all_of(out.drive_torques, [&](const PeriodicTorque& drive) {
      return !(drive.range.most - drive.range.least > noise * largest * (drive.angle ? reach : 1));
    });
  }

  // `stands`: a steady state, though a motion was looked for.
  std::string words(const Candidate& c, const PeriodicState& out, bool stands) const {
    const bool cycle = c.periods == 0;
    std::string text =
        cycle && around_stable_ ? "Around its stable steady state lies a limit cycle, with a period of "
        : cycle                 ? "It moves in a limit cycle, with a period of its own of "
        : stands ? "What was found is a steady state, which comes back after any time as after "
                   "the period of the drives, "
                 : "It moves periodically with the drives, with a period of ";
    text += rounded_text(out.period, 6) + " s";
    if (c.periods > 1) text += ", " + std::to_string(c.periods) + " times that of the drives";
    text += ".";
    if (c.beside.multipliers.empty())
      text += cycle ? "" : " Nothing moves freely: the drives prescribe all of it.";
    else if (out.floquet.multipliers.empty())
      text +=
          " It passes positions in which linkages could part into branches: what is beside it is not known "
          "there, nor whether it is stable.";
    else if (out.stable == false)
      text += " It is unstable: " + way_out(out.floquet.multipliers.front());
    else if (c.orbit.neutral > 0)
      text += " Nothing resists some direction, so that others lie beside it.";
    else if (!out.stable)
      text += " Whether it is stable is too close to tell.";
    else if (std::abs(c.beside.multipliers.front()) > 1 - 1e-7 - 10 * c.beside.error)
      text += " Motions beside it neither grow nor die out.";
    else
      text += " It is stable: motions beside it die out.";
    if (out.motion->statistics.singular_positions > 0 && !out.floquet.multipliers.empty())
      text +=
          " It passes positions in which linkages could part into branches, and is taken to go straight on.";
    if (left_first_)
      text += " The one nearest to the drawn pose is unstable; a motion that leaves it comes to this one.";
    return text;
  }

  static std::string way_out(std::complex<double> mu) {
    const std::string size = rounded_text(std::abs(mu), 6);
    if (std::abs(mu.imag()) > 1e-6 * std::abs(mu))
      return "swings beside it, with a period of their own, grow " + size + " times in each of its own.";
    if (mu.real() < 0)
      return "a motion beside it leaves to either side in turn, " + size + " times as far after each period.";
    return "a motion beside it leaves, " + size + " times as far after each period.";
  }

  const PeriodicOptions& options_;
  Flow flow_;
  DrivePeriod drives_;
  AlikeAngles alike_;                       // angles that need not return
  ShootingEnd end_ = ShootingEnd::diverged; // of the last attempt
  bool left_first_ = false;
  bool untimed_ = false;       // nothing depends on where the drives stand
  bool around_stable_ = false; // a limit cycle was looked for around a stable steady state
  std::string pulled_along_;   // the coordinate; empty where the drives pump up what swings
  std::string cycle_trouble_;  // why there is none: a sentence
};

} // namespace

std::string_view word(PeriodicStatus status) {
  switch (status) {
  case PeriodicStatus::found: return "found";
  case PeriodicStatus::not_found: return "not_found";
  case PeriodicStatus::not_periodic: return "not_periodic";
  }
  return "";
}

PeriodicState find_periodic_state(const Mechanism& mechanism, const PeriodicOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  PeriodicState out;
  try {
    const Interruptible scope(options.cancel);
    out = Search(mechanism, options).run();
  } catch (const Interrupted&) {
    out = {};
    out.message = "Looking for a periodic motion was cancelled.";
  }
  out.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

} // namespace flyball
