#include "app/session/response_design.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/session.hpp"
#include "app/session/units.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

// What the drive gives by a law, or else all that it gives.
void add_drive(const Mechanism& mechanism, const DriveTorque& drive, std::vector<DesignGoal>& goals) {
  const std::string name = coordinate_label(drive), words = coordinate_words(drive),
                    unit = drive.angle ? "N m" : "N", kind = drive.angle ? "torque" : "force";
  if (!drive.given) {
    if (!drive.varying)
      goals.push_back({.key = "torque(" + coordinate_argument(name) + ")",
                       .title = "drive " + kind + " of " + words,
                       .quantity = "drive " + name,
                       .unit = unit,
                       .value = drive.value,
                       .expression = "torque(" + coordinate_argument(name) + ")"});
    return;
  }
  const auto joint = std::ranges::find(mechanism.joints, drive.joint, &Joint::name);
  if (joint == mechanism.joints.end()) return;
  if (const Formula* law = drive_law(mechanism, *joint, drive.index, "torque"))
    goals.push_back({.key = "given " + name,
                     .title = "drive " + kind + " of " + words,
                     .quantity = "given " + name,
                     .unit = unit,
                     .value = drive.given->torque,
                     .expression = law->text});
  if (const Formula* law = drive_law(mechanism, *joint, drive.index, "load"))
    goals.push_back({.key = "load " + name,
                     .title = "load on " + words,
                     .quantity = "load " + name,
                     .unit = unit,
                     .value = drive.given->load,
                     .expression = law->text});
}

// The mechanism with a measure of the goal, whose name it returns.
std::string add_measure(Mechanism& mechanism, const DesignGoal& goal) {
  NamedMeasure measure{.name = "wanted", .description = {}, .text = goal.expression, .unit = goal.unit};
  const auto taken = [&](const std::string& name) {
    return std::ranges::find(mechanism.joints, name, &Joint::name) != mechanism.joints.end() ||
           std::ranges::find(mechanism.measures, name, &NamedMeasure::name) != mechanism.measures.end() ||
           std::ranges::find(mechanism.parameters, name, &NamedParameter::name) !=
               mechanism.parameters.end() ||
           std::ranges::find(mechanism.points, name, &NamedPoint::name) != mechanism.points.end();
  };
  while (taken(measure.name))
    measure.name += "_";
  mechanism.measures.push_back(measure);
  return measure.name;
}

// On the branches that hang together with the drawn pose's, as a curve has them, or on all.
DesignAnswer solutions_on(const DesignRequest& request, const DesignOptions& options) {
  const auto ask = [&](const Mechanism& mechanism, const std::string& name) {
    return design(mechanism, request.of.address, request.of.from, request.of.to, name, request.value,
                  options);
  };
  if (request.goal.expression.empty()) return ask(*request.of.mechanism, request.goal.key);
  Mechanism with = *request.of.mechanism;
  const std::string name = add_measure(with, request.goal);
  DesignAnswer answer = ask(with, name);
  answer.wanted = request.goal.title;
  for (DesignSolution& solution : answer.solutions)
    std::erase_if(solution.at.measures, [&](const MeasureSolution& m) { return m.name == name; });
  return answer;
}

// What a curve shows is told at once, other poses when they are found.
DesignAnswer find_solutions(const DesignRequest& request, const TaskContext<DesignAnswer>& context) {
  DesignOptions options;
  options.largest_step = response_step(request.of);
  options.cancel = &context.cancel;
  options.progress = context.progress;
  options.all = false;
  DesignAnswer connected = solutions_on(request, options);
  const bool found = connected.end == DesignEnd::found;
  if (found) context.publish(connected);
  options.all = true;
  DesignAnswer all = solutions_on(request, options);
  all.run_time_s += connected.run_time_s;
  return all.end == DesignEnd::cancelled && found ? connected : all;
}

