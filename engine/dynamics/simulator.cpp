#include "engine/dynamics/simulator.hpp"

#include "engine/dynamics/choose_method.hpp"
#include "engine/dynamics/friction_modes.hpp"
#include "engine/dynamics/motion_ode.hpp"
#include "engine/dynamics/pace.hpp"
#include "engine/dynamics/recorder.hpp"
#include "engine/dynamics/runaway.hpp"
#include "engine/dynamics/singular_position.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/dynamics/watch.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/messages.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace flyball {
namespace {

// Explicit steps after which the choice of a method is thought over for the first time.
constexpr long first_review = 500;

// A coordinate with friction stands still where its rate is this part of a usual one.
constexpr double still = 1e-9;

const std::string locked = "the loops have come to a position that they cannot pass";

std::string at_time(double t) {
  return "at t = " + rounded_text(t, 10) + " s";
}

} // namespace

struct Simulator::State {
  State(const SimulationOptions& wanted)
      : options(wanted), damped(wanted.damped), watch(wanted.cancel), pace(wanted.max_steps) {}

  SimulationOptions options;
  bool damped = true;
  Watch watch;
  Pace pace;
  std::shared_ptr<const MotionModel> model;
  std::unique_ptr<Equations> equations;
  std::unique_ptr<MotionOde> ode;
  std::unique_ptr<Stepper> stepper;
  std::vector<StopElement> stops;
  std::vector<bool> touching; // by stop
  std::vector<FlipElement> flips;
  BearingTurns bearing_turns;
  std::shared_ptr<const MotionModel> free; // without what friction adds; null where there is none
  std::vector<FrictionElement> frictions;
  std::vector<int> slips;             // by friction, see with_modes()
  std::vector<std::size_t> undecided; // frictions at dead points that nothing moves
  std::vector<FrictionHold> holds;
  double rate_scale = 1, energy_scale = 1;
  double fastest = 0; // 1/s, of the linearised motion where the method was chosen; 0: not known
  Integrator method = Integrator::automatic;

  Run run;
  std::unique_ptr<Recorder> recorder;
  double begin = 0, stepped_to = 0;   // s; where the integrator stands
  long next_sample = 0;               // on the grid, from `begin`
  std::optional<StepOutcome> pending; // the last step's, to be looked at
  double best_independence = 0, started_at = 0;
  bool torn = false; // the last step was given up within
  // The way over a singular position, for samples that fall on it.
  struct Bridge {
    double time;
    Eigen::VectorXd y, rate, end, end_rate;
  };
  std::optional<Bridge> bridge;
  Eigen::VectorXd y, q, s;

  void open(MotionModel compiled, const SimulationOptions& how) {
    auto made = std::make_shared<MotionModel>(std::move(compiled));
    Eigen::VectorXd u;
    find_start(how, *made, q, u);
    take(std::move(made));
    begin_motion(how.start == Start::state ? how.state.time : 0, u, Eigen::Vector3d::Zero());
  }

  // A model with all of its friction slipping nowhere, which gives nothing.
  void take(std::shared_ptr<MotionModel> made) {
    frictions = list_frictions(*made);
    for (const FrictionElement& friction : frictions)
      made->parameters.links[static_cast<std::size_t>(friction.link)].force.hold(0).friction = 0;
    model = std::move(made);
    free = frictions.empty() ? nullptr : model;
  }

  // From q and a velocity u that keep the loops closed.
  void begin_motion(double t, const Eigen::VectorXd& u, const Eigen::Vector3d& energies) {
    stepper.reset();
    pending.reset();
    bridge.reset();
    torn = false;
    equations = std::make_unique<Equations>(*model, watch);
    stops = list_stops(model->system, model->parameters);
    touching.assign(stops.size(), false);
    bearing_turns.forget();
    flips = list_flips(model->system, model->parameters);
    const Eigen::VectorXd asked = q;
    restructure(t, u);
    if (!equations->evaluate(t, q, s))
      throw SceneError("", "the equations of motion have no solution at the start: " + equations->unsolved());
    energy_scale = equations->energy_scale();
    MethodChoice choice =
        choose_method(*equations, t, q, s, options.duration, options.tolerance, options.method);
    rate_scale = choice.rate_scale;
    fastest = choice.fastest;
    if (options.fixed_step > 0) choice = {Integrator::runge_kutta, "Steps of a fixed size."};
    run.method_reason = choice.reason;
    stepped_to = t;
    slips.clear();
    if (free) { // which may hold what has no mass where it is, and without friction went to its balance
      q = asked;
      settle_frictions(t, u);
    }
    use_method(choice.method);
    ode->pack(q, s, energies, y);
    start_stepper(t);
  }

