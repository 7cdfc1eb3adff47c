#include "engine/dynamics/simulator_state.hpp"

#include "engine/dynamics/choose_method.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/mechanism/error.hpp"

#include <utility>

namespace flyball {
namespace {

// Explicit steps after which the choice of a method is thought over for the first time.
constexpr long first_review = 500;

} // namespace

void Simulator::State::open(MotionModel compiled, const SimulationOptions& how) {
  auto made = std::make_shared<MotionModel>(std::move(compiled));
  Eigen::VectorXd u;
  find_start(how, *made, q, u);
  take(std::move(made));
  begin_motion(how.start == Start::state ? how.state.time : 0, u, Eigen::Vector3d::Zero());
}

void Simulator::State::take(std::shared_ptr<MotionModel> made) {
  frictions = list_frictions(*made);
  for (const FrictionElement& friction : frictions)
    made->parameters.links[static_cast<std::size_t>(friction.link)].force.hold(0).friction = 0;
  model = std::move(made);
  free = frictions.empty() ? nullptr : model;
}

void Simulator::State::begin_motion(double t, const Eigen::VectorXd& u, const Eigen::Vector3d& energies) {
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

void Simulator::State::use_method(Integrator chosen) {
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

void Simulator::State::start_stepper(double t) {
  stepper->start(t, y);
  stepped_to = started_at = t;
  torn = false;
  ++run.statistics.restarts;
}

void Simulator::State::restructure(double t, const Eigen::VectorXd& u) {
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

} // namespace flyball
