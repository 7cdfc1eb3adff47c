// The motion as a map of states: where one is after some time. By the integrators, so that all that a motion
// knows it knows, too: loops, bodies without mass, stops.
#pragma once

#include "engine/dynamics/motion_model.hpp"

namespace flyball {

// The free coordinates, and their rates as a tangent vector (rad/s, m/s).
struct FlowState {
  double time = 0; // s; it says where the drives stand
  Eigen::VectorXd q, u;
};

// From where a motion began, its loops closed, to where it came.
struct Passage {
  FlowState from, to;
};

class Flow {
 public:
  // After `patience` times as many evaluations of the equations of motion as take some seconds nothing is
  // found any more. `cancel` may be null. Throws SceneError for a mechanism that cannot be compiled.
  Flow(const Mechanism& mechanism, double patience, const std::atomic<bool>* cancel);

  const MotionModel& model() const { return model_; }
  Problem problem() const { return model_.problem(); }

  // The drawn pose carried along by the drives.
  std::optional<FlowState> drawn();
  // The steady state.
  std::optional<FlowState> steady();
  // The same coordinates at another time, the loops closed there; carried along by the drives.
  std::optional<FlowState> carried(const FlowState& state, double time);
  // Where a state is after `duration` (s). `tolerance` as SimulationOptions has it; nothing where there is no
  // way there.
  std::optional<Passage> pass(const FlowState& from, double duration, double tolerance);
  // The motion with all its outputs, sampled `samples` times and at its start, whatever patience is left.
  // Without samples where it fails.
  Run record(const FlowState& from, double duration, int samples, double tolerance);

  // Its states alone; none where it takes more than what is left.
  std::vector<FlowState> trace(const FlowState& from, double duration, int samples, double tolerance);

  // Explicit steps keep to smaller tolerances than implicit ones do.
  bool is_stiff() const { return method_ == Integrator::bdf; }
  long evaluations() const { return evaluations_; }
  long most_evaluations() const { return most_; }
  bool spent() const { return evaluations_ >= most_; }
  bool cancelled() const { return cancel_ && cancel_->load(std::memory_order_relaxed); }
  // Why the last of these found nothing: a sentence, or a place and a clause.
  const std::string& trouble() const { return trouble_; }

 private:
  std::optional<FlowState> begin(const SimulationOptions& options, double time);
  SimulationOptions from_state(const FlowState& state, double tolerance) const;
  Run sampled_run(SimulationOptions options, double duration, int samples);

  MotionModel model_;
  long most_, evaluations_ = 0;
  const std::atomic<bool>* cancel_;
  Integrator method_ = Integrator::automatic; // the one that the first motion was found to need
  std::string trouble_;
};

} // namespace flyball