  // Which joints with friction stick and which way others slip, from q and u on: those that stand still
  // stick, unless that takes more than their limits. The one that it takes most of gives way, with what loops
  // tie to it, again and again. Leaves model, equations and s. What has turned back has come to a stop, or
  // else has passed a dead point on the way.
  enum class Turned { stopped, passed };
  void settle_frictions(double t, Eigen::VectorXd u, Turned turned_back = Turned::stopped) {
    best_independence = 0;
    const Eigen::VectorXd coming = u;
    const std::vector<int> before = std::exchange(slips, std::vector<int>(frictions.size(), 0));
    for (std::size_t i = 0; i < frictions.size(); ++i) {
      const int v = v_of(frictions[i]);
      const double usual = model->scaling.column[v] * rate_scale;
      const bool turned = turned_back == Turned::stopped && !before.empty() && before[i] * u[v] < 0;
      if (std::abs(u[v]) > still * usual && !turned)
        slips[i] = u[v] > 0 ? 1 : -1;
      else
        u[v] = 0;
    }
    for (std::size_t tries = 0; tries <= 3 * frictions.size(); ++tries) {
      FrictionModes modes = with_modes(*free, frictions, slips, q, coming, rate_scale);
      undecided = std::move(modes.at_dead_points);
      equations.reset();
      model = std::move(modes.model);
      holds = std::move(modes.holds);
      equations = std::make_unique<Equations>(*model, watch);
      restructure(t, u);
      if (!equations->evaluate(t, q, s))
        throw SceneError("", "the equations of motion have no solution where friction sticks: " +
                                 equations->unsolved());
      if (leave_dead_points(t)) continue;
      const FrictionHold* worst = nullptr;
      double most = slipping_by;
      for (const FrictionHold& hold : holds) {
        const double force = force_of(hold);
        const double part = force > 0 ? force / hold.most : force < 0 ? force / hold.least : 0;
        if (part > most || std::isinf(part)) {
          most = part;
          worst = &hold;
        }
      }
      if (!worst) break;
      const int way = force_of(*worst) > 0 ? -1 : 1;
      slips[worst->element] = way;
      for (const FrictionHold::Tied& tied : worst->tied)
        slips[tied.element] = tied.rate > 0 ? way : -way;
    }
    for (std::size_t i = 0; i < frictions.size() && !before.empty(); ++i)
      if (slips[i] != before[i]) {
        run.frictions.push_back({t, "", 0, slips[i]});
        recorder->name(frictions[i], run.frictions.back());
      }
    if (recorder) recorder->follow(model, *equations);
  }

  // Which way coordinates go on from dead points, where their friction does nothing: as they bend away from
  // there, with the rates of the evaluated state or, where these do not move them, with what they become by
  // its accelerations. True where one is found.
  bool leave_dead_points(double t) {
    if (undecided.empty()) return false;
    // Of the largest acceleration, which moves what is as good as at a dead point by less; of a usual rate.
    constexpr double seen = 2e-6, later = 0.05;
    const Eigen::VectorXd& column = model->scaling.column;
    const auto size = [&](const Eigen::VectorXd& x) {
      return x.cwiseQuotient(column).lpNorm<Eigen::Infinity>();
    };
    bool found = false;
    const auto look = [&] {
      const Eigen::VectorXd& bends = equations->acceleration();
      const double least = seen * size(bends);
      for (const std::size_t i : undecided)
        if (const int v = v_of(frictions[i]); slips[i] == 0 && std::abs(bends[v]) / column[v] > least) {
          slips[i] = bends[v] > 0 ? 1 : -1;
          found = true;
        }
    };
    look();
    const double most = size(equations->acceleration());
    if (found || !(most > 0)) return found;
    Eigen::VectorXd at = q, along = s + later * std::max(rate_scale, std::sqrt(most)) / most *
                                            equations->acceleration();
    if (equations->project(t, at, along) && equations->evaluate(t, at, along)) look();
    return found || !equations->evaluate(t, q, s);
  }
  bool has_left_dead_point(const Eigen::VectorXd& state) const {
    return std::ranges::any_of(undecided, [&](std::size_t i) {
      const int v = v_of(frictions[i]);
      return std::abs(state[model->system.nq + v]) > still * model->scaling.column[v] * rate_scale;
    });
  }

  int v_of(const FrictionElement& friction) const {
    return model->system.links[static_cast<std::size_t>(friction.link)].v;
  }
  // N m or N, of friction on the coordinate that is held, at the evaluated state.
  double force_of(const FrictionHold& hold) const { return -equations->multipliers()[hold.row]; }

