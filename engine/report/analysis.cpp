#include "engine/report/analysis.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/topology.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/found_speeds.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/report/kink_message.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/report/turned_measures.hpp"
#include "engine/report/turning_part.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/search/phase_search.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/search/turned_rates.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/sensitivity.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/lowest_modes.hpp"
#include "engine/stability/sign_is_open.hpp"
#include "engine/stability/stability.hpp"
#include "engine/system/classify.hpp"
#include "engine/system/point_motion.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

// All eigenvalues need the matrices; beyond a size the pivots have to do.
bool is_large(const Problem& problem) {
  return problem.system.nv > largest_for_eigenvalues && problem.form != KktForm::dense;
}

bool pivots_decide(const Problem& problem) {
  return is_large(problem) && problem.system.torques.empty();
}

// Few coordinates by the matrices, whatever the form that solving takes.
Problem by_matrices(const Problem& problem) {
  return {problem.system, problem.parameters, problem.scaling, problem.cancel};
}

Stability stability_of(const Problem& problem, SteadyState& steady, bool with_eigenvalues, int modes) {
  if (pivots_decide(problem)) return find_stability(steady.factored(problem), false);
  const bool many = problem.system.nv > largest_for_eigenvalues && modes == 0;
  Stability out = find_stability(steady.factored(by_matrices(problem)), with_eigenvalues && !many);
  if (many && !out.floquet) out.eigenvalues.reset();
  return out;
}

bool stands_on_kink(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  if (!may_have_kinks(problem.system, problem.parameters)) return false; // of a minimum
  forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
  return !find_kinks(problem, q, w.kinematics).empty();
}

// Within the error of the state.
bool sign_may_change(const Problem& problem, SteadyState& steady, const Stability& stability) {
  return sign_is_open(problem, steady.found.z, steady.error.solution, stability, steady.elsewhere());
}

// What cannot be told of a state whose error is taken for that of something too soft to be seen beside what
// is stiff, which may hold it.
void leave_verdict_open(SteadyState& steady, Stability& stability) {
  leave_open(stability);
  steady.error.solution = steady.error.solution.cwiseMax(steady.error.undetermined);
}

// Adds the eigenvalues nearest to zero of a large mechanism to what its pivots say; where those decide
// nothing one that grows does. Returns why there are none.
std::string add_lowest_eigenvalues(const Problem& problem, const Unknowns& z, int count, Workspace& w,
                                   Stability& out) {
  std::vector<std::complex<double>> eigenvalues;
  // As a rule in pairs.
  for (const int modes : {(count + 1) / 2, count}) {
    const LowestModes lowest = find_lowest_modes(problem, z, modes, w);
    if (!lowest.failure.empty()) return lowest.failure;
    eigenvalues.clear();
    for (const VibrationMode& mode : lowest.modes) {
      eigenvalues.push_back(mode.eigenvalue);
      if (mode.oscillates()) eigenvalues.push_back(std::conj(mode.eigenvalue));
    }
    if (eigenvalues.size() >= static_cast<std::size_t>(count)) break;
  }
  const bool grows =
      std::ranges::any_of(eigenvalues, [](std::complex<double> s) { return s.real() > 1e-6 * std::abs(s); });
  if (!out.reason && grows) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  }
  out.eigenvalues = std::move(eigenvalues);
  return {};
}

// Of a large mechanism as many eigenvalues as are asked for.
void keep_asked_for(const Problem& problem, int modes, Stability& stability) {
  if (problem.system.nv > largest_for_eigenvalues && modes > 0 && stability.eigenvalues)
    keep_nearest(*stability.eigenvalues, static_cast<std::size_t>(modes));
}

// Of the balance on the null space, scaled and equilibrated, where that is not too large.
void add_condition(const Problem& problem, SteadyState& steady, Solution& out) {
  if (problem.system.nv == 0 || problem.system.nv > largest_for_eigenvalues) return;
  out.condition = steady.factored(by_matrices(problem)).w.dense.hessian().condition();
}

