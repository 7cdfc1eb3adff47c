#include "engine/dynamics/simulator.hpp"

#include "engine/dynamics/choose_method.hpp"
#include "engine/dynamics/motion_ode.hpp"
#include "engine/dynamics/recorder.hpp"
#include "engine/dynamics/singular_position.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace flyball {
namespace {

// A coordinate this many radians or reaches away, or as many times too fast, has left the mechanism.
constexpr double far_away = 1e8, far_too_fast = 1e10;

const std::string locked = "the loops have come to a position that they cannot pass";

std::string at_time(double t) {
  return "at t = " + number_text(std::round(t * 1e9) / 1e9) + " s";
}

} // namespace

struct Simulator::State {
  SimulationOptions options;
  bool damped = true;
  std::shared_ptr<const MotionModel> model;
  std::unique_ptr<Equations> equations;
  std::unique_ptr<MotionOde> ode;
  std::unique_ptr<Stepper> stepper;
  std::vector<StopElement> stops;
  std::vector<bool> touching; // by stop
  std::vector<FlipElement> flips;
  double rate_scale = 1;
  Integrator method = Integrator::automatic;

  Run run;
  std::unique_ptr<Recorder> recorder;
  double begin = 0, stepped_to = 0;   // s; where the integrator stands
  long next_sample = 0;               // on the grid, from `begin`
  std::optional<StepOutcome> pending; // the last step's, to be looked at
  double best_independence = 0, started_at = 0;
  // The way over a singular position, for samples that fall on it.
  struct Bridge {
    double time;
    Eigen::VectorXd y, rate, end, end_rate;
  };
  std::optional<Bridge> bridge;
  Eigen::VectorXd y, q, s;

  void open(const Mechanism& mechanism, const SimulationOptions& how) {
    auto made = std::make_shared<MotionModel>(make_motion_model(mechanism, damped));
    Eigen::VectorXd u;
    find_start(how, *made, q, u);
    model = std::move(made);
    begin_motion(how.start == Start::state ? how.state.time : 0, u, Eigen::Vector3d::Zero());
  }

  // From q and a velocity u that keep the loops closed.
  void begin_motion(double t, const Eigen::VectorXd& u, const Eigen::Vector3d& energies) {
    stepper.reset();
    pending.reset();
    bridge.reset();
    equations = std::make_unique<Equations>(*model);
    stops = list_stops(model->system, model->parameters);
    touching.assign(stops.size(), false);
    flips = list_flips(model->system, model->parameters);
    restructure(t, u);
    if (!equations->evaluate(t, q, s))
      throw SceneError("", "the equations of motion have no solution at the start");
    const double energy_scale = equations->energy_scale();
    const MethodChoice choice =
        choose_method(*equations, options.duration, options.tolerance, options.method);
    method = options.fixed_step > 0 ? Integrator::runge_kutta : choice.method;
    rate_scale = choice.rate_scale;
    run.method = method;
    run.method_reason = options.fixed_step > 0 ? "Steps of a fixed size." : choice.reason;
    ode = std::make_unique<MotionOde>(*equations, options.tolerance, rate_scale, energy_scale);
    ode->set_events(stops, flips);
    ode->set_touching(touching);
    ode->set_inner_projection(method == Integrator::adams && equations->needs_projection());
    stepper = method == Integrator::runge_kutta ? make_runge_kutta_stepper(*ode, options.fixed_step)
                                                : make_cvode_stepper(*ode, method);
    ode->pack(q, s, energies, y);
    start_stepper(t);
  }

  void start_stepper(double t) {
    stepper->start(t, y);
    stepped_to = started_at = t;
    ++run.statistics.restarts;
  }

  // Stops by where q stands and goes; then independent rows and idle coordinates. Leaves s.
  void restructure(double t, const Eigen::VectorXd& u) {
    for (FlipElement& flip : flips)
      flip.side = rotation(flip, q).w() >= 0;
    // What stands in balance may come upon a stop on the way there.
    equations->latch({}, {}, flips);
    equations->analyse(t, q, u);
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const double value = value_at_stop(*model, stops[i], q);
      touching[i] = stops[i].upper ? value > 0 : value < 0;
    }
    equations->latch(stops, touching, flips);
    if (equations->has_massless()) equations->analyse(t, q, u);
    equations->reduce(t, q, u, s);
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