  void use_method(Integrator chosen) {
    run.method = method = chosen;
    ode = std::make_unique<MotionOde>(*equations, watch, options.tolerance, rate_scale, energy_scale);
    ode->set_events(stops, flips);
    if (free) ode->set_frictions(frictions, slips, holds);
    ode->set_touching(touching);
    ode->set_inner_projection(method == Integrator::adams && equations->needs_projection());
    stepper = method == Integrator::runge_kutta ? make_runge_kutta_stepper(*ode, options.fixed_step)
                                                : make_cvode_stepper(*ode, method);
    review_at = pace.taken + first_review;
    pace.judge_from(stepped_to);
  }

  void start_stepper(double t) {
    stepper->start(t, y);
    stepped_to = started_at = t;
    torn = false;
    ++run.statistics.restarts;
  }

  // Stops by where q stands and goes; then independent rows and idle coordinates. Leaves s.
  void restructure(double t, const Eigen::VectorXd& u) {
    for (FlipElement& flip : flips)
      flip.side = joint_rotation(*model, flip, q).w() >= 0;
    // What stands in balance may come upon a stop on the way there.
    equations->latch({}, {}, flips);
    equations->analyse(t, q, u);
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const double value = value_at_stop(*model, stops[i], q);
      touching[i] = stops[i].upper ? value > 0 : value < 0;
    }
    equations->latch(stops, touching, flips);
    if (equations->has_massless()) equations->analyse(t, q, u);
    if (!equations->reduce(t, q, u, s))
      throw SceneError("", "the equations of motion have no solution there: " + equations->unsolved());
    if (equations->needs_projection()) equations->project(t, q, s);
  }

  // The state at t within the last step, on the manifold and evaluated. False where it cannot be.
  bool settle(double t, double* shift) {
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

  // Where nobody wants it any more, or its time is over, that is why it stops, whatever failed for it.
  bool interrupt() {
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

  bool diverge(double t, const std::string& why) {
    if (interrupt()) return false;
    run.status = RunStatus::diverged;
    run.message = "The motion stopped " + at_time(t) + ": " + why + ".";
    return false;
  }

  // What has run away, as a clause; empty as a rule.
  std::string runaway() const {
    const std::string out = runaway_coordinate(*model, y, rate_scale);
    return !out.empty() && equations->independence() < 1e-3 * best_independence ? locked : out;
  }

  void handle_event(const StepOutcome& outcome) {
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

  // From the evaluated state on.
  void change_frictions(double t, const Eigen::VectorXd& u, Turned turned_back = Turned::stopped) {
    const Eigen::Vector3d energies = ode->energies(y);
    settle_frictions(t, u, turned_back);
    stepper->count(run.statistics);
    use_method(method);
    ode->pack(q, s, energies, y);
    start_stepper(t);
  }

  void set_stop(std::size_t i, bool touches, double t) {
    touching[i] = touches;
    run.stops.push_back({t, "", 0, stops[i].upper, touches});
    recorder->name(stops[i], run.stops.back());
  }

  // A stop that the step went past and no event reported, as where it is grazed.
  bool find_missed_stops(double t) {
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

  bool some_slip_has_turned(const Eigen::VectorXd& u) const {
    for (std::size_t i = 0; i < frictions.size(); ++i)
      if (slips[i] * u[v_of(frictions[i])] < 0) return true;
    return false;
  }
  // Where a slip turns back as the loops come to a singular position it has not stopped: the step is taken
  // back, and the way there halved until it can be leapt over.
  bool comes_to_singular_position(const StepOutcome& outcome) {
    const auto first = static_cast<int>(stops.size() + flips.size());
    if (std::ranges::none_of(outcome.events, [&](int e) { return e >= first; })) return false;
    if (settle(outcome.time, nullptr) && equations->independence() >= 0.01 * best_independence) return false;
    return take_back(outcome.time);
  }
  // The last step, which is to end halfway at most.
  bool take_back(double end) {
    constexpr int most = 200;
    if (halvings >= most) return false;
    ++halvings;
    y = whole;
    start_stepper(began);
    before_singular = began + (end - began) / 2;
    return true;
  }

  // After a step: whether all is well.
  bool check_step(double t) {
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

  // What the last step calls for. Put off until the samples within it are taken, for afterwards the
  // integrator may start anew.
  bool finish_step() {
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

  // A motion may become stiff on its way. Thought over after ever more steps; to BDF where that suits it now.
  void review_method() {
    review_at = 2 * pace.taken;
    if (method != Integrator::runge_kutta || options.method != Integrator::automatic ||
        options.fixed_step > 0)
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

  bool step_to(double t) {
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
        return diverge(stepped_to, "it would need more than " + rounded_text(pace.given_up_at(), 2) +
                                       " steps" + pace.text(stepped_to, fastest));
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

  // Why a step failed, from where it was well last.
  std::string reason_of(const StepOutcome& failure) {
    stepper->state_at(failure.time, y);
    if (const std::string what = runaway(); !what.empty()) return what;
    ode->unpack(y.data(), q, s);
    if (equations->project(failure.time, q, s) && equations->evaluate(failure.time, q, s))
      if (const std::string what = equations->trouble(); !what.empty()) return what;
    return equations->independence() < 0.01 * best_independence ? locked : failure.message;
  }
  long review_at = 0;    // steps
  Eigen::VectorXd whole; // where the last step began
  double began = 0;      // s, when
  // The next step goes no further (s); how often it was cut short since a singular position was passed.
  double before_singular = -std::numeric_limits<double>::infinity();
  int halvings = 0;

  bool record(double t) {
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

  double grid(long sample) const { return begin + static_cast<double>(sample) / options.rate; }
};

Simulator::Simulator(const Mechanism& mechanism, const SimulationOptions& options)
    : state_(std::make_unique<State>(options)) {
  open(options, [&] { return make_motion_model(mechanism, options.damped); });
}
Simulator::Simulator(const MotionModel& model, const SimulationOptions& options)
    : state_(std::make_unique<State>(options)) {
  open(options, [&] { return model; });
}

template <class Compile>
void Simulator::open(const SimulationOptions& options, const Compile& compile) {
  State& x = *state_;
  const auto clock = std::chrono::steady_clock::now();
  x.watch.allow(options.time_limit);
  x.run.damped = options.damped;
  try {
    const Interruptible scope(options.cancel); // what is decomposed on the way can be large
    x.open(compile(), options);
  } catch (const SceneError&) {
    x.stepper.reset();
    if (!x.interrupt()) throw;
    return; // without a sample
  } catch (const Interrupted&) {
    x.stepper.reset();
    x.interrupt();
    return;
  }
  x.run.notes = notes(x.model->system, x.model->mechanism);
  x.begin = x.stepped_to;
  x.recorder = std::make_unique<Recorder>(x.run, options.reactions, options.points, options.measures);
  x.recorder->use(x.model, *x.equations);
  if (!x.record(x.begin)) {
    x.stepper.reset();
    if (x.run.status == RunStatus::diverged) throw SceneError("", x.run.message);
    return;
  }
  x.next_sample = 1;
  x.run.statistics.run_time_s +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

bool Simulator::advance(double until, bool sample_end) {
  State& x = *state_;
  if (x.run.status == RunStatus::diverged || x.run.time.empty()) return false;
  x.run.status = RunStatus::completed;
  x.watch.allow(x.options.time_limit - x.run.statistics.run_time_s);
  const auto clock = std::chrono::steady_clock::now();
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(until) +
                          (x.options.rate > 0 ? 1e-9 / x.options.rate : 0);
  bool well = true;
  while (well && x.options.rate > 0 && x.grid(x.next_sample) <= until + rounding) {
    const double t = x.grid(x.next_sample);
    well = x.step_to(t) && x.record(t);
    if (well) ++x.next_sample;
  }
  if (well && sample_end && until - x.run.time.back() > rounding) well = x.step_to(until) && x.record(until);
  x.stepper->count(x.run.statistics);
  x.run.statistics.run_time_s +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  if (well) x.run.message = "Computed to " + number_text(x.run.time.back()) + " s.";
  return well;
}

const Run& Simulator::run() const {
  return state_->run;
}

double Simulator::time() const {
  return state_->run.time.empty() ? 0 : state_->run.time.back();
}

SimulationState Simulator::state() const {
  if (state_->run.time.empty()) throw SceneError("", "the motion has not begun");
  return state_at(state_->run, state_->run.time.size() - 1);
}

void Simulator::change(const Mechanism& mechanism, bool damped) {
  State& x = *state_;
  const SimulationState now = state();
  auto made = std::make_shared<MotionModel>(make_motion_model(mechanism, damped));
  if (made->system.coordinates.size() != x.model->system.coordinates.size())
    throw SceneError("", "the mechanism has other joints than the run; start a new one");
  SimulationOptions how;
  how.start = Start::state;
  how.state = now;
  x.watch.allow(x.options.time_limit - x.run.statistics.run_time_s);
  Eigen::VectorXd q, u;
  find_start(how, *made, q, u);
  const Eigen::Vector3d energies = x.recorder->energies();
  x.stepper->count(x.run.statistics);
  x.damped = damped;
  x.take(std::move(made));
  x.q = q;
  x.begin_motion(now.time, u, energies);
  x.run.damped = damped;
  x.recorder->use(x.model, *x.equations);
  if (!x.settle(now.time, nullptr)) throw SceneError("", "the motion cannot go on with these numbers");
  x.recorder->go_on();
  x.run.status = RunStatus::completed;
}

Run simulate(const Mechanism& mechanism, const SimulationOptions& options) {
  Simulator simulator(mechanism, options);
  const double begin = simulator.time();
  simulator.advance(begin + options.duration, true);
  return simulator.run();
}

} // namespace flyball
