#include "engine/dynamics/simulator.hpp"

#include "engine/dynamics/simulator_state.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/messages.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace flyball {

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
