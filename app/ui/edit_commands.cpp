#include "app/ui/edit_commands.hpp"

#include "app/document/backlash.hpp"
#include "app/document/bearing_drive.hpp"
#include "app/document/clipboard.hpp"
#include "app/document/copies.hpp"
#include "app/document/create.hpp"
#include "app/document/formula_edits.hpp"
#include "app/document/gear_kinds.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/remove.hpp"
#include "app/document/transform.hpp"
#include "app/session/session.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "engine/mechanism/text.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <unordered_set>

namespace flyball {

namespace {

// "ball1", or "3 parts".
std::string words_for(const Selection& selection) {
  if (selection.parts.size() == 1) return selection.parts.front().name;
  return std::to_string(selection.parts.size()) + " parts";
}

// "joints arm1 and knee1, force push": what goes with the selected parts though it is not selected.
std::string dependents_words(const Session& session) {
  Selection more = with_dependents(session.document.stored(), session.selection());
  std::erase_if(more.parts, [&](const Part& part) { return session.selection().has(part); });
  std::string words;
  for (const auto& [kind, word] :
       {std::pair(PartKind::joint, "joint"), std::pair(PartKind::force, "force")}) {
    const std::vector<std::string> names = more.names(kind);
    if (names.empty()) continue;
    const std::vector<std::string_view> views(names.begin(), names.end());
    words += (words.empty() ? "" : ", ") + std::string(word) + (names.size() > 1 ? "s " : " ") +
             word_list(views, "and");
  }
  return words;
}

// "measures lift and pull": what asked for results of parts that are gone.
std::string lost_measures_words(const Mechanism& before, const Mechanism& now) {
  std::vector<std::string_view> lost;
  for (const NamedMeasure& measure : before.measures)
    if (std::ranges::find(now.measures, measure.name, &NamedMeasure::name) == now.measures.end())
      lost.push_back(measure.name);
  if (lost.empty()) return {};
  return (lost.size() > 1 ? "measures " : "measure ") + word_list(lost, "and");
}

// Takes the selected parts out, and says what went with them.
void remove_selected(Session& session, const std::string& step, const std::string& done) {
  const std::string what = words_for(session.selection());
  std::string along = dependents_words(session);
  const std::uint64_t before = session.document.revision();
  edit(session, step + " " + what, [&along](Mechanism& mechanism, Selection& selection) {
    const Mechanism whole = mechanism;
    remove_parts(mechanism, selection);
    selection = {};
    if (const std::string lost = lost_measures_words(whole, mechanism); !lost.empty())
      along += (along.empty() ? "" : ", ") + lost;
  });
  if (!along.empty() && session.document.revision() != before)
    session.notice = done + " " + what + " together with " + along + ".";
}

} // namespace

void delete_selected(Session& session, const ToolState& tool) {
  if (!session.selection().empty()) return remove_selected(session, "Delete", "Deleted");
  if (const NamedPoint* point = selected_point(session, tool))
    edit(session, "Remove " + point->name,
         [name = point->name](Mechanism& mechanism, Selection&) { remove_point(mechanism, name); });
}

namespace {

// Far enough for a copy to be seen beside its original, a round number of metres.
double copy_step(const ViewState& view) {
  return std::pow(10, std::round(std::log10(view.camera.distance / 8)));
}

// Whether a body of the selection stands where another does.
bool lies_on_another(const Mechanism& mechanism, const Selection& selection) {
  const std::vector<std::string> names = selection.names(PartKind::body);
  const std::unordered_set<std::string_view> selected(names.begin(), names.end());
  std::set<std::array<double, 3>> others;
  const auto place = [](const Body& body) {
    return std::array{body.position.x(), body.position.y(), body.position.z()};
  };
  for (const Body& body : mechanism.bodies)
    if (!selected.contains(body.name)) others.insert(place(body));
  return std::ranges::any_of(mechanism.bodies, [&](const Body& body) {
    return selected.contains(body.name) && others.contains(place(body));
  });
}

} // namespace

void duplicate_selected(Session& session, const ViewState& view) {
  if (session.selection().empty()) return;
  const double step = copy_step(view);
  edit(session, "Duplicate " + words_for(session.selection()),
       [&](Mechanism& mechanism, Selection& selection) {
         selection = duplicate_parts(mechanism, selection, step * Vec3(1, 0, 0));
       });
}

namespace {

bool put_on_clipboard(Session& session) {
  if (session.selection().empty()) return false;
  try {
    ImGui::SetClipboardText(copy_text(session.document.stored(), session.selection()).c_str());
  } catch (const SceneError& error) {
    show_error(session, error.what());
    return false;
  }
  session.notice = "Copied " + words_for(session.selection());
  return true;
}

} // namespace

void copy_selected(Session& session) {
  put_on_clipboard(session);
}

void cut_selected(Session& session) {
  if (put_on_clipboard(session)) remove_selected(session, "Cut", "Cut");
}

void paste_parts(Session& session, const ViewState& view) {
  const char* text = ImGui::GetClipboardText();
  if (!text || !*text) {
    session.notice = "Nothing has been copied.";
    return;
  }
  edit(session, "Paste", [&](Mechanism& mechanism, Selection& selection) {
    try {
      selection = paste_text(mechanism, text);
    } catch (const SceneError&) {
      throw SceneError("", "What was copied is no part of a mechanism.");
    }
    constexpr int most = 20; // copies side by side
    for (int i = 0; i < most && lies_on_another(mechanism, selection); ++i)
      move_parts(mechanism, selection, copy_step(view) * Vec3(1, 0, 0));
  });
}

void select_all(Session& session) {
  Selection all;
  for (const Body& body : session.mechanism().bodies)
    all.parts.push_back({PartKind::body, body.name});
  for (const Joint& joint : session.mechanism().joints)
    all.parts.push_back({PartKind::joint, joint.name});
  for (const Force& force : session.mechanism().forces)
    all.parts.push_back({PartKind::force, force.name});
  select(session, std::move(all));
}

namespace {

// The pairs of coordinates that a gear or belt ties when it goes from one joint to the next in the order of
// their choice, a rack or screw one pair; none where it cannot.
std::vector<std::array<std::string, 2>> pairs_to_gear(const Session& session, GearKind kind) {
  const std::vector<std::string> joints = session.selection().names(PartKind::joint);
  const std::size_t count = joints.size();
  if (count <= 2 || turns_into_slide(kind)) {
    const auto ends = gear_ends(session.mechanism(), joints, kind);
    return ends ? std::vector{*ends} : std::vector<std::array<std::string, 2>>{};
  }
  std::vector<std::array<std::string, 2>> pairs;
  for (std::size_t i = 1; i < count; ++i) {
    const auto ends = gear_ends(session.mechanism(), {joints[i - 1], joints[i]}, kind);
    if (!ends || (i > 1 && (*ends)[0] != pairs.back()[1])) return {};
    pairs.push_back(*ends);
  }
  return pairs;
}

// Two belts over one wheel have its radius by one number.
void share_radius(Mechanism& mechanism, const std::string& from, const std::string& to) {
  const std::string name = free_name(mechanism, "radius"), radius = "joints." + from + ".radii.1";
  name_number(mechanism, radius, name);
  set_expression(mechanism, "joints." + to + ".radii.0", name);
}

} // namespace

bool can_gear_selected(const Session& session, GearKind kind) {
  return !pairs_to_gear(session, kind).empty();
}

void gear_selected(Session& session, GearKind kind) {
  const std::vector<std::string> joints = session.selection().names(PartKind::joint);
  const std::vector<std::array<std::string, 2>> pairs = pairs_to_gear(session, kind);
  if (pairs.empty()) return;
  const auto first_ratio = [kind] { // wheels that mesh, or of one size; 50 mm; 5 mm a turn
    switch (kind) {
    case GearKind::gear: return -1.;
    case GearKind::belt: return 1.;
    case GearKind::rack: return 0.05;
    case GearKind::screw: return 0.005 / (2 * std::numbers::pi);
    }
    return 1.;
  };
  std::string word(type_name(kind));
  word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  const std::vector<std::string_view> names(joints.begin(), joints.end());
  edit(session, word + " of " + word_list(names, "and"), [&](Mechanism& mechanism, Selection& selection) {
    selection = {};
    std::string last;
    for (const auto& ends : pairs) {
      const std::string name = add_gear(mechanism, ends, first_ratio(), kind);
      if (kind == GearKind::belt && !last.empty()) share_radius(mechanism, last, name);
      selection.add({PartKind::joint, name});
      last = name;
    }
  });
}

namespace {

// The gear that alone is selected; empty: none is.
std::string selected_gear(const Session& session) {
  if (session.selection().parts.size() != 1 || session.selection().parts[0].kind != PartKind::joint)
    return {};
  const int j = joint_index(session.mechanism(), session.selection().parts[0].name);
  if (j < 0 || session.mechanism().joints[static_cast<std::size_t>(j)].type != JointType::gear) return {};
  return session.selection().parts[0].name;
}

} // namespace

bool can_give_backlash(const Session& session) {
  return !selected_gear(session).empty();
}

void give_backlash_to_selected(Session& session) {
  const std::string gear = selected_gear(session);
  if (gear.empty()) return;
  if (const std::string why = backlash_refused(session.document.stored(), gear); !why.empty()) {
    session.notice = why;
    return;
  }
  edit(session, "Backlash of " + gear, [&](Mechanism& mechanism, Selection& selection) {
    selection.set({PartKind::joint, give_backlash(mechanism, gear)});
  });
  session.notice = "Half of the play is to either side; its stop is as stiff as the teeth.";
}

namespace {

// The body that a bearing holds, of what alone is selected; empty: none.
std::string selected_in_bearings(const Session& session) {
  if (session.selection().parts.size() != 1) return {};
  const Part& part = session.selection().parts[0];
  for (const Force& force : session.mechanism().forces)
    if (force.type == ForceType::bearing && ((part.kind == PartKind::body && held_by(force) == part.name) ||
                                             (part.kind == PartKind::force && force.name == part.name)))
      return held_by(force);
  return {};
}

} // namespace

bool can_drive_in_bearings(const Session& session) {
  return !selected_in_bearings(session).empty();
}

void drive_selected_in_bearings(Session& session) {
  if (const std::string body = selected_in_bearings(session); !body.empty()) drive_in_bearings(session, body);
}

void drive_in_bearings(Session& session, const std::string& body) {
  if (const std::string why = bearing_drive_refused(session.document.stored(), body); !why.empty()) {
    session.notice = why;
    return;
  }
  edit(session, "Drive " + body + " in its bearings", [&](Mechanism& mechanism, Selection& selection) {
    const std::string joint = give_bearing_drive(mechanism, body, new_drive_speed(session.units)),
                      speed = "joints." + joint + ".drive.speed";
    if (!is_pinned(mechanism, speed) && !expression_at(mechanism, speed))
      mechanism.sliders.push_back(slider_for(mechanism, speed, session.units));
    selection.set({PartKind::joint, joint});
  });
  session.notice = "The bearings hold a sleeve without mass now, in which " + body + " turns.";
}

} // namespace flyball
