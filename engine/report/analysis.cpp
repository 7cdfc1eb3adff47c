#include "engine/report/analysis.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/topology.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis_state.hpp"
#include "engine/report/found_speeds.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/report/verdict.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/stability/lowest_modes.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {

Analysis::Analysis(const Mechanism& mechanism) : Analysis(std::make_shared<const Mechanism>(mechanism)) {}
Analysis::Analysis(std::shared_ptr<const Mechanism> mechanism) : state_(std::make_unique<State>()) {
  state_->system = compile_for_drives(*mechanism);
  state_->mechanism = std::move(mechanism);
  state_->bind_numbers();
}
Analysis::~Analysis() = default;
Analysis::Analysis(Analysis&&) noexcept = default;
Analysis& Analysis::operator=(Analysis&&) noexcept = default;

void Analysis::update(const Mechanism& mechanism) {
  update(std::make_shared<const Mechanism>(mechanism));
}

void Analysis::update(std::shared_ptr<const Mechanism> mechanism) {
  State& s = *state_;
  if (mechanism == s.mechanism) return;
  if (!same_topology(*s.mechanism, *mechanism)) {
    *this = Analysis(std::move(mechanism));
    return;
  }
  s.mechanism = std::move(mechanism);
  s.varied.reset();
  s.settled = false;
  s.moved = true;
  s.bind_numbers();
}

void Analysis::vary(std::span<const std::string> addresses) {
  State& s = *state_;
  auto mechanism = std::make_shared<Mechanism>(*s.mechanism);
  VariedNumbers numbers(*mechanism, addresses);
  State::Varied varied{mechanism, std::move(numbers), {}, {}};
  find_dampers(*mechanism, varied.dampers);
  s.varied = std::move(varied);
  s.mechanism = std::move(mechanism);
}

void Analysis::set(std::span<const double> values) {
  State::go_back(state_); // so that no point depends on those before it
  State& s = *state_;
  State::Varied& varied = *s.varied;
  s.settled = false;
  s.moved = true;
  varied.numbers.set(values);
  validate_numbers(*varied.mechanism);
  find_dampers(*varied.mechanism, varied.dampers_now);
  if (varied.dampers_now == varied.dampers) return s.bind_numbers();
  // Where this throws, the system and what is told of its dampers stay together.
  std::unique_ptr<State> anew = s.compiled_anew();
  anew->varied->dampers.swap(anew->varied->dampers_now);
  state_ = std::move(anew);
}

Solution Analysis::solve(const SolveOptions& options) {
  const Interruptible scope(options.cancel);
  try {
    const bool as_drawn = !options.nearest && !options.newton_only;
    if (state_->before && as_drawn && options.start.empty()) turn_otherwise(); // or as it was again
    Solution out = solve_through(options);
    if (out.status == Status::converged || is_cancelled(options.cancel) || !as_drawn || !turn_otherwise())
      return out;
    SolveOptions anew = options;
    anew.start.clear(); // of coordinates that may be others now
    return solve_through(anew);
  } catch (const Interrupted&) {
    state_->settled = false;
    Solution cancelled;
    cancelled.message = "The solve was cancelled.";
    return cancelled;
  }
}

bool Analysis::turn_otherwise() {
  State& s = *state_;
  if (!s.moved || s.system.drives.empty()) return false;
  bool otherwise = false;
  try {
    const System own = compile_for_drives(*s.mechanism);
    otherwise = !same_choice(s.system, own);
    if (otherwise && s.before && same_choice(s.before->system, own)) {
      State::go_back(state_);
      state_->bind_numbers();
    } else if (otherwise) {
      std::unique_ptr<State> anew = s.compiled_anew();
      anew->before = std::move(s.before ? s.before : state_);
      state_ = std::move(anew);
    }
  } catch (const SceneError&) { // the loops are as they were, and why there is no state is told of them
  }
  state_->moved = false; // once for these numbers, unless it was interrupted
  return otherwise;
}

Solution Analysis::solve_through(const SolveOptions& options) {
  State& s = *state_;
  const Problem problem = s.prepare(options);
  const bool warm = options.warm && s.answered && options.start.empty();
  s.start = warm ? s.answer : s.drawn;
  set_start(s.system, s.parameters, options.start, s.start);

  report_progress(options.progress, "solving");
  const auto begin = std::chrono::steady_clock::now();
  SteadyState& steady = s.steady;
  s.on_friction.reset();
  const bool on_friction = options.friction && !options.nearest && has_friction(*s.mechanism);
  steady.find(problem, s.start, s.drawn,
              {.nearest = options.nearest,
               .warm = warm,
               .newton_only = options.newton_only,
               .seconds = options.search,
               .progress = options.progress});
  if (!steady.holds && steady.existence.rubs < 0 && !options.nearest && !options.newton_only &&
      problem.form == KktForm::dense && !problem.cancelled())
    s.find_turned(problem);
  if (on_friction && !steady.holds && !problem.cancelled())
    if (std::optional<StateOnFriction> state = find_friction_state(*s.mechanism, options)) {
      state->solution.run_time_s =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      s.on_friction = std::move(state->analysis);
      return std::move(state->solution);
    }
  Stability stability;
  if (steady.holds && steady.found.minimum && steady.phases.empty() &&
      !stands_on_kink(problem, steady.found.z.q, steady.elsewhere())) {
    stability.stable = true;
    stability.reason = StabilityReason::minimum;
  } else if (steady.holds) {
    stability = steady.stability ? *steady.stability : stability_of(problem, steady, false, 0);
  }
  const bool varies = stability.floquet || stability.floquet_failure;
  const bool open = steady.holds && sign_may_change(problem, steady, stability);
  const auto end = std::chrono::steady_clock::now();

  Solution out;
  out.run_time_s = std::chrono::duration<double>(end - begin).count();
  out.iterations = steady.found.iterations;
  out.history = steady.history;
  out.fallback = steady.found.fallback;
  out.status = steady.holds                               ? Status::converged
               : steady.found.status == Status::converged ? Status::no_steady_state
                                                          : steady.found.status;
  if (!steady.holds) {
    if (options.explain) s.explain(problem, stability, out);
    return out;
  }
  if (std::string why = undetermined_speed_message(*s.mechanism, s.system, stability.neutral); !why.empty()) {
    out.status = Status::not_converged;
    out.message = std::move(why);
    return out;
  }
  s.answer = steady.found.z.q;
  s.answered = s.settled = true;
  std::string without_modes;
  if (options.details && !varies) without_modes = s.add_eigenvalues(problem, options, stability);
  if (open && stability.reason != StabilityReason::neutral) leave_verdict_open(steady, stability);
  if (options.details) {
    add_condition(problem, steady, out);
    s.add_rates(problem, out);
  }
  report_progress(options.progress, "reactions");
  s.conclude(problem, steady, std::move(stability), without_modes, options, out);
  if (options.details && !options.nearest && s.system.nv <= largest_for_answer_search)
    explain_unbounded(problem, *s.mechanism, steady.start, steady.elsewhere(), out);
  std::string unknown = unknown_coordinate_message(out.coordinates);
  if (!unknown.empty() || !is_finite(out)) {
    s.settled = false;
    Solution refused;
    refused.run_time_s = out.run_time_s;
    refused.iterations = out.iterations;
    refused.message =
        unknown.empty() ? "The forces are too large for the computer's numbers." : std::move(unknown);
    return refused;
  }
  return out;
}

