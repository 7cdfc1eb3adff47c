#include "engine/dynamics/simulator_state.hpp"

#include "engine/dynamics/singular_position.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <utility>

namespace flyball {

void Simulator::State::handle_event(const StepOutcome& outcome) {
  const double t = outcome.time;
  if (!settle(t, nullptr)) return; // the next step says what is wrong
  const Eigen::VectorXd u = equations->velocity().head(model->system.nv);
  bool changed = false, frictions_change = false;
  std::vector<int> flipped; // links
  for (int e : outcome.events) {
    const auto i = static_cast<std::size_t>(e);
    if (i < stops.size()) continue;
    if (i >= stops.size() + flips.size()) {
      frictions_change = true;
      continue;
    }
    // A rotation vector turned over, and with it the forces of its springs.
    FlipElement& flip = flips[i - stops.size()];
    flipped.push_back(flip.link);
    const bool side = flip_rate(*model, flip, q, u) > 0;
    if (side == flip.side) continue;
    const bool beyond = (joint_rotation(*model, flip, q).w() >= 0) == side; // as log_rotation takes it
    recorder->absorb((beyond ? 1 : -1) * flip_energy(*model, flip, q));
    flip.side = side;
    changed = true;
    for (std::size_t k = 0; k < stops.size(); ++k) { // as the vector now says
      if (stops[k].link != flip.link) continue;
      const double value = (value_at_stop(*model, stops[k], q) + stops[k].limit) * (beyond ? 1 : -1);
      touching[k] = stops[k].upper ? value > stops[k].limit : value < stops[k].limit;
    }
  }
  for (int e : outcome.events) {
    const auto i = static_cast<std::size_t>(e);
    if (i >= stops.size() || std::ranges::find(flipped, stops[i].link) != flipped.end()) continue;
    const StopElement& stop = stops[i];
    const double rate = rate_at_stop(*model, stop, q, u);
    const bool touches = stop.upper ? rate > 0 : rate < 0;
    if (touches == touching[i]) continue;
    set_stop(i, touches, t);
    changed = true;
  }
  if (!changed && !frictions_change) return;
  equations->latch(stops, touching, flips);
  ode->set_touching(touching);
  if (frictions_change) return change_frictions(t, u);
  ode->pack(q, s, ode->energies(y), y);
  start_stepper(t);
}

void Simulator::State::set_stop(std::size_t i, bool touches, double t) {
  touching[i] = touches;
  run.stops.push_back({t, "", 0, stops[i].upper, touches});
  recorder->name(stops[i], run.stops.back());
}

bool Simulator::State::find_missed_stops(double t) {
  bool missed = false;
  ode->unpack(y.data(), q, s);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const Link& link = model->system.links[static_cast<std::size_t>(stops[i].link)];
    const double slack = 1e-9 * model->scaling.column[link.v];
    const double beyond = (stops[i].upper ? 1 : -1) * value_at_stop(*model, stops[i], q);
    if (touching[i] ? beyond >= -slack : beyond <= slack) continue;
    set_stop(i, !touching[i], t);
    missed = true;
  }
  return missed;
}

bool Simulator::State::comes_to_singular_position(const StepOutcome& outcome) {
  const auto first = static_cast<int>(stops.size() + flips.size());
  if (std::ranges::none_of(outcome.events, [&](int e) { return e >= first; })) return false;
  if (settle(outcome.time, nullptr) && equations->independence() >= 0.01 * best_independence) return false;
  return take_back(outcome.time);
}

bool Simulator::State::take_back(double end) {
  constexpr int most = 200;
  if (halvings >= most) return false;
  ++halvings;
  y = whole;
  start_stepper(began);
  before_singular = began + (end - began) / 2;
  return true;
}

bool Simulator::State::check_step(double t) {
  if (const std::string what = runaway(); !what.empty()) return diverge(t, what);
  if (const std::string what = bearing_turns.turned_over(*model, equations->kinematics()); !what.empty())
    return diverge(t, what);
  if (!stops.empty() && find_missed_stops(t)) {
    equations->latch(stops, touching, flips);
    ode->set_touching(touching);
    start_stepper(t);
    return true;
  }
  if (has_left_dead_point(y)) {
    ode->unpack(y.data(), q, s);
    if (!equations->project(t, q, s) || !equations->evaluate(t, q, s))
      return diverge(t, "the equations of motion have no solution there");
    change_frictions(t, equations->velocity().head(model->system.nv));
    return true;
  }
  const double independence = equations->independence();
  best_independence = std::max(best_independence, independence);
  if (independence < 0.01 * best_independence) {
    ode->unpack(y.data(), q, s);
    if (const auto across = leap(*equations, t, q, s, best_independence, rate_scale)) {
      bridge = Bridge{t, y, Eigen::VectorXd(y.size()), {}, Eigen::VectorXd(y.size())};
      ode->rate(t, y.data(), bridge->rate.data());
      ode->pack(across->q, across->s, ode->energies(y) + across->energies, y);
      ode->rate(across->time, y.data(), bridge->end_rate.data());
      bridge->end = y;
      ++run.statistics.singular_positions;
      halvings = 0;
      start_stepper(across->time);
      if (some_slip_has_turned(across->s)) {
        q = across->q;
        if (!equations->evaluate(across->time, q, across->s))
          return diverge(across->time, "the equations of motion have no solution there");
        change_frictions(across->time, equations->velocity().head(model->system.nv), Turned::passed);
      }
      return true;
    }
  }
  // The last evaluation was near; only what it finds amiss is looked at closely.
  const bool changed = equations->structure_changed();
  if (!changed && equations->trouble().empty()) return true;
  ode->unpack(y.data(), q, s);
  if (!equations->project(t, q, s) || !equations->evaluate(t, q, s))
    return diverge(t, "the equations of motion have no solution there");
  if (const std::string what = equations->trouble(); !what.empty()) return diverge(t, what);
  if (!changed) return true;
  const Eigen::VectorXd u = equations->velocity().head(model->system.nv);
  try {
    if (!equations->analyse(t, q, u)) return true;
  } catch (const SceneError& error) {
    return diverge(t, error.what());
  }
  if (!equations->reduce(t, q, u, s))
    return diverge(t, "the equations of motion have no solution there: " + equations->unsolved());
  ode->pack(q, s, ode->energies(y), y);
  start_stepper(t);
  return true;
}

bool Simulator::State::finish_step() {
  if (!pending) return true;
  const StepOutcome outcome = *std::exchange(pending, {});
  stepper->state_at(outcome.time, y);
  try {
    if (outcome.kind != StepOutcome::event) return check_step(outcome.time);
    if (!comes_to_singular_position(outcome)) handle_event(outcome);
  } catch (const SceneError& error) {
    return diverge(outcome.time, error.what());
  }
  return true;
}

} // namespace flyball
