#include "engine/dynamics/simulator_state.hpp"

#include "engine/dynamics/choose_method.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {
namespace {

const std::string locked = "the loops have come to a position that they cannot pass";

std::string at_time(double t) {
  return "at t = " + rounded_text(t, 10) + " s";
}

} // namespace

bool Simulator::State::step_to(double t) {
  while (stepped_to < t) {
    if (interrupt()) return false;
    if (torn) { // it begins anew from where it was well last
      y = whole;
      start_stepper(stepped_to);
    }
    if (!finish_step()) return false;
    if (stepped_to >= t) break; // over a singular position
    if (++pace.taken > options.max_steps)
      return diverge(stepped_to, "more than " + std::to_string(options.max_steps) + " steps were needed");
    if (pace.is_hopeless(stepped_to, std::max(t, begin + options.duration)))
      return diverge(stepped_to, "it would need more than " + rounded_text(pace.given_up_at(), 2) + " steps" +
                                     pace.text(stepped_to, fastest));
    if (pace.taken >= review_at) review_method();
    stepper->state_at(stepped_to, whole);
    began = stepped_to;
    const double end = before_singular > began ? std::min(t, before_singular) : t;
    const StepOutcome outcome = stepper->step(end);
    if (outcome.kind == StepOutcome::failed) {
      torn = interrupt();
      // Friction may turn round just there, or the step was to end on a singular position of the loops,
      // which shows in what was evaluated last.
      const bool singular = equations->independence() < 0.01 * best_independence;
      if (!torn && (free || singular) && take_back(end)) continue;
      return torn ? false : diverge(outcome.time, reason_of(outcome));
    }
    if (equations->independence() < 1e-9 * best_independence && take_back(outcome.time)) continue;
    stepped_to = outcome.time;
    pending = outcome;
  }
  return true;
}

void Simulator::State::review_method() {
  review_at = 2 * pace.taken;
  if (method != Integrator::runge_kutta || options.method != Integrator::automatic || options.fixed_step > 0)
    return;
  const double rest = begin + options.duration - stepped_to;
  stepper->state_at(stepped_to, y);
  ode->unpack(y.data(), q, s);
  if (!(rest > 0) || !equations->evaluate(stepped_to, q, s)) return;
  const MethodChoice choice =
      choose_method(*equations, stepped_to, q, s, rest, options.tolerance, Integrator::automatic);
  if (choice.method == method) return;
  fastest = choice.fastest;
  run.notes.push_back("From t = " + rounded_text(stepped_to, 4) + " s on: " + choice.reason);
  run.method_reason += " From t = " + rounded_text(stepped_to, 4) + " s on " + choice.reason;
  stepper->count(run.statistics);
  use_method(choice.method);
  start_stepper(stepped_to);
}

std::string Simulator::State::reason_of(const StepOutcome& failure) {
  stepper->state_at(failure.time, y);
  if (const std::string what = runaway(); !what.empty()) return what;
  ode->unpack(y.data(), q, s);
  if (equations->project(failure.time, q, s) && equations->evaluate(failure.time, q, s))
    if (const std::string what = equations->trouble(); !what.empty()) return what;
  return equations->independence() < 0.01 * best_independence ? locked : failure.message;
}

bool Simulator::State::settle(double t, double* shift) {
  if (bridge && t < started_at) { // by the cubic with these ends
    const double span = started_at - bridge->time, x = (t - bridge->time) / span;
    y = bridge->y + x * x * (3 - 2 * x) * (bridge->end - bridge->y) +
        span * x * (1 - x) * ((1 - x) * bridge->rate - x * bridge->end_rate);
  } else {
    stepper->state_at(t, y);
  }
  ode->unpack(y.data(), q, s);
  return equations->project(t, q, s, shift) && equations->evaluate(t, q, s);
}

bool Simulator::State::record(double t) {
  double shift = 0;
  if (!settle(t, &shift)) {
    // Right on a singular position the equations leave forces open: the sample is that of a little later.
    if (!bridge || t >= started_at) return diverge(t, "the equations of motion have no solution there");
    t = std::min(t + 1e-3 * (started_at - bridge->time), started_at);
    if (!settle(t, &shift)) return diverge(t, "the equations of motion have no solution there");
  }
  recorder->record(t, ode->energies(y), shift);
  if (options.progress) options.progress(t);
  return true;
}

bool Simulator::State::interrupt() {
  if (!watch.over()) return false;
  const std::string where =
      run.time.empty() ? std::string("before the motion began") : at_time(run.time.back());
  const bool late = watch.out_of_time();
  run.status = late ? RunStatus::time_limit : RunStatus::cancelled;
  run.message = late ? "The motion stopped " + where + ": the time limit of " +
                           rounded_text(options.time_limit, 4) + " s was reached" +
                           pace.text(stepped_to, fastest) + "."
                     : "Cancelled " + where + ".";
  return true;
}

bool Simulator::State::diverge(double t, const std::string& why) {
  if (interrupt()) return false;
  run.status = RunStatus::diverged;
  run.message = "The motion stopped " + at_time(t) + ": " + why + ".";
  return false;
}

std::string Simulator::State::runaway() const {
  const std::string out = runaway_coordinate(*model, y, rate_scale);
  return !out.empty() && equations->independence() < 1e-3 * best_independence ? locked : out;
}

} // namespace flyball
