#include "app/ui/load_view.hpp"

#include "app/session/session.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/view_state.hpp"

#include <algorithm>

namespace flyball {

namespace {

// Since the drawn phase; nothing where the loads change as the drives turn.
std::optional<Quat> turn_of_loads(const Session& session) {
  const Solution& solution = session.answer.solution;
  if (session.playback.time == 0) return Quat::Identity();
  return common_turn(*session.answer.mechanism, solution, session.poses);
}

// Of a motion that is shown in the steady state's place: a periodic one, or that of the motion's panel.
struct Moment {
  const Run* motion = nullptr;
  double time = 0; // s
};

std::optional<Moment> moment_of_panel(const Session& session) {
  const MotionState& motion = session.motion;
  if (!motion.shown.run || !session.answer.mechanism ||
      motion.poses.size() != session.answer.mechanism->bodies.size())
    return std::nullopt;
  return Moment{motion.shown.run.get(), motion.shown.time};
}

std::optional<Moment> shown_moment(const Session& session) {
  if (converged(session)) return std::nullopt;
  const PeriodicStudy::Posed& posed = session.study.periodic.posed;
  const bool periodic = periodic_motion(session) && posed.motion &&
                        session.answer.mechanism->bodies.size() == session.poses.size();
  if (!periodic) return moment_of_panel(session);
  return Moment{posed.motion.get(), posed.time < 0 ? posed.time + posed.motion->time.back() : posed.time};
}

bool may_show_loads(const Session& session, const ToolState& tool, const ViewState& view) {
  return view.loads && !tool.pull && session.mode == Mode::explore && converged(session) &&
         session.answer.mechanism->bodies.size() == session.poses.size();
}

} // namespace

bool shows_diagram(const ViewState& view) {
  return view.scene.source.loads && view.scene.scene && view.scene.scene->diagram;
}

bool shows_roots(const ViewState& view) {
  if (view.load_lengths && !shows_diagram(view)) return *view.load_lengths == LoadLengths::by_cube_root;
  return view.scene.scene && view.scene.scene->arrows.scales.lengths() == LoadLengths::by_cube_root;
}

bool shows_moment(const Session& session) {
  return shown_moment(session).has_value();
}

void show_loads(const Session& session, const ToolState& tool, const ViewState& view, ViewFrame& frame) {
  frame.load_lengths = view.load_lengths;
  const auto choose_body = [&] {
    const auto is_body = [](const PartId& part) { return part.kind == PartKind::body; };
    if (std::ranges::count_if(frame.selected, is_body) == 1)
      frame.loads_body = std::ranges::find_if(frame.selected, is_body)->index;
  };
  if (const auto moment = shown_moment(session);
      moment && view.loads && !tool.pull && session.mode == Mode::explore) {
    frame.loads_motion = moment->motion;
    frame.loads_time = moment->time;
    return choose_body();
  }
  if (!may_show_loads(session, tool, view)) return;
  const std::optional<Quat> turn = turn_of_loads(session);
  if (!turn) return;
  frame.loads = &session.answer.solution;
  frame.loads_turning = session.answer.turning;
  frame.loads_turn = *turn;
  choose_body();
}

void show_motion_loads(const Session& session, const ViewState& view, ViewFrame& frame) {
  const bool wanted = frame.loads || frame.loads_motion;
  frame.loads = nullptr;
  frame.loads_motion = nullptr;
  const auto moment = moment_of_panel(session);
  if (!wanted || !moment || !view.scene.scene) return;
  frame.loads_motion = moment->motion;
  frame.loads_time = moment->time;
  frame.load_scales = &view.scene.scene->arrows.scales;
}

std::string loads_missing(const Session& session, const ToolState& tool, const ViewState& view) {
  if (!view.loads || session.mechanism().bodies.empty()) return {};
  if (session.mode == Mode::build) return "Forces: while exploring (Tab)";
  if (tool.pull) return "Forces: when nothing is pulled";
  if (shows_moment(session)) return {};
  if (!converged(session)) return "Forces: no steady state";
  if (may_show_loads(session, tool, view) && !turn_of_loads(session))
    return "Forces change as it turns: at the drawn phase only";
  return {};
}

} // namespace flyball
