#include "engine/report/analysis_state.hpp"

#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/found_speeds.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/report/turned_measures.hpp"
#include "engine/report/turning_part.hpp"
#include "engine/report/verdict.hpp"
#include "engine/search/turned_rates.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/sensitivity.hpp"
#include "engine/stability/sign_is_open.hpp"
#include "engine/system/classify.hpp"
#include "engine/system/point_motion.hpp"

#include <algorithm>

namespace flyball {

bool Analysis::State::makes_damper(const std::string& address) const {
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

void Analysis::State::add_rates(const Problem& problem, Solution& out) {
  if (mechanism->sliders.empty() || system.nv == 0) return;
  if (turned) return add_turned_rates(problem, out);
  std::vector<std::string> addresses;
  for (const Slider& slider : mechanism->sliders)
    addresses.push_back(slider.parameter);
  const std::vector<Eigen::VectorXd> rates = sensitivities(steady.factored(problem), *mechanism, addresses);
  if (rates.empty()) return;
  Eigen::MatrixXd along;
  if (!measures.empty())
    along = measures.rates_along(problem, *mechanism, addresses, steady.found.z.q, rates, steady.elsewhere());
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (rates[i].size() == 0 || makes_damper(addresses[i])) continue; // none that is finite, or is known
    out.sensitivities.push_back(name_rates(system, addresses[i], rates[i]));
    if (measures.empty()) continue;
    const auto rate = along.col(static_cast<Eigen::Index>(i));
    out.sensitivities.back().measures.assign(rate.begin(), rate.end());
  }
}

void Analysis::State::add_turned_rates(const Problem& problem, Solution& out) {
  for (const Slider& slider : mechanism->sliders) {
    if (makes_damper(slider.parameter)) continue;
    Mechanism changed = *mechanism;
    VariedNumbers number(changed, {&slider.parameter, 1});
    const std::vector<TurnedRate> rates =
        turned_rates(problem, steady.found.z, ties, changed, number, steady.elsewhere());
    if (rates.empty() || rates[0].q.size() == 0) continue; // none that is finite
    out.sensitivities.push_back(name_rates(system, slider.parameter, rates[0].q));
    if (measures.empty()) continue;
    const Eigen::VectorXd along = turned_measure_rates(problem, steady.found.z.q, rates[0], measures, changed,
                                                       number, 0, steady.elsewhere());
    measures.bind(*mechanism, system, parameters);
    out.sensitivities.back().measures.assign(along.begin(), along.end());
  }
}

void Analysis::State::find_turned(const Problem& problem) {
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

std::string Analysis::State::turned_message() const {
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

const Parameters& Analysis::State::turning() {
  if (system.torques.empty() || !answered) return parameters;
  found = parameters;
  for (const DriveTorqueElement& torque : system.torques) {
    const auto l = static_cast<std::size_t>(torque.link);
    found.links[l].speed = answer[system.links[l].q];
  }
  return found;
}

Problem Analysis::State::prepare(const SolveOptions& options) {
  if (turned) bind_numbers();
  turned = settled = false;
  for (const BodyPoint& point : options.points)
    find_point(system, *mechanism, parameters, point);
  return {system, parameters, scaling, options.cancel, system.kkt_form};
}

void Analysis::State::explain(const Problem& problem, const Stability& stability, Solution& out) {
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

std::string Analysis::State::add_eigenvalues(const Problem& problem, const SolveOptions& options,
                                             Stability& stability) {
  const bool known_by_pivots = is_large(problem) && (pivots_decide(problem) || steady.found.minimum);
  if (options.modes <= 0 && known_by_pivots) return {};
  report_progress(options.progress, "eigenvalues");
  std::string failure;
  if (pivots_decide(problem))
    failure = add_lowest_eigenvalues(problem, steady.found.z, options.modes, steady.elsewhere(), stability);
  else if (!stability.eigenvalues || stability.few_digits) // else only the sign was looked for
    stability = stability_of(problem, steady, true, options.modes);
  keep_asked_for(problem, options.modes, stability);
  return failure;
}

void Analysis::State::conclude(const Problem& problem, SteadyState& at, Stability stability,
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

std::unique_ptr<Analysis::State> Analysis::State::compiled_anew() {
  Analysis anew(mechanism);
  anew.state_->varied = std::move(varied);
  return std::move(anew.state_);
}

void Analysis::State::go_back(std::unique_ptr<State>& state) {
  if (!state->before) return;
  std::unique_ptr<State> first = std::move(state->before);
  first->mechanism = std::move(state->mechanism);
  first->varied = std::move(state->varied);
  state = std::move(first);
}

void Analysis::State::bind_numbers() {
  on_friction.reset();
  bind(system, *mechanism, parameters);
  set_scaling(system, parameters, scaling);
  measures.bind(*mechanism, system, parameters);
  drawn_configuration(system, parameters, drawn);
}

} // namespace flyball
