// A body of the steady state dragged to where it should be: the pinned sliders that are not held follow, so
// that it settles there, or as near as they can bring it. Time stands meanwhile.
#include "app/session/units.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/result_functions.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flyball {

namespace {

constexpr double reached_within = 4; // pixels: nearer than this no way is drawn

// The hand's bodies are those of the answer; while a new document's is awaited there are none.
bool reach_fits(const Session& session, const ReachGrab& grab) {
  return converged(session) && session.opened == grab.opened &&
         session.poses.size() == session.mechanism().bodies.size() &&
         body_index(session.mechanism(), grab.body) >= 0;
}

// Where the grabbed point is now (m, world, at the phase shown).
Vec3 reached_point(const Session& session, const ReachGrab& grab) {
  const Pose& pose = session.poses[static_cast<std::size_t>(body_index(session.mechanism(), grab.body))];
  return pose.position + pose.rotation * grab.local;
}

std::string free_point_name(const Mechanism& mechanism) {
  std::string name = "hand";
  const auto taken = [&](const std::string& each) {
    return parameter_index(mechanism, each) >= 0 || point_index(mechanism, each) >= 0 ||
           measure_index(mechanism, each) >= 0 || joint_index(mechanism, each) >= 0;
  };
  while (taken(name) || taken(name + "_right") || taken(name + "_up"))
    name += "_";
  return name;
}

// The grabbed point as a named one, which goes along when expressions move the body.
NamedPoint grabbed_point(const Mechanism& mechanism, const ReachGrab& grab, std::string name) {
  const Body& body = mechanism.bodies[static_cast<std::size_t>(body_index(mechanism, grab.body))];
  const Vec3 offset = body.rotation.normalized() * grab.local;
  NamedPoint point{std::move(name), body.position + offset, {}};
  for (int i = 0; i < 3; ++i)
    for (const Formula& formula : body.formulas)
      if (formula.key == "position." + std::to_string(i))
        point.formulas.push_back(
            {std::to_string(i), fmt::format("({}) + ({:.17g} m)", formula.text, offset[i])});
  return point;
}

// The hand's place in the two directions of the screen, as goals of measures that a copy of the mechanism
// has. Across the screen it does not matter where the body goes.
void seek_hand(Session& session, const ReachGrab& grab, const ViewInput& input) {
  const Mechanism& m = session.mechanism();
  const int holder = body_index(m, *grab.holder); // -1: the ground
  const Vec3 hand = drawn_point(m, session.poses, holder, grab.hand);
  const auto turned = [&](const Vec3& direction) -> Vec3 {
    if (holder < 0) return direction;
    const auto i = static_cast<std::size_t>(holder);
    return m.bodies[i].rotation.normalized() * (session.poses[i].rotation.conjugate() * direction);
  };
  auto with_hand = std::make_shared<Mechanism>(m);
  const std::string name = free_point_name(m);
  with_hand->points.push_back(grabbed_point(m, grab, name));
  const std::string at = argument_text(grab.body) + "@" + name;
  std::vector<Goal> goals;
  for (const Vec3& direction : {turned(input.camera.right()), turned(input.camera.screen_up())}) {
    const std::string measure = name + (goals.empty() ? "_right" : "_up");
    with_hand->measures.push_back({measure, "",
                                   fmt::format("({:.17g}) * x({}) + ({:.17g}) * y({}) + ({:.17g}) * z({})",
                                               direction.x(), at, direction.y(), at, direction.z(), at),
                                   "m"});
    goals.push_back({measure, direction.dot(hand), 1});
  }
  seek(session, "Drag " + grab.body + " to a goal", std::move(goals), {}, {std::move(with_hand)});
}

void draw_reach(const Session& session, const Ui& ui, const ReachGrab& grab, const ViewInput& input) {
  const auto from = input.on_screen(reached_point(session, grab)), to = input.on_screen(grab.hand);
  if (!from || !to) return;
  const double away = std::hypot(to->x - from->x, to->y - from->y);
  if (grab.moved && away > reached_within * static_cast<double>(ui.scale))
    draw_line(ui, *from, *to, palette(ui.theme).accent, 1.5f);
  draw_dot(ui, *from, 4);
  draw_dot(ui, *to, 6, true);
  const GoalAnswer* answer = sought(session);
  if (!grab.moved || !answer) return;
  std::string words, numbers;
  int told = 0;
  for (const GoalAnswer::Number& number : answer->numbers) {
    const auto control = std::ranges::find(session.parameters, number.address, &ParameterControl::address);
    if (control == session.parameters.end() || told == 3) continue;
    const ShownUnit unit = shown_unit(control->unit, session.units);
    numbers += (told++ ? "  " : "") + control->name + " " + short_text(unit.shown(number.value), 4) +
               (unit.text.empty() ? "" : " " + unit.text) + (number.at_limit ? " (end)" : "");
  }
  if (away > reached_within * static_cast<double>(ui.scale)) words = "the nearest";
  draw_tag(ui, input, input.cursor, words, numbers);
}

} // namespace

void take_reach(Session& session, ToolState& tool, const ViewInput& input, const HandHit& hit) {
  tool.spent = true;
  const Mechanism& m = session.mechanism();
  if (!converged(session) || session.poses.size() != m.bodies.size() || solving(session)) return;
  if (const std::string refusal = goal_refusal(session); !refusal.empty())
    return show_error(session, refusal);
  tool.spent = false;
  const int body = body_index(m, hit.body);
  if (body < 0) return;
  const Pose& pose = session.poses[static_cast<std::size_t>(body)];
  ReachGrab grab;
  grab.body = hit.body;
  grab.local = pose.rotation.conjugate() * (hit.point - pose.position);
  grab.plane = {.through = hit.point, .normal = input.camera.backward()};
  grab.hand = hit.point;
  grab.opened = session.opened;
  grab.position = session.document.position();
  grab.playing = session.playback.playing;
  session.playback.playing = false;
  session.notice.clear();
  const BodyPoint grip{hit.body, drawn_point(m, session.poses, body, hit.point)};
  tool.reach = std::move(grab);
  ask_held(session, session.document.shared(), start_values(session.answer.solution.coordinates), grip,
           session.on_branch);
}

void hold_reach(Session& session, const Ui& ui, ToolState& tool, const ViewInput& input) {
  ReachGrab& grab = *tool.reach;
  if (!reach_fits(session, grab)) return;
  if (input.moved)
    if (const auto at = on_plane(grab.plane, input.ray()); at && grab.holder && *at != grab.hand) {
      grab.hand = *at;
      grab.moved = true;
      seek_hand(session, grab, input);
    }
  draw_reach(session, ui, grab, input);
}

void let_go_reach(Session& session, ToolState& tool, bool keep) {
  const ReachGrab grab = *tool.reach;
  tool.reach.reset();
  session.playback.playing = grab.playing;
  if (keep) return;
  stop_seeking(session);
  if (session.document.position() > grab.position) go_to_step(session, grab.position);
}

void follow_reach(const Session& session, ToolState& tool) {
  std::optional<ReachGrab>& reach = tool.reach;
  if (!reach) return;
  if (reach->opened != session.opened) return reach.reset();
  if (reach->holder || !session.answer.grip || session.answer.ticket != session.awaited) return;
  // What the drives themselves turn can be moved along the axis at least: the hand stands still then.
  reach->holder =
      session.answer.grip->holder.empty() ? std::string(ground_name) : session.answer.grip->holder;
}

} // namespace flyball
