#include "app/ui/dialogs/copies_dialogs.hpp"

#include "app/document/copies.hpp"
#include "app/document/transform.hpp"
#include "app/session/session.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <array>
#include <string>

namespace flyball {

namespace {

constexpr std::array axis_names{"x", "y", "z"};
constexpr int fewest_round = 2, most_round = 100; // copies of a circle, the selected one included

Vec3 unit(int axis) {
  return Vec3::Unit(axis);
}

// The axis something turns about: of the first driven revolute joint. What a governor's arms stand round.
struct Spin {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitY();
};
Spin spin_of(const Mechanism& mechanism) {
  for (const Joint& joint : mechanism.joints)
    for (const Coordinate& coordinate : joint.coordinates)
      if (coordinate.drive && has_axis(joint.type)) return {joint.at, joint.axis};
  return {};
}

int main_axis(const Vec3& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

// Buttons x, y, z of which one is on.
void axis_choice(Ui& ui, const std::string& name, const std::array<const char*, 3>& labels, int& axis) {
  for (int i = 0; i < 3; ++i) {
    if (i > 0) ImGui::SameLine();
    const auto at = static_cast<std::size_t>(i);
    if (text_button(ui, name + "/" + axis_names[at], labels[at], axis == i)) axis = i;
  }
}

void point_fields(Session& session, Ui& ui, const std::string& name, Vec3& point) {
  for (int i = 0; i < 3; ++i) {
    double value = point[i];
    const auto at = static_cast<std::size_t>(i);
    if (plain_quantity_field(session, ui, name + "/" + axis_names[at], axis_names[at], "m",
                             "A point on it, as drawn.", value))
      point[i] = value;
  }
}

// The buttons below; returns whether to go ahead, which it does not with what is not `possible`. Enter does,
// but in a field, which it ends.
bool accepted(Ui& ui, const std::string& name, const char* text, bool possible = true) {
  if (ImGui::IsWindowAppearing()) enter_dialog_at(ui, name + "/ok");
  ImGui::Dummy({0, 4 * ui.scale});
  const bool entered = !ImGui::GetIO().WantTextInput && enter_pressed(ui);
  ImGui::BeginDisabled(!possible);
  const bool pressed = text_button(ui, name + "/ok", text, true);
  ImGui::EndDisabled();
  const bool go = possible && (pressed || entered);
  ImGui::SameLine();
  if (text_button(ui, name + "/cancel", "Cancel") || escape_pressed() || go) close_dialog();
  return go;
}

} // namespace

void CopiesDialogs::open_mirror(const Session& session, DialogState& dialog) {
  if (session.selection().empty()) return;
  const Spin spin = spin_of(session.mechanism());
  choice_.point = spin.point;
  // The plane through the spin axis from which the selected parts stand off most.
  Vec3 off = centre_of(session.mechanism(), session.selection()).value_or(spin.point) - spin.point;
  off[main_axis(spin.axis)] = 0;
  choice_.axis = off.isZero(1e-12) ? (main_axis(spin.axis) + 1) % 3 : main_axis(off);
  dialog.wanted = Dialog::mirror;
}

void CopiesDialogs::open_circular(const Session& session, DialogState& dialog) {
  if (session.selection().empty()) return;
  const Spin spin = spin_of(session.mechanism());
  choice_.point = spin.point;
  choice_.axis = main_axis(spin.axis);
  dialog.wanted = Dialog::circular;
}

void CopiesDialogs::draw(Session& session, Ui& ui, DialogState& dialog) {
  draw_mirror(session, ui, dialog);
  draw_circular(session, ui, dialog);
}

void CopiesDialogs::draw_mirror(Session& session, Ui& ui, DialogState& dialog) {
  if (!begin_dialog(ui, dialog, Dialog::mirror, "Mirror the selected parts", 420)) return;
  paragraph("At the plane through this point, at right angles to", colors_of(ui).dim);
  axis_choice(ui, "mirror/axis", {"x", "y", "z"}, choice_.axis);
  point_fields(session, ui, "mirror/point", choice_.point);
  if (accepted(ui, "mirror", "Mirror"))
    edit(session, "Mirror", [&](Mechanism& mechanism, Selection& selection) {
      selection = mirror_parts(mechanism, selection, choice_.point, unit(choice_.axis));
    });
  end_dialog();
}

void CopiesDialogs::draw_circular(Session& session, Ui& ui, DialogState& dialog) {
  if (!begin_dialog(ui, dialog, Dialog::circular, "Copy the selected parts round an axis", 420)) return;
  paragraph("Evenly round the axis through this point along", colors_of(ui).dim);
  axis_choice(ui, "circular/axis", {"x", "y", "z"}, choice_.axis);
  point_fields(session, ui, "circular/point", choice_.point);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("In all");
  ImGui::SameLine(90 * ui.scale);
  ImGui::SetNextItemWidth(120 * ui.scale);
  ImGui::InputInt("##count", &choice_.count, 0);
  note_widget(ui.widgets, "circular/count", KeyUse::type);
  help_on_hover("How many there are then, the selected one included.");
  const bool possible = choice_.count >= fewest_round && choice_.count <= most_round;
  if (!possible) {
    paragraph("From " + std::to_string(fewest_round) + " to " + std::to_string(most_round) +
                  ", the selected one included.",
              colors_of(ui).warn);
    note_widget(ui.widgets, "circular/refusal", KeyUse::none);
  }
  if (accepted(ui, "circular", "Copy", possible))
    edit(session, "Circular copy", [&](Mechanism& mechanism, Selection& selection) {
      selection = circular_copy(mechanism, selection, choice_.point, unit(choice_.axis), choice_.count);
    });
  end_dialog();
}

} // namespace flyball