  bool diverge(double t, const std::string& why) {
    run.status = RunStatus::diverged;
    run.message = "The motion stopped " + at_time(t) + ": " + why + ".";
    return false;
  }

  // What has run away, as a clause; empty as a rule.
  std::string runaway(const Eigen::VectorXd& state) const {
    double worst = 1;
    std::string out;
    for (const Link& link : model->system.links) {
      if (link.v < 0) continue;
      const bool rotation = link.type == LinkType::spherical;
      for (int k = 0; k < (rotation ? 3 : 1); ++k) {
        const double scale = model->scaling.column[link.v + k];
        const double place = rotation ? 0 : std::abs(state[link.q]) / (far_away * scale);
        const double speed =
            std::abs(state[model->system.nq + link.v + k]) / (far_too_fast * scale * rate_scale);
        if (!(std::max(place, speed) > worst)) continue;
        worst = std::max(place, speed);
        out = name_of_coordinate(*model, link.v + k) + " runs away";
      }
    }
    if (!out.empty() && equations->independence() < 1e-3 * best_independence) return locked;
    return out;
  }

  void handle_event(const StepOutcome& outcome) {
    const double t = outcome.time;
    if (!settle(t, nullptr)) return; // the next step says what is wrong
    const Eigen::VectorXd u = equations->velocity().head(model->system.nv);
    bool changed = false;
    std::vector<int> flipped; // links
    for (int e : outcome.events) {
      const auto i = static_cast<std::size_t>(e);
      if (i < stops.size()) continue;
      // A rotation vector turned over, and with it the forces of its springs.
      FlipElement& flip = flips[i - stops.size()];
      flipped.push_back(flip.link);
      const bool side = flip_rate(flip, u) > 0;
      if (side == flip.side) continue;
      const bool beyond = (rotation(flip, q).w() >= 0) == side; // as log_rotation takes it
      recorder->absorb((beyond ? 1 : -1) * flip_energy(flip.link));
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
      const double rate = rate_of(stop, u);
      const bool touches = stop.upper ? rate > 0 : rate < 0;
      if (touches == touching[i]) continue;
      set_stop(i, touches, t);
      changed = true;
    }
    if (!changed) return;
    equations->latch(stops, touching, flips);
    ode->set_touching(touching);
    ode->pack(q, s, ode->energies(y), y);
    start_stepper(t);
  }

  void set_stop(std::size_t i, bool touches, double t) {
    touching[i] = touches;
    run.stops.push_back({t, "", 0, stops[i].upper, touches});
    recorder->name(stops[i], run.stops.back());
  }

  // A stop that the step went past and no event told of, as where it is grazed.
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

  Quat rotation(const FlipElement& flip, const Eigen::VectorXd& at) const {
    const auto l = static_cast<std::size_t>(flip.link);
    return joint_rotation(model->system.links[l], model->parameters.links[l], at);
  }
  // 1/s, of the scalar part.
  double flip_rate(const FlipElement& flip, const Eigen::VectorXd& u) const {
    const Link& link = model->system.links[static_cast<std::size_t>(flip.link)];
    const Quat turning(0, u[link.v], u[link.v + 1], u[link.v + 2]);
    Eigen::VectorXd turned = q;
    const Quat d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
    const Quat rate = turning * d;
    turned.segment<4>(link.q) << rate.w(), rate.vec();
    return rotation(flip, turned).w() / 2;
  }

  // J, by which the springs of a rotation vector differ from what they were at the other side of half a turn.
  double flip_energy(int link) const {
    const auto l = static_cast<std::size_t>(link);
    const LinkParameters& p = model->parameters.links[l];
    const Vec3 r = rotation_vector(model->system.links[l], p, q);
    double change = 0;
    for (int k = 0; k < 3; ++k) {
      const CoordinateForce& f = p.force[static_cast<std::size_t>(k)];
      change += f.energy(r[k]) - f.energy(-r[k]);
    }
    return change;
  }

