// A body of the steady state pulled by a spring, which is solved with like any other; no edit. Time stands
// meanwhile.
#include "app/document/drawn_size.hpp"
#include "app/session/units.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools_hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr double stiffer = 1.25; // a notch of the wheel
constexpr double strongest = 1e4;

const Mechanism& mechanism_of(const PullGrab& grab) {
  return *grab.mechanism;
}

bool fits(const Session& session, const PullGrab& grab) {
  return session.poses.size() == mechanism_of(grab).bodies.size();
}

// Where what is pulled at is now (m, world, at the phase shown).
std::optional<Vec3> pulled_point(const Session& session, const PullGrab& grab) {
  if (!fits(session, grab)) return {};
  const int body = body_index(mechanism_of(grab), grab.grabbed.body);
  return carried_point(mechanism_of(grab), session.poses, body, *grab.grabbed.at);
}

// Asks for the steady state of this mechanism, from where the last one is.
void ask_pulled(Session& session, const PullGrab& grab, std::shared_ptr<const Mechanism> mechanism,
                std::optional<BodyPoint> grip, bool nearest = false) {
  const bool found = converged(session) && session.answer.ticket >= session.opened;
  ask_held(session, std::move(mechanism),
           found && !nearest ? start_values(session.answer.solution.coordinates) : grab.start,
           std::move(grip), nearest);
}

// The spring as the hand stands now; nothing before it is known how to take hold.
std::optional<Pull> wanted_pull(const Session& session, const PullGrab& grab) {
  if (!grab.grip || !fits(session, grab)) return {};
  const Mechanism& m = mechanism_of(grab);
  return Pull{.body = grab.grabbed.body,
              .at = *grab.grabbed.at,
              .holder = grab.grip->holder,
              .hand = drawn_point(m, session.poses, body_index(m, grab.grip->holder), grab.hand),
              .stiffness = grab.grip->stiffness * grab.strength};
}

void move_pull(Session& session, ToolState& tool) {
  PullGrab& grab = *tool.pull;
  std::optional<Pull> next = wanted_pull(session, grab);
  if (!next || next == grab.pull) return;
  // Nothing to solve for while the hand has not moved.
  if (!grab.pull && (next->hand - next->at).norm() == 0) return;
  grab.pull = std::move(next);
  ask_pulled(session, grab, pulled(mechanism_of(grab), *grab.pull), {});
  session.pulled = session.awaited;
}

// How far a body is at most from where it was, in radians or parts of the mechanism's size.
double moved_since(const Mechanism& mechanism, const std::vector<Pose>& before,
                   const std::vector<Pose>& after) {
  double most = 0;
  const double size = drawn_size(mechanism);
  for (std::size_t i = 0; i < before.size() && i < after.size(); ++i)
    most = std::max({most, (after[i].position - before[i].position).norm() / size,
                     before[i].rotation.angularDistance(after[i].rotation)});
  return most;
}

// Where it went once the hand was gone.
void tell_where(Session& session, const PullGrab& grab) {
  constexpr double same = 1e-6;
  if (!converged(session)) {
    session.notice = "Where it was let go nothing settles.";
    return;
  }
  const Solution& found = session.answer.solution;
  if (moved_since(mechanism_of(grab), grab.stood, found.poses) < same) {
    session.notice.clear();
  } else if (found.stability_reason == StabilityReason::neutral) {
    session.notice = "Nothing pulls it back: it stays where it was let go.";
  } else {
    session.notice =
        "It has gone over to another steady state, and stays there. \"Restart from drawn pose\" goes back.";
  }
}

// A wave between two pixels with straight ends; corners would throw their halo far out.
void draw_coil(const Ui& ui, ImVec2 from, ImVec2 to) {
  constexpr int turns = 8, steps = 12; // a turn
  const float dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy), s = ui.scale;
  if (length < 12 * s) return draw_line(ui, from, to, palette(ui.theme).accent, 2);
  const float half = std::min(6 * s, length / 6), end = std::min(10 * s, length / 6);
  const float ux = dx / length, uy = dy / length, wave = length - 2 * end;
  std::array<ImVec2, turns * steps + 3> points;
  std::size_t n = 0;
  const auto add = [&](float along, float across) {
    points[n++] = {from.x + along * ux - across * uy, from.y + along * uy + across * ux};
  };
  add(0, 0);
  for (int i = 0; i <= turns * steps; ++i) {
    const float part = static_cast<float>(i) / (turns * steps);
    add(end + part * wave, half * std::sin(2 * std::numbers::pi_v<float> * turns * part));
  }
  add(length, 0);
  draw_lines(ui, points, palette(ui.theme).accent, 2);
}