// Where the coordinates that are free were looked for.
std::vector<AllSolutions::Bound> bounds_of(const System& system, std::span<const SearchRange> ranges) {
  std::vector<AllSolutions::Bound> out;
  for (std::size_t c = 0; c < system.coordinates.size(); ++c) {
    const CoordinateInfo& info = system.coordinates[c];
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(info.tree_joint)];
    const Link& link = system.links[static_cast<std::size_t>(info.link)];
    if (link.drive >= 0 && !finds_speed(link)) continue;
    out.push_back({joint.name, info.index, coordinate_count(joint.type), info.angle, ranges[c].lower,
                   ranges[c].upper, finds_speed(link)});
  }
  return out;
}

} // namespace

struct Analysis::State {
  // Where numbers vary: the mechanism is of its own.
  struct Varied {
    std::shared_ptr<Mechanism> mechanism;
    VariedNumbers numbers;
    std::vector<bool> dampers, dampers_now; // that the system is compiled with, and of the numbers set
  };

  std::shared_ptr<const Mechanism> mechanism;
  std::optional<Varied> varied;
  System system;
  Parameters parameters;
  Parameters found; // see turning()
  Scaling scaling;
  MeasureSet measures;
  SteadyState steady; // of the last solve
  Eigen::VectorXd drawn, answer, start;
  bool answered = false;
  bool settled = false; // the last solve converged, and no number has changed since
  bool moved = false;   // numbers have changed since the system was compiled
  bool turned = false;  // what turns at found speeds stands otherwise than drawn in `parameters`
  AngleTies ties;       // of such
  // Of the last solve's answer where that rests on dry friction: it is not among the states of this system.
  std::optional<Analysis> on_friction;
  // Where the numbers as they are now make something else turn: as it was compiled for those before them.
  std::unique_ptr<State> before;

  // Whether a number makes a damper, which is none now, of a joint in which what turns moves against other
  // parts and which closes a loop: the system does not have it, and cannot tell what it does.
  bool makes_damper(const std::string& address) const {
    return std::ranges::any_of(system.cuts, [&](const CutJoint& cut) {
      if (cut.type == JointType::gear || moving_frame(system, cut.ends.a) == moving_frame(system, cut.ends.b))
        return false;
      const auto j = static_cast<std::size_t>(cut.joint);
      const Joint& joint = mechanism->joints[j];
      if (std::ranges::find(joint.coordinates, 0, &Coordinate::damping) == joint.coordinates.end())
        return false;
      // What most numbers cannot be is asked first: this is a part of every solve.
      const bool given = std::ranges::any_of(
          joint.formulas, [](const Formula& each) { return each.key.starts_with("damping"); });
      const std::string_view name = address;
      const bool own = name.starts_with("joints.") && name.substr(7).starts_with(joint.name) &&
                       name.substr(7 + joint.name.size()).starts_with(".damping");
      return (given || own) &&
             !std::ranges::equal(joint.coordinates,
                                 with_dampers_beside(*mechanism, {&address, 1}).joints[j].coordinates, {},
                                 &Coordinate::damping, &Coordinate::damping);
    });
  }

  // How the steady state moves with the sliders' numbers.
  void add_rates(const Problem& problem, Solution& out) {
    if (mechanism->sliders.empty() || system.nv == 0) return;
    if (turned) return add_turned_rates(problem, out);
    std::vector<std::string> addresses;
    for (const Slider& slider : mechanism->sliders)
      addresses.push_back(slider.parameter);
    const std::vector<Eigen::VectorXd> rates = sensitivities(steady.factored(problem), *mechanism, addresses);
    if (rates.empty()) return;
    Eigen::MatrixXd along;
    if (!measures.empty())
      along =
          measures.rates_along(problem, *mechanism, addresses, steady.found.z.q, rates, steady.elsewhere());
    for (std::size_t i = 0; i < rates.size(); ++i) {
      if (rates[i].size() == 0 || makes_damper(addresses[i])) continue; // none that is finite, or is known
      out.sensitivities.push_back(name_rates(system, addresses[i], rates[i]));
      if (measures.empty()) continue;
      const auto rate = along.col(static_cast<Eigen::Index>(i));
      out.sensitivities.back().measures.assign(rate.begin(), rate.end());
    }
  }