std::vector<DesignGoal> goals_now(const Session& session) {
  const bool solved = converged(session);
  const Solution& solution = session.answer.solution;
  std::vector<DesignGoal> goals;
  for (const CoordinateSolution& c : solved ? solution.coordinates : session.answer.summary.coordinates)
    if (const auto found = found_number(c); found && !c.dependent)
      goals.push_back({.key = found->name,
                       .title = found_words(c),
                       .quantity = "value " + found->name,
                       .unit = std::string(found->unit),
                       .value = solved ? std::optional(found->value) : std::nullopt,
                       .place = !c.speed});
  for (const NamedMeasure& measure : session.mechanism().measures) {
    DesignGoal& goal = goals.emplace_back(DesignGoal{.key = measure.name,
                                                     .title = measure.name,
                                                     .quantity = "measure " + measure.name,
                                                     .unit = measure.unit,
                                                     .value = {}});
    if (!solved) continue;
    for (const MeasureSolution& m : solution.measures)
      if (m.name == measure.name) goal.value = m.value;
  }
  if (!solved) return goals;
  for (const DriveTorque& drive : solution.drive_torques)
    add_drive(session.mechanism(), drive, goals);
  for (const Reaction& r : solution.reactions) {
    if (r.varying) continue;
    const std::string of = "(" + argument_text(r.joint) + ")";
    const auto add = [&](const char* function, const char* word, const char* unit, const Vec3& value) {
      goals.push_back({.key = function + of,
                       .title = word + (" through " + r.joint),
                       .quantity = word + (" " + r.joint),
                       .unit = unit,
                       .value = value.norm(),
                       .expression = function + of});
    };
    if (!r.open.force.any()) add("reaction", "force", "N", r.force);
    if (!r.open.torque.any()) add("moment", "torque", "N m", r.torque);
  }
  return goals;
}

} // namespace

const DesignGoals& design_goals(Session& session) {
  DesignGoals& offered = session.study.response.design.offered;
  const std::shared_ptr<const Mechanism>& mechanism = session.document.shared();
  if (offered.mechanism == mechanism && offered.answer == session.answer.ticket) return offered;
  offered = {goals_now(session), {}, mechanism, session.answer.ticket};
  for (const DesignGoal& goal : offered.goals)
    offered.titles.push_back(goal.title);
  return offered;
}

void take_design(Session& session) {
  auto& answer = session.study.response.design.answer;
  if (!answer.take()) return;
  if (!answer.problem.empty()) answer.found.reset();
  if (!answer.found) return;
  // Stable states first, then those that are like the present one.
  std::ranges::stable_sort(answer.found->result.solutions, {}, [&](const DesignSolution& s) {
    return std::pair(s.at.stable != true,
                     scaled_distance(s.at.coordinates, session.answer.solution.coordinates));
  });
}

void find_design(Session& session) {
  ResponseDesign& wanted = session.study.response.design;
  const std::optional<ResponseRequest> of = response_wanted(session);
  const std::vector<DesignGoal>& goals = design_goals(session).goals;
  const auto chosen = std::ranges::find(goals, wanted.coordinate, &DesignGoal::key);
  std::optional<DesignGoal> goal = chosen == goals.end() ? std::nullopt : std::optional(*chosen);
  // Where there is no state now there is no torque to offer: what was asked for is asked for still.
  if (const auto& asked = wanted.answer.asked; !goal && asked && asked->goal.key == wanted.coordinate)
    goal = asked->goal;
  if (!of || !goal) return;
  // The same question about a mechanism that is being changed: every answer is worth seeing.
  const auto& found = wanted.answer.found;
  const bool same = found && found->of.goal.key == goal->key && found->of.value == wanted.value;
  wanted.answer.ask(session.options, {*of, std::move(*goal), wanted.value}, find_solutions,
                    same ? ResponseCurve::Running::finished : ResponseCurve::Running::cancelled);
  take_design(session);
}

std::string design_words(const Session& session) {
  const auto& found = session.study.response.design.answer.found;
  if (!found) return {};
  const ResponseRequest& of = found->of.of;
  const ShownUnit wanted = shown_unit(found->of.goal.unit, session.units),
                  varied = shown_unit(parameter_unit(*of.mechanism, of.address), session.units);
  return with_phrase(design_message(found->result, of.from, of.to, true,
                                    {.wanted = found->of.goal.title,
                                     .wanted_unit = wanted.text,
                                     .varied = number_phrase(*of.mechanism, of.address),
                                     .varied_unit = varied.text,
                                     .shown = [&](double si) { return wanted.shown(si); },
                                     .shown_varied = [&](double si) { return varied.shown(si); }}),
                     of.address);
}

void go_to_design(Session& session, const DesignSolution& solution) {
  if (const auto& found = session.study.response.design.answer.found)
    go_to_state(session, found->of.of.address, solution.parameter, start_values(solution.at.coordinates));
}

} // namespace flyball