void draw_pull(const Session& session, const Ui& ui, const ToolState& tool, const ViewInput& input) {
  const PullGrab& grab = *tool.pull;
  const auto point = pulled_point(session, grab);
  if (!point) return;
  const auto from = input.on_screen(*point), to = input.on_screen(grab.hand);
  if (!from || !to) return;
  if (grab.pull) draw_coil(ui, *from, *to);
  draw_dot(ui, *from, 4);
  draw_dot(ui, *to, 6, true);
  if (session.pulled_too_far) return draw_tag(ui, input, input.cursor, "Nothing stable is near", "");
  const auto force = hand_force(session, tool);
  if (!force) return;
  const ShownUnit unit = shown_unit("N/m", session.units);
  draw_tag(ui, input, input.cursor, short_text(*force, 3) + " N",
           rough_text(unit.shown(grab.pull->stiffness)) + " " + unit.text);
}

} // namespace

std::optional<double> hand_force(const Session& session, const ToolState& tool) {
  const std::optional<PullGrab>& grab = tool.pull;
  if (!grab || grab->released || !grab->pull || session.pulled_too_far || !converged(session) ||
      session.answer.solution.poses.size() != grab->mechanism->bodies.size())
    return {};
  return pulling_force(*grab->mechanism, session.answer.solution.poses, *grab->pull).norm();
}

void take_pull(Session& session, ToolState& tool, const ViewInput& input, const HandHit& hit) {
  tool.spent = true;
  const Mechanism& m = session.mechanism();
  if (!converged(session) || session.poses.size() != m.bodies.size() || solving(session)) {
    if (!solving(session)) session.notice = "There is no steady state to pull out of.";
    return;
  }
  tool.spent = false;
  PullGrab grab;
  grab.mechanism = session.document.shared();
  grab.revision = session.document.revision();
  grab.start = start_values(session.answer.solution.coordinates);
  grab.stood = session.answer.solution.poses;
  grab.on_branch = session.on_branch;
  grab.playing = session.playback.playing;
  grab.grabbed = {hit.body, drawn_point(m, session.poses, body_index(m, hit.body), hit.point)};
  grab.plane = {.through = hit.point, .normal = input.camera.backward()};
  grab.hand = hit.point;
  session.playback.playing = false;
  session.notice.clear();
  tool.pull = std::move(grab);
  ask_pulled(session, *tool.pull, tool.pull->mechanism, tool.pull->grabbed, session.on_branch);
}

void hold_pull(Session& session, const Ui& ui, ToolState& tool, const ViewInput& input) {
  PullGrab& grab = *tool.pull;
  if (input.moved)
    if (const auto at = on_plane(grab.plane, input.ray())) grab.hand = *at;
  if (const auto wheel = static_cast<double>(ImGui::GetIO().MouseWheel); wheel != 0)
    grab.strength = std::clamp(grab.strength * std::pow(stiffer, wheel), 1 / strongest, strongest);
  if (input.moved || grab.pull) move_pull(session, tool);
  draw_pull(session, ui, tool, input);
}

void let_go_pull(Session& session, ToolState& tool, bool keep) {
  PullGrab& grab = *tool.pull;
  if (grab.released) return;
  grab.released = true;
  if (!grab.pull) { // nothing has been pulled yet
    session.playback.playing = grab.playing;
    tool.pull.reset();
    return;
  }
  // What is followed by hand is left where it was pulled out of it, unless all is taken back.
  session.on_branch = !keep && grab.on_branch;
  ask_pulled(session, grab, grab.mechanism, {}, !keep);
  grab.ticket = session.awaited;
}

void follow_pull(Session& session, ToolState& tool) {
  std::optional<PullGrab>& pull = tool.pull;
  if (!pull) return;
  if (pull->revision !=
      session.document.revision()) { // another mechanism, which was asked for without the hand
    pull.reset();
    return;
  }
  if (!pull->grip && session.answer.grip && session.answer.ticket == session.awaited) {
    pull->grip = session.answer.grip;
    if (pull->grip->holder.empty()) {
      session.notice = "The drives turn " + pull->grabbed.body +
                       ", and no other body turns with it, in which a hand that pulls could stand.";
      session.playback.playing = pull->playing;
      tool.spent = true;
      pull.reset();
      return;
    }
  }
  if (!pull->released || session.answer.ticket < pull->ticket) return;
  tell_where(session, *pull);
  session.playback.playing = pull->playing;
  pull.reset();
}

} // namespace flyball