  double rate_of(const StopElement& stop, const Eigen::VectorXd& u) const {
    const auto l = static_cast<std::size_t>(stop.link);
    const Link& link = model->system.links[l];
    if (link.type != LinkType::spherical) return u[link.v];
    return rotation_vector_rate(link, model->parameters.links[l], q).row(stop.component) *
           u.segment<3>(link.v);
  }

  // After a step: whether all is well.
  bool check_step(double t) {
    if (const std::string what = runaway(y); !what.empty()) return diverge(t, what);
    if (!stops.empty() && find_missed_stops(t)) {
      equations->latch(stops, touching, flips);
      ode->set_touching(touching);
      start_stepper(t);
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
        start_stepper(across->time);
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
    equations->reduce(t, q, u, s);
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
    if (outcome.kind != StepOutcome::event) return check_step(outcome.time);
    handle_event(outcome);
    return true;
  }

  bool step_to(double t) {
    while (stepped_to < t) {
      if (options.cancel && options.cancel->load(std::memory_order_relaxed)) {
        run.status = RunStatus::cancelled;
        run.message = "Cancelled " + at_time(run.time.back()) + ".";
        return false;
      }
      if (!finish_step()) return false;
      if (stepped_to >= t) break; // over a singular position
      if (++taken > options.max_steps)
        return diverge(stepped_to, "more than " + std::to_string(options.max_steps) + " steps were needed");
      const StepOutcome outcome = stepper->step(t);
      if (outcome.kind == StepOutcome::failed) return diverge(outcome.time, reason_of(outcome));
      stepped_to = outcome.time;
      pending = outcome;
    }
    return true;
  }

  // Why a step failed, from where it was well last.
  std::string reason_of(const StepOutcome& failure) {
    stepper->state_at(failure.time, y);
    if (const std::string what = runaway(y); !what.empty()) return what;
    ode->unpack(y.data(), q, s);
    if (equations->project(failure.time, q, s) && equations->evaluate(failure.time, q, s))
      if (const std::string what = equations->trouble(); !what.empty()) return what;
    return equations->independence() < 0.01 * best_independence ? locked : failure.message;
  }
  long taken = 0;

  bool record(double t) {
    double shift = 0;
    if (!settle(t, &shift)) return diverge(t, "the equations of motion have no solution there");
    recorder->record(t, ode->energies(y), shift);
    if (options.progress) options.progress(t);
    return true;
  }

  double grid(long sample) const { return begin + static_cast<double>(sample) / options.rate; }
};

Simulator::Simulator(const Mechanism& mechanism, const SimulationOptions& options)
    : state_(std::make_unique<State>()) {
  State& x = *state_;
  x.options = options;
  x.damped = options.damped;
  const auto clock = std::chrono::steady_clock::now();
  x.open(mechanism, options);
  x.run.damped = options.damped;
  x.run.notes = x.model->notes;
  x.begin = x.stepped_to;
  x.recorder = std::make_unique<Recorder>(x.run, options.reactions, options.points);
  x.recorder->use(x.model, *x.equations);
  x.record(x.begin);
  x.next_sample = 1;
  x.run.statistics.run_time_s +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

bool Simulator::advance(double until, bool sample_end) {
  State& x = *state_;
  if (x.run.status == RunStatus::diverged) return false;
  x.run.status = RunStatus::completed;
  const auto clock = std::chrono::steady_clock::now();
  const double rounding = 1e-12 * std::max(1., std::abs(until));
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
  return state_->run.time.back();
}

SimulationState Simulator::state() const {
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
  Eigen::VectorXd q, u;
  find_start(how, *made, q, u);
  const Eigen::Vector3d energies = x.recorder->energies();
  x.stepper->count(x.run.statistics);
  x.damped = damped;
  x.model = std::move(made);
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
