#include "app/ui/load_view.hpp"

#include "app/ui/app.hpp"

#include <algorithm>

namespace flyball {

namespace {

// Since the drawn phase; nothing where the loads change as the drives turn.
std::optional<Quat> turn_of_loads(const Session& session) {
  const Solution& solution = session.answer.solution;
  if (session.playback.time == 0) return Quat::Identity();
  return common_turn(*session.answer.mechanism, solution, session.poses);
}

bool may_show_loads(const App& app) {
  return app.view.loads && !app.tool.pull && app.mode == Mode::explore && converged(app) &&
         app.answer.mechanism->bodies.size() == app.poses.size();
}

} // namespace

void show_loads(const App& app, ViewFrame& frame) {
  if (!may_show_loads(app)) return;
  const std::optional<Quat> turn = turn_of_loads(app);
  if (!turn) return;
  frame.loads = &app.answer.solution;
  frame.loads_turning = app.answer.turning;
  frame.loads_turn = *turn;
  const auto is_body = [](const PartId& part) { return part.kind == PartKind::body; };
  if (std::ranges::count_if(frame.selected, is_body) == 1)
    frame.loads_body = std::ranges::find_if(frame.selected, is_body)->index;
}

std::string loads_missing(const App& app) {
  if (!app.view.loads || app.mechanism().bodies.empty()) return {};
  if (app.mode == Mode::build) return "Forces: while exploring (Tab)";
  if (app.tool.pull) return "Forces: when nothing is pulled";
  if (!converged(app)) return "Forces: no steady state";
  if (may_show_loads(app) && !turn_of_loads(app)) return "Forces change as it turns: at the drawn phase only";
  return {};
}

} // namespace flyball
