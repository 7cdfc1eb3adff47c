#include "app/session/goals.hpp"

#include "app/session/session.hpp"
#include "app/session/units.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {

namespace {

GoalAnswer find_numbers(const GoalRequest& request, const TaskContext<GoalAnswer>& context) {
  GoalOptions options;
  options.start = request.start;
  options.details = false;
  options.cancel = &context.cancel;
  return seek_goals(*request.mechanism, request.free, request.goals, options);
}

// Where a hand that begins now counts changes from.
void begin_gesture(Session& session) {
  GoalState& state = session.goals;
  if (state.gesture == session.gesture) return;
  state.gesture = session.gesture;
  state.reference.clear();
  for (const ParameterControl& control : session.parameters)
    if (control.group == ParameterGroup::pinned) state.reference.emplace_back(control.address, control.value);
}

std::vector<FreeNumber> free_numbers(const Session& session, const std::string& but) {
  std::vector<FreeNumber> free;
  for (const ParameterControl& control : session.parameters) {
    if (control.group != ParameterGroup::pinned || is_held(session, control.address) ||
        control.address == but)
      continue;
    const auto before =
        std::ranges::find(session.goals.reference, control.address, &std::pair<std::string, double>::first);
    // A number that was typed beyond its slider may go back, not farther out.
    free.push_back({control.address, std::min({control.from, control.to, control.value}),
                    std::max({control.from, control.to, control.value}),
                    before == session.goals.reference.end() ? control.value : before->second});
  }
  return free;
}

void ask(Session& session, const std::string& step, std::vector<Goal> goals, const std::string& but,
         SharedMechanism mechanism, Explored set) {
  begin_gesture(session);
  session.goals.revision = session.document.revision();
  std::string refusal = goal_refusal(session);
  GoalRequest request{.mechanism = std::move(mechanism),
                      .free = free_numbers(session, but),
                      .goals = std::move(goals),
                      .start = start_values(session.answer.solution.coordinates),
                      .set = std::move(set),
                      .step = step};
  if (refusal.empty() && request.free.empty())
    refusal = "No other pinned slider may move: pin one by its gear or with Ctrl+L.";
  if (!refusal.empty()) return show_error(session, refusal);
  Study<GoalRequest, GoalAnswer>& seeking = session.goals.seeking;
  const auto& asked = seeking.asked;
  // What the hand asks for last is sought when the one before is found: something new is seen all the time.
  if (!asked || asked->goals != request.goals || asked->set != request.set || !seeking.running())
    seeking.ask(session.options, std::move(request), find_numbers, BackgroundWorker::Running::finished);
}

} // namespace

bool is_held(const Session& session, const std::string& address) {
  return std::ranges::find(session.goals.held, address) != session.goals.held.end();
}

void hold_number(Session& session, const std::string& address, bool held) {
  std::erase(session.goals.held, address);
  if (held) session.goals.held.push_back(address);
}

bool another_may_move(const Session& session, const std::string& but) {
  return !free_numbers(session, but).empty();
}

std::string goal_refusal(const Session& session) {
  if (!converged(session)) return "There is no steady state to set out from.";
  const auto pinned =
      std::ranges::count(session.parameters, ParameterGroup::pinned, &ParameterControl::group);
  if (pinned == 0)
    return "Only pinned sliders follow, and none is pinned: pin one by its gear or with Ctrl+L.";
  if (free_numbers(session, {}).empty()) return "No number may move: all pinned sliders are held.";
  return {};
}

void seek(Session& session, const std::string& step, std::vector<Goal> goals, const std::string& but) {
  seek(session, step, std::move(goals), but, {session.document.shared()});
}

void seek(Session& session, const std::string& step, std::vector<Goal> goals, const std::string& but,
          SharedMechanism mechanism) {
  ask(session, step, std::move(goals), but, std::move(mechanism), {});
}

void seek_beside(Session& session, const std::string& step, std::vector<Goal> goals,
                 const ExploredValue& number) {
  auto there = std::make_shared<Mechanism>(session.mechanism());
  try {
    set_parameter(*there, number.address, number.value);
  } catch (const SceneError& error) {
    return show_error(session, error.what());
  }
  ask(session, step, std::move(goals), number.address, {std::move(there)}, {number});
}

void stop_seeking(Session& session) {
  session.goals.revision = 0;
  session.goals.seeking.stop();
}

const GoalAnswer* sought(const Session& session) {
  const GoalState& state = session.goals;
  return state.gesture == session.gesture && state.seeking.found ? &state.seeking.found->result : nullptr;
}

namespace {

// What a person is to know of it, in the units that are shown; empty where all is well. Of measures that only
// the hand has nothing is listed.
std::string words_of(const Session& session, const GoalAnswer& answer) {
  std::string words;
  if (!answer.reached) {
    words = "The nearest that can be reached";
    std::string list;
    for (const GoalAnswer::Reached& goal : answer.goals) {
      const ShownUnit unit = shown_unit(goal.unit, session.units);
      const bool known = measure_index(session.mechanism(), goal.wanted) >= 0 ||
                         find_coordinate(session.mechanism(), goal.wanted).joint >= 0;
      if (known)
        list += (list.empty() ? ": " : ", ") + goal.wanted + " = " + rounded_text(unit.shown(goal.value), 6) +
                (unit.text.empty() ? "" : " " + unit.text);
    }
    words += list + ".";
    std::vector<std::string> phrases;
    for (const GoalAnswer::Number& number : answer.numbers)
      if (number.at_limit) phrases.push_back(parameter_phrase(number.address));
    const std::vector<std::string_view> limits(phrases.begin(), phrases.end());
    if (!limits.empty()) words += " At the end of its slider: " + word_list(limits, "and") + ".";
  }
  if (answer.solution.stable == false)
    words += std::string(words.empty() ? "" : " ") + "The state is unstable.";
  return words;
}

} // namespace

void update_goals(Session& session) {
  GoalState& state = session.goals;
  if (!state.seeking.take()) return;
  if (session.mode != Mode::explore || state.revision != session.document.revision()) return;
  if (!state.seeking.problem.empty()) return show_error(session, state.seeking.problem);
  if (!state.seeking.found) return;
  const GoalRequest& of = state.seeking.found->of;
  const GoalAnswer& answer = state.seeking.found->result;
  if (answer.status != Status::converged) return show_error(session, answer.message);
  Explored values = of.set;
  for (const GoalAnswer::Number& number : answer.numbers)
    values.push_back({number.address, number.value});
  go_to_numbers(session, of.step, values, start_values(answer.solution.coordinates));
  state.revision = session.document.revision();
  if (session.notice == state.told) session.notice.clear();
  state.told = words_of(session, answer);
  if (!state.told.empty()) session.notice = state.told;
}

} // namespace flyball