  // The same where it stands turned.
  void add_turned_rates(const Problem& problem, Solution& out) {
    for (const Slider& slider : mechanism->sliders) {
      if (makes_damper(slider.parameter)) continue;
      Mechanism changed = *mechanism;
      VariedNumbers number(changed, {&slider.parameter, 1});
      const std::vector<TurnedRate> rates =
          turned_rates(problem, steady.found.z, ties, changed, number, steady.elsewhere());
      if (rates.empty() || rates[0].q.size() == 0) continue; // none that is finite
      out.sensitivities.push_back(name_rates(system, slider.parameter, rates[0].q));
      if (measures.empty()) continue;
      const Eigen::VectorXd along = turned_measure_rates(problem, steady.found.z.q, rates[0], measures,
                                                         changed, number, 0, steady.elsewhere());
      measures.bind(*mechanism, system, parameters);
      out.sensitivities.back().measures.assign(along.begin(), along.end());
    }
  }

  // Looks for a steady state at other angles of what turns at found speeds, which then takes the place of
  // what does not hold.
  void find_turned(const Problem& problem) {
    std::optional<TurnedState> state = find_turned_state(problem, start, steady.elsewhere());
    turned = state.has_value();
    if (!state) return;
    parameters = at_angles_of(parameters, *state);
    ties = std::move(state->ties);
    steady.reuse();
    steady.found = {};
    steady.found.status = Status::converged;
    steady.found.z = std::move(state->z);
    steady.found.iterations = state->iterations;
    steady.history = std::move(state->history);
    steady.start = start;
    steady.stability.reset();
    steady.others.reset();
    steady.phases = sample_phases(system, parameters, steady.found.z.q);
    steady.error = {};
    steady.error.solution = std::move(state->error);
    steady.error.data = steady.error.undetermined = Eigen::VectorXd::Zero(system.nv);
    steady.existence = check_existence(problem, steady.found.z.q, steady.phases, steady.elsewhere());
    steady.holds = steady.existence.holds;
  }

  // The angles that find_turned() found, one sentence.
  std::string turned_message() const {
    std::string angles;
    for (const DriveTorqueElement& torque : system.torques) {
      const Link& link = system.links[static_cast<std::size_t>(torque.link)];
      const double by = parameters.links[static_cast<std::size_t>(torque.link)].start;
      if (std::abs(by) < 1e-12) continue;
      angles += (angles.empty() ? "" : ", ") + coordinate_label(system, link) + " by " + rounded_text(by, 6) +
                (link.type == LinkType::revolute ? " rad" : " m");
    }
    return "So that the balance stays it stands turned against the drawn pose: " + angles + ".";
  }

  // Where drives give torques: with the speeds that were found, for what turns with them.
  const Parameters& turning() {
    if (system.torques.empty() || !answered) return parameters;
    found = parameters;
    for (const DriveTorqueElement& torque : system.torques) {
      const auto l = static_cast<std::size_t>(torque.link);
      found.links[l].speed = answer[system.links[l].q];
    }
    return found;
  }

  // Whatever is solved begins so. Throws SceneError for points that name nothing.
  Problem prepare(const SolveOptions& options) {
    if (turned) bind_numbers();
    turned = settled = false;
    for (const BodyPoint& point : options.points)
      find_point(system, *mechanism, parameters, point);
    return {system, parameters, scaling, options.cancel, system.kkt_form};
  }

  // Why there is no steady state.
  void explain(const Problem& problem, const Stability& stability, Solution& out) {
    const ReportInput input{*mechanism, problem, steady.found, steady.existence, stability};
    FailureMessage why = failure_message(input, steady.elsewhere());
    out.message = std::move(why.text);
    if (steady.others) out.message += " " + message(*steady.others, steady.found.status);
    out.residual = steady.history.empty() ? 0 : steady.history.back();
    explain_unbounded(problem, *mechanism, steady.start, steady.elsewhere(), out);
    out.weight_turns = out.status == Status::no_steady_state && !steady.existence.loops_open &&
                       weight_turns(problem, steady.found.z.q, steady.existence.phase, steady.elsewhere());
    if (system.torques.empty() || out.status != Status::not_converged || problem.cancelled() ||
        why.change_point)
      return;
    if (const std::string missing = missing_speed_message(*mechanism, problem, steady.elsewhere());
        !missing.empty())
      out.message = missing + " " + out.message;
  }

