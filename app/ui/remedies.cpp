// What a person can do at once where there is no steady state, or where what stands in bearings is not
// turned.
#include "app/ui/remedies.hpp"

#include "app/document/remedies.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace flyball {

namespace {

// Buttons in rows of the panel's width.
class Buttons {
 public:
  explicit Buttons(Ui& ui)
      : ui_(ui), right_(ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x) {}

  void add(const std::string& name, const char* text, const char* help, std::function<void()> act,
           bool primary = false) {
    const float width = ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (!first_ && ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width < right_)
      ImGui::SameLine();
    first_ = false;
    if (text_button(ui_, "results/remedy/" + name, text, primary)) later(ui_, std::move(act));
    help_on_hover(help);
  }
  // What those that follow mend, in words above them.
  void about(const std::string& words) {
    paragraph(words, colors_of(ui_).dim);
    first_ = true;
  }

 private:
  Ui& ui_;
  float right_;
  bool first_ = true;
};

std::vector<RunawayCoordinate> holdable(const Session& session) {
  std::vector<RunawayCoordinate> found;
  for (const UnheldCoordinate& c : session.answer.solution.unheld)
    if (RunawayCoordinate runaway{c.joint, c.index, c.force}; can_hold(session.mechanism(), runaway))
      found.push_back(std::move(runaway));
  return found;
}

void show_how_it_moves(Session& session) {
  if (session.study.open == StudyKind::motion && session.motion.on) {
    set_mode(session, Mode::explore);
    restart_motion(session);
  } else {
    if (session.study.open == StudyKind::motion)
      session.study.open = StudyKind::none; // open_study() would close it
    open_study(session, StudyKind::motion);
  }
}

void set_gravity(Session& session, const std::string& step, const Vec3& gravity) {
  edit(session, step, [&](Mechanism& mechanism, Selection&) { mechanism.gravity = gravity; });
}

void holding_buttons(Buttons& buttons, Session& session) {
  const std::vector<RunawayCoordinate> found = holdable(session);
  if (found.empty()) return;
  const bool one = found.size() == 1;
  const std::string to =
      one ? " to " + found[0].joint : "s to " + std::to_string(found.size()) + " coordinates";
  buttons.add(
      "spring", one ? "Add a spring" : "Add springs",
      "A spring, slack as drawn and stiff enough to hold after about a fifth of the mechanism's size.",
      [&session, found, to] {
        edit(session, "Add spring" + to, [&](Mechanism& mechanism, Selection&) {
          for (const RunawayCoordinate& c : found)
            add_holding_spring(mechanism, c);
        });
      },
      true);
  buttons.add("stop", one ? "Add a stop" : "Add stops", "A stop on the side that it moves to.",
              [&session, found, to] {
                edit(session, "Add stop" + to, [&](Mechanism& mechanism, Selection&) {
                  for (const RunawayCoordinate& c : found)
                    add_holding_stop(mechanism, c);
                });
              });
}

void steady_state_buttons(Buttons& buttons, Session& session) {
  const Solution& solution = session.answer.solution;
  holding_buttons(buttons, session);
  if (solution.weight_turns)
    if (const auto along = gravity_along_drives(session.mechanism()))
      buttons.add(
          "gravity along", "Turn gravity along the axis",
          "Gravity of the same size along the axis of the drive, so that the weight does not turn with it.",
          [&session, along = *along] { set_gravity(session, "Turn gravity along the axis", along); }, true);
  if (solution.weight_turns || (!solution.unheld.empty() && solution.unheld_by_weight))
    buttons.add("gravity off", "Turn gravity off", "No gravity; the scene's inspector has it back.",
                [&session] { set_gravity(session, "Turn gravity off", Vec3::Zero()); });
  const bool alone = solution.unheld.empty() && !solution.weight_turns;
  buttons.add(
      "motion", "Show the motion", "How it moves from the drawn pose, which needs no steady state.",
      [&session] { show_how_it_moves(session); }, alone);
}

// A drive for what stands in elastic bearings and nothing turns, or nothing but a hinge that makes these
// idle.
void bearing_buttons(Buttons& buttons, Session& session, const std::vector<BodyInBearings>& bodies) {
  for (const auto& [body, hinge] : bodies) {
    buttons.about(hinge.empty() ? "Nothing turns " + body + " in its bearings."
                                : hinge + " holds " + body + " rigidly: its bearings bear nothing.");
    buttons.add(
        "drive/" + body,
        (hinge.empty() ? "Drive " + body + " in its bearings" : "Let " + body + " move in its bearings")
            .c_str(),
        command("edit.bearing_drive").help, [&session, name = body] { drive_in_bearings(session, name); },
        true);
  }
}

} // namespace

void remedies(Session& session, Ui& ui, InBearings& in_bearings) {
  const Solution& solution = session.answer.solution;
  const bool none = solution.status == Status::not_converged || solution.status == Status::no_steady_state;
  if (in_bearings.of != session.document.shared())
    in_bearings = {session.document.shared(), bodies_in_bearings(session.mechanism())};
  if (!none && in_bearings.bodies.empty()) return;
  ImGui::Dummy({0, 2 * ui.scale});
  Buttons buttons(ui);
  bearing_buttons(buttons, session, in_bearings.bodies);
  if (none) steady_state_buttons(buttons, session);
  ImGui::Dummy({0, 2 * ui.scale});
}

std::string unheld_words(const Solution& solution) {
  std::vector<std::string> names;
  for (const UnheldCoordinate& c : solution.unheld)
    if (std::string name = joint_words(c.joint); std::ranges::find(names, name) == names.end())
      names.push_back(std::move(name));
  return names.empty() ? "" : "Nothing holds " + name_list(names);
}

} // namespace flyball
