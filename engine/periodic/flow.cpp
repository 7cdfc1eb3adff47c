#include "engine/periodic/flow.hpp"

#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr long evaluations_a_step = 14; // of the explicit method

FlowState sampled(const MotionModel& model, const Run& run, std::size_t sample, double time) {
  const Eigen::Index nq = model.system.nq, nv = model.system.nv;
  const double* begin = run.states.data() + static_cast<Eigen::Index>(sample) * (nq + nv);
  return {time, Eigen::Map<const Eigen::VectorXd>(begin, nq),
          Eigen::Map<const Eigen::VectorXd>(begin + nq, nv)};
}

// An evaluation takes about 3 us of a few coordinates and grows with the square of many.
double usual_evaluations(int coordinates) {
  const double eights = std::max(1., coordinates / 8.);
  return 1.2e6 / (eights * eights);
}

} // namespace

Flow::Flow(const Mechanism& mechanism, double patience, const std::atomic<bool>* cancel)
    : model_(make_motion_model(mechanism, true)),
      most_(static_cast<long>(patience * usual_evaluations(model_.system.nv))), cancel_(cancel) {}

SimulationOptions Flow::from_state(const FlowState& state, double tolerance) const {
  SimulationOptions options;
  options.start = Start::state;
  options.state = name_state(model_, state.time, state.q, state.u);
  options.tolerance = tolerance;
  options.method = method_;
  options.rate = 0;
  options.measures = false;
  options.cancel = cancel_;
  options.max_steps = std::max(1L, (most_ - evaluations_) / evaluations_a_step);
  return options;
}

// Where a motion with these options begins.
std::optional<FlowState> Flow::begin(const SimulationOptions& options, double time) {
  try {
    const Simulator simulator(model_, options);
    if (!simulator.run().time.empty()) return sampled(model_, simulator.run(), 0, time);
  } catch (const SceneError& error) {
    trouble_ = error.what();
  }
  return {};
}

std::optional<FlowState> Flow::drawn() {
  SimulationOptions options;
  options.rate = 0;
  options.measures = false;
  options.cancel = cancel_;
  return begin(options, 0);
}

std::optional<FlowState> Flow::steady() {
  SimulationOptions options;
  options.start = Start::equilibrium;
  options.rate = 0;
  options.measures = false;
  options.cancel = cancel_;
  return begin(options, 0);
}

std::optional<FlowState> Flow::carried(const FlowState& state, double time) {
  const FlowState still{time, state.q, Eigen::VectorXd::Zero(model_.system.nv)};
  return begin(from_state(still, 1e-8), time);
}

std::optional<Passage> Flow::pass(const FlowState& from, double duration, double tolerance) {
  if (spent() || cancelled()) return {};
  try {
    SimulationOptions options = from_state(from, tolerance);
    options.duration = duration;
    Simulator simulator(model_, options);
    const double begin = simulator.time();
    const bool well = simulator.advance(begin + duration, true);
    const Run& run = simulator.run();
    evaluations_ += std::max(1L, run.statistics.evaluations);
    if (!well) {
      trouble_ = run.message;
      if (run.statistics.steps >= options.max_steps) evaluations_ = std::max(evaluations_, most_);
      return {};
    }
    if (run.time.back() > begin + duration * (1 + 1e-12)) {
      trouble_ = "At t = " + rounded_text(begin + duration, 6) + " s the loops are in a singular position.";
      return {};
    }
    method_ = run.method;
    return Passage{sampled(model_, run, 0, from.time),
                   sampled(model_, run, run.time.size() - 1, from.time + duration)};
  } catch (const SceneError& error) {
    trouble_ = error.what();
    return {};
  }
}

std::vector<FlowState> Flow::trace(const FlowState& from, double duration, int samples, double tolerance) {
  if (spent() || cancelled()) return {};
  const Run run = sampled_run(from_state(from, tolerance), duration, samples);
  std::vector<FlowState> out;
  for (std::size_t i = 0; i < run.time.size(); ++i)
    out.push_back(sampled(model_, run, i, run.time[i]));
  return out;
}

Run Flow::record(const FlowState& from, double duration, int samples, double tolerance) {
  SimulationOptions options = from_state(from, tolerance);
  options.measures = options.reactions = true;
  options.max_steps = SimulationOptions{}.max_steps;
  return sampled_run(options, duration, samples);
}

Run Flow::sampled_run(SimulationOptions options, double duration, int samples) {
  try {
    options.duration = duration;
    options.rate = samples / duration;
    Simulator simulator(model_, options);
    const bool well = simulator.advance(simulator.time() + duration * (1 + 1e-12));
    const Run& run = simulator.run();
    evaluations_ += run.statistics.evaluations;
    if (well && run.time.size() == static_cast<std::size_t>(samples) + 1) return run;
    trouble_ = run.message;
    if (run.statistics.steps >= options.max_steps) evaluations_ = std::max(evaluations_, most_);
  } catch (const SceneError& error) {
    trouble_ = error.what();
  }
  return {};
}

} // namespace flyball