  // To what the verdict on the steady state rests on. Returns why there are none, where they are looked for.
  std::string add_eigenvalues(const Problem& problem, const SolveOptions& options, Stability& stability) {
    const bool known_by_pivots = is_large(problem) && (pivots_decide(problem) || steady.found.minimum);
    if (options.modes <= 0 && known_by_pivots) return {};
    report_progress(options.progress, "eigenvalues");
    std::string failure;
    if (pivots_decide(problem))
      failure = add_lowest_eigenvalues(problem, steady.found.z, options.modes, steady.elsewhere(), stability);
    else if (!stability.eigenvalues) // only of a minimum the sign is found without them
      stability = stability_of(problem, steady, true, options.modes);
    keep_asked_for(problem, options.modes, stability);
    return failure;
  }

  // Fills in what is told of a state that holds.
  void conclude(const Problem& problem, SteadyState& at, Stability stability,
                const std::string& without_modes, const SolveOptions& options, Solution& out) {
    out.singular_loops = at.error.singular_loops;
    if (out.singular_loops) leave_out_modes(stability);
    report({*mechanism, problem, at.found, at.existence, stability, options.points, &measures},
           at.error.solution + at.error.data, options.details, at.reuse(), out);
    if (!without_modes.empty()) out.message += " " + without_modes;
    if (turned) out.message += " " + turned_message();
    out.turned = turned;
    if (options.details && !system.torques.empty())
      out.at_constant_speed =
          turned ? turned_stability_at_constant_speed(*mechanism, problem, at.found.z, out.coordinates)
                 : stability_at_constant_speed(*mechanism, system, at.found.z.q, out.coordinates);
  }

  // Compiled for the numbers as they are now, which go on to vary; where that throws this stays as it is.
  std::unique_ptr<State> compiled_anew() {
    Analysis anew(mechanism);
    anew.state_->varied = std::move(varied);
    return std::move(anew.state_);
  }

  // To what was compiled before; numbers are to be bound.
  static void go_back(std::unique_ptr<State>& state) {
    if (!state->before) return;
    std::unique_ptr<State> first = std::move(state->before);
    first->mechanism = std::move(state->mechanism);
    first->varied = std::move(state->varied);
    state = std::move(first);
  }