AllSolutions Analysis::solve_all(const SolveOptions& options) {
  const Interruptible scope(options.cancel);
  try {
    return solve_all_through(options);
  } catch (const Interrupted&) {
    AllSolutions cancelled;
    cancelled.message = "The search was cancelled.";
    cancelled.end = SearchEnd::cancelled;
    return cancelled;
  }
}

SystemSummary Analysis::summary() const {
  return summarize(*state_->mechanism, state_->system, state_->parameters);
}

std::vector<Pose> Analysis::poses_at(double t) {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->poses_at(t);
  std::vector<Pose> poses;
  Kinematics<double>& kinematics = s.steady.elsewhere().kinematics;
  forward<double>(s.system, s.turning(), s.answered ? s.answer : s.drawn, t, kinematics);
  body_poses(s.system, *s.mechanism, s.parameters, kinematics, poses);
  return poses;
}

std::vector<AngularMotion> Analysis::turning_at(double t) {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->turning_at(t);
  std::vector<AngularMotion> turning;
  Kinematics<double>& kinematics = s.steady.elsewhere().kinematics;
  forward<double>(s.system, s.turning(), s.answered ? s.answer : s.drawn, t, kinematics);
  for (const int link : s.system.body_link)
    turning.push_back({kinematics.at(link).w, kinematics.at(link).dw});
  return turning;
}

std::vector<VibrationMode> Analysis::modes(int count) {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->modes(count);
  if (!s.settled || s.steady.error.singular_loops) return {};
  const Problem problem{s.system, s.parameters, s.scaling, nullptr, s.system.kkt_form};
  const Unknowns& z = s.steady.found.z;
  if (!pivots_decide(problem))
    return s.system.nv > largest_for_eigenvalues
               ? find_modes(s.steady.factored(by_matrices(problem)), static_cast<std::size_t>(count))
               : find_modes(s.steady.factored(by_matrices(problem)));
  if (may_vary(problem, z, s.steady.phases, s.steady.elsewhere())) return {};
  return find_lowest_modes(problem, z, count, s.steady.elsewhere()).modes;
}

std::vector<Pose> Analysis::mode_poses(const VibrationMode& mode, double amplitude, double phase, double t) {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->mode_poses(mode, amplitude, phase, t);
  const Problem problem{s.system, s.turning(), s.scaling};
  Workspace& w = s.steady.elsewhere();
  const Eigen::VectorXd& steady = s.answered ? s.answer : s.drawn;
  std::vector<Pose> poses;
  const Eigen::VectorXd q = mode.shape.size() == static_cast<std::size_t>(s.system.nv)
                                ? along_mode(problem, steady, mode, amplitude, phase, t, w)
                                : steady;
  forward<double>(s.system, problem.parameters, q, t, w.kinematics);
  body_poses(s.system, *s.mechanism, s.parameters, w.kinematics, poses);
  return poses;
}

std::vector<BodyAmplitude> Analysis::body_amplitudes(const VibrationMode& mode) {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->body_amplitudes(mode);
  if (!s.settled) return {};
  return flyball::body_amplitudes({s.system, s.parameters, s.scaling}, s.answer, mode, s.steady.elsewhere());
}

std::optional<Whirl> Analysis::whirl(const VibrationMode& mode, std::string_view joint) {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->whirl(mode, joint);
  if (!s.settled) return {};
  const auto drive = std::ranges::find_if(s.system.links, [&](const Link& link) {
    return link.drive >= 0 && link.type == LinkType::revolute &&
           (joint.empty() || s.system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name == joint);
  });
  if (drive == s.system.links.end()) return {};
  return find_whirl({s.system, s.parameters, s.scaling}, s.answer, mode,
                    static_cast<int>(drive - s.system.links.begin()), s.steady.elsewhere());
}

std::optional<StabilityEvidence> Analysis::stability_evidence() {
  State& s = *state_;
  if (s.on_friction) return s.on_friction->stability_evidence();
  if (!s.settled) return {};
  return flyball::stability_evidence(s.steady.factored({s.system, s.parameters, s.scaling}));
}

} // namespace flyball
