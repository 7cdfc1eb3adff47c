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
bool reach_fits(const App& app, const ReachGrab& grab) {
  return converged(app) && app.opened == grab.opened && app.poses.size() == app.mechanism().bodies.size() &&
         body_index(app.mechanism(), grab.body) >= 0;
}

// Where the grabbed point is now (m, world, at the phase shown).
Vec3 reached_point(const App& app, const ReachGrab& grab) {
  const Pose& pose = app.poses[static_cast<std::size_t>(body_index(app.mechanism(), grab.body))];
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
void seek_hand(App& app, const ReachGrab& grab, const ViewInput& input) {
  const Mechanism& m = app.mechanism();
  const int holder = body_index(m, *grab.holder); // -1: the ground
  const Vec3 hand = drawn_point(m, app.poses, holder, grab.hand);
  const auto turned = [&](const Vec3& direction) -> Vec3 {
    if (holder < 0) return direction;
    const auto i = static_cast<std::size_t>(holder);
    return m.bodies[i].rotation.normalized() * (app.poses[i].rotation.conjugate() * direction);
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
  seek(app, "Drag " + grab.body + " to a goal", std::move(goals), {}, {std::move(with_hand)});
}

void draw_reach(const App& app, const ReachGrab& grab, const ViewInput& input) {
  const auto from = input.on_screen(reached_point(app, grab)), to = input.on_screen(grab.hand);
  if (!from || !to) return;
  const double away = std::hypot(to->x - from->x, to->y - from->y);
  if (grab.moved && away > reached_within * static_cast<double>(app.scale))
    draw_line(app, *from, *to, palette(app.theme).accent, 1.5f);
  draw_dot(app, *from, 4);
  draw_dot(app, *to, 6, true);
  const GoalAnswer* answer = sought(app);
  if (!grab.moved || !answer) return;
  std::string words, numbers;
  int told = 0;
  for (const GoalAnswer::Number& number : answer->numbers) {
    const auto control = std::ranges::find(app.parameters, number.address, &ParameterControl::address);
    if (control == app.parameters.end() || told == 3) continue;
    const ShownUnit unit = shown_unit(control->unit, app.units);
    numbers += (told++ ? "  " : "") + control->name + " " + short_text(unit.shown(number.value), 4) +
               (unit.text.empty() ? "" : " " + unit.text) + (number.at_limit ? " (end)" : "");
  }
  if (away > reached_within * static_cast<double>(app.scale)) words = "the nearest";
  draw_tag(app, input, input.cursor, words, numbers);
}

} // namespace

void take_reach(App& app, const ViewInput& input, const HandHit& hit) {
  app.tool.spent = true;
  const Mechanism& m = app.mechanism();
  if (!converged(app) || app.poses.size() != m.bodies.size() || solving(app)) return;
  if (const std::string refusal = goal_refusal(app); !refusal.empty()) return show_error(app, refusal);
  app.tool.spent = false;
  const int body = body_index(m, hit.body);
  if (body < 0) return;
  const Pose& pose = app.poses[static_cast<std::size_t>(body)];
  ReachGrab grab;
  grab.body = hit.body;
  grab.local = pose.rotation.conjugate() * (hit.point - pose.position);
  grab.plane = {.through = hit.point, .normal = input.camera.backward()};
  grab.hand = hit.point;
  grab.opened = app.opened;
  grab.position = app.document.position();
  grab.playing = app.playback.playing;
  app.playback.playing = false;
  app.notice.clear();
  const BodyPoint grip{hit.body, drawn_point(m, app.poses, body, hit.point)};
  app.tool.reach = std::move(grab);
  ask_held(app, app.document.shared(), start_values(app.answer.solution.coordinates), grip, app.on_branch);
}

void hold_reach(App& app, const ViewInput& input) {
  ReachGrab& grab = *app.tool.reach;
  if (!reach_fits(app, grab)) return;
  if (input.moved)
    if (const auto at = on_plane(grab.plane, input.ray()); at && grab.holder && *at != grab.hand) {
      grab.hand = *at;
      grab.moved = true;
      seek_hand(app, grab, input);
    }
  draw_reach(app, grab, input);
}

void let_go_reach(App& app, bool keep) {
  const ReachGrab grab = *app.tool.reach;
  app.tool.reach.reset();
  app.playback.playing = grab.playing;
  if (keep) return;
  stop_seeking(app);
  if (app.document.position() > grab.position) go_to_step(app, grab.position);
}

void follow_reach(App& app) {
  std::optional<ReachGrab>& reach = app.tool.reach;
  if (!reach) return;
  if (reach->opened != app.opened) return reach.reset();
  if (reach->holder || !app.answer.grip || app.answer.ticket != app.awaited) return;
  // What the drives themselves turn can be moved along the axis at least: the hand stands still then.
  reach->holder = app.answer.grip->holder.empty() ? std::string(ground_name) : app.answer.grip->holder;
}

} // namespace flyball
