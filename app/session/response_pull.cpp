#include "app/session/response_pull.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/measure_plan.hpp"

namespace flyball {

std::string pulled_goal(const Session& session) {
  const std::string& key = session.study.response.choice.quantity;
  for (const CoordinateSolution& c : session.answer.solution.coordinates)
    if (const auto found = found_number(c); found && !c.dependent && key == "value " + found->name)
      return found->name;
  for (const NamedMeasure& measure : session.mechanism().measures)
    if (key == "measure " + measure.name) return measure.name;
  return {};
}

std::string pull_words(const Session& session) {
  if (const std::string refusal = goal_refusal(session); !refusal.empty())
    return "Pulled up or down, the curve would go along. " + refusal;
  const std::string goal = pulled_goal(session), &address = session.study.response.choice.address,
                    phrase = number_phrase(session.mechanism(), address);
  if (!another_may_move(session, address))
    return "Pull up or down to where " + goal + " should be: " + phrase +
           " follows. No other pinned slider may move.";
  return "Pull up or down to where " + goal +
         " should be: the other pinned sliders that are not held follow." +
         (is_held(session, address) ? "" : " Sideways sets " + phrase + ".");
}

void pull_response(Session& session, std::optional<double> parameter, double value) {
  const std::string goal = pulled_goal(session);
  if (goal.empty()) return;
  const std::string& address = session.study.response.choice.address;
  const std::string step = "Bring " + goal + " to a goal";
  if (!another_may_move(session, address))
    seek(session, step, {{goal, value}});
  else if (parameter && !is_held(session, address))
    seek_beside(session, step, {{goal, value}}, {address, *parameter});
  else
    seek(session, step, {{goal, value}}, address);
}

} // namespace flyball