  void bind_numbers() {
    on_friction.reset();
    bind(system, *mechanism, parameters);
    set_scaling(system, parameters, scaling);
    measures.bind(*mechanism, system, parameters);
    drawn_configuration(system, parameters, drawn);
  }
};

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
  const std::optional<std::string> unknown = unknown_coordinate(out);
  if (unknown || !is_finite(out)) {
    s.settled = false;
    Solution refused;
    refused.run_time_s = out.run_time_s;
    refused.iterations = out.iterations;
    refused.message = unknown ? "An equilibrium was found, but rounding leaves no digit of " + *unknown +
                                    ": the scene's numbers differ too much in size."
                              : "The forces are too large for the computer's numbers.";
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

AllSolutions Analysis::solve_all_through(const SolveOptions& options) {
  State& s = *state_;
  const Problem problem = s.prepare(options);
  SearchOptions search;
  search.seconds = options.search_time;
  search.starts = options.search_starts;
  search.progress = options.progress;
  const bool rubs = rubbing_link(s.system, s.parameters) >= 0; // then friction has a part in all there is
  if (rubs) search.starts = 1;
  EquilibriumList list = find_all_equilibria(problem, s.drawn, search, s.steady.elsewhere());
  AllSolutions out;
  out.starts = list.report.starts;
  out.unseen = list.report.unseen;
  out.end = rubs ? SearchEnd::settled : list.report.end;
  out.bounds = bounds_of(s.system, list.report.ranges);
  struct Entry {
    Potential potential;
    Solution solution;
    Eigen::VectorXd q, error; // the error scaled
    std::vector<int> neutral;
    std::string kinks;
  };
  std::vector<Entry> entries;
  std::string undetermined; // that nothing determines the speed of a drive
  SteadyState steady;
  for (std::size_t i = 0; i < list.states.size() && !problem.cancelled(); ++i) {
    report_progress(options.progress, "classifying what was found",
                    static_cast<double>(i) / static_cast<double>(list.states.size()));
    Found& found = steady.found;
    found = {};
    found.status = Status::converged;
    found.z = list.states[i];
    found.newton = list.outcomes[i];
    found.iterations = list.outcomes[i].iterations;
    const auto begin = std::chrono::steady_clock::now();
    steady.complete(problem);
    if (!steady.holds) {
      out.passing += !rubs;
      continue;
    }
    const bool many = s.system.nv > largest_for_eigenvalues && options.modes == 0;
    const bool by_pivots = pivots_decide(problem);
    const Problem classified = by_pivots ? problem : by_matrices(problem);
    Stability stability = find_stability(steady.factored(classified), !many);
    if (std::string why = undetermined_speed_message(*s.mechanism, s.system, stability.neutral);
        !why.empty()) {
      undetermined = std::move(why);
      continue;
    }
    const bool varies = stability.floquet || stability.floquet_failure;
    if (sign_may_change(problem, steady, stability)) leave_verdict_open(steady, stability);
    if (!stability.neutral.empty() && is_pushed_where_soft(steady.factored(classified))) {
      ++out.lost;
      continue;
    }
    // Nearer than their errors two are one: that which is known better.
    const Eigen::VectorXd error = steady.error.solution.cwiseQuotient(s.scaling.column);
    const auto is_same = [&](const Entry& e) {
      const Eigen::VectorXd apart = scaled_difference(problem, e.q, found.z.q).cwiseAbs();
      return e.solution.stable == stability.stable && (apart.array() <= (e.error + error).array()).all();
    };
    if (std::ranges::any_of(entries,
                            [&](const Entry& e) { return is_same(e) && e.error.norm() <= error.norm(); }))
      continue;
    std::erase_if(entries, is_same);
    std::string without_modes;
    if (by_pivots && options.modes > 0 && options.details && !varies)
      without_modes = add_lowest_eigenvalues(problem, found.z, options.modes, steady.elsewhere(), stability);
    if (!varies) keep_asked_for(problem, options.modes, stability);
    // A family along a direction that nothing resists is one entry.
    Potential potential;
    if (s.system.conservative)
      potential =
          amended_potential(s.system, s.parameters, found.z.q, steady.factored(classified).w.kinematics);
    if (!stability.neutral.empty() && std::ranges::any_of(entries, [&](const Entry& e) {
          return e.neutral == stability.neutral && same_potential(e.potential, potential) &&
                 same_pose(problem, e.q, found.z.q, 1e-6, stability.neutral);
        }))
      continue;
    const auto end = std::chrono::steady_clock::now();
    Entry entry{.potential = potential,
                .solution = {},
                .q = found.z.q,
                .error = error,
                .neutral = stability.neutral,
                .kinks = kink_message(s.system, *s.mechanism, stability)};
    entry.solution.status = Status::converged;
    entry.solution.iterations = found.iterations;
    entry.solution.run_time_s = std::chrono::duration<double>(end - begin).count();
    if (options.details) add_condition(problem, steady, entry.solution);
    s.conclude(problem, steady, std::move(stability), without_modes, options, entry.solution);
    if (s.system.conservative) entry.solution.potential = potential.value;
    if (!is_finite(entry.solution) || unknown_coordinate(entry.solution)) continue;
    entries.push_back(std::move(entry));
  }
  std::ranges::stable_sort(entries, {}, [](const Entry& e) { return e.potential.value; });
  for (Entry& e : entries)
    out.equilibria.push_back(std::move(e.solution));
  if (options.friction && has_friction(*s.mechanism) && !problem.cancelled())
    for (Solution& state : find_friction_states(*s.mechanism, options)) {
      const bool slips = std::ranges::any_of(state.frictions, &FrictionForce::slips);
      if (slips || entries.empty()) out.equilibria.push_back(std::move(state)); // else bands tell of it
    }
  // What stands turned against the drawn pose is looked for where nothing holds as drawn.
  const bool may_turn = !s.system.torques.empty() && !options.nearest;
  if (out.equilibria.empty() && may_turn && !problem.cancelled()) {
    SolveOptions turned = options;
    turned.search = 0; // looked for above
    turned.friction = false;
    Solution solution = solve_through(turned);
    if (solution.status == Status::converged && s.turned) out.equilibria.push_back(std::move(solution));
  }
  out.message = out.equilibria.empty() && !undetermined.empty() ? undetermined : message(out);
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (!entries[i].kinks.empty()) out.message += " In " + std::to_string(i + 1) + ": " + entries[i].kinks;
  return out;
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
