// What Mirror and Circular copy ask for.
#include "app/document/copies.hpp"
#include "app/document/transform.hpp"
#include "app/ui/app.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <array>

namespace flyball {

namespace {

constexpr std::array axis_names{"x", "y", "z"};

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
                             "A point on it, in metres, as drawn.", value))
      point[i] = value;
  }
}

// The buttons below; returns whether to go ahead. Enter does, but in a field, which it ends.
bool accepted(Ui& ui, const std::string& name, const char* text) {
  if (ImGui::IsWindowAppearing()) enter_dialog_at(ui, name + "/ok");
  ImGui::Dummy({0, 4 * ui.scale});
  const bool entered = !ImGui::GetIO().WantTextInput && enter_pressed(ui);
  const bool go = text_button(ui, name + "/ok", text, true) || entered;
  ImGui::SameLine();
  if (text_button(ui, name + "/cancel", "Cancel") || escape_pressed() || go) close_dialog();
  return go;
}

} // namespace

void show_mirror_dialog(App& app) {
  if (app.session.selection().empty()) return;
  const Spin spin = spin_of(app.session.mechanism());
  CopyChoice& choice = app.commands.copy;
  choice.point = spin.point;
  // The plane through the spin axis from which the selected parts stand off most.
  Vec3 off = centre_of(app.session.mechanism(), app.session.selection()).value_or(spin.point) - spin.point;
  off[main_axis(spin.axis)] = 0;
  choice.axis = off.isZero(1e-12) ? (main_axis(spin.axis) + 1) % 3 : main_axis(off);
  app.dialog.wanted = Dialog::mirror;
}

void show_circular_dialog(App& app) {
  if (app.session.selection().empty()) return;
  const Spin spin = spin_of(app.session.mechanism());
  app.commands.copy.point = spin.point;
  app.commands.copy.axis = main_axis(spin.axis);
  app.dialog.wanted = Dialog::circular;
}

void mirror_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::mirror, "Mirror the selected parts", 420)) return;
  CopyChoice& choice = app.commands.copy;
  paragraph("At the plane through this point, at right angles to", colors_of(app.ui).dim);
  axis_choice(app.ui, "mirror/axis", {"x", "y", "z"}, choice.axis);
  point_fields(app.session, app.ui, "mirror/point", choice.point);
  if (accepted(app.ui, "mirror", "Mirror"))
    edit(app.session, "Mirror", [&](Mechanism& mechanism, Selection& selection) {
      selection = mirror_parts(mechanism, selection, choice.point, unit(choice.axis));
    });
  end_dialog();
}

void circular_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::circular, "Copy the selected parts round an axis", 420))
    return;
  CopyChoice& choice = app.commands.copy;
  paragraph("Evenly round the axis through this point along", colors_of(app.ui).dim);
  axis_choice(app.ui, "circular/axis", {"x", "y", "z"}, choice.axis);
  point_fields(app.session, app.ui, "circular/point", choice.point);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("In all");
  ImGui::SameLine(90 * app.ui.scale);
  ImGui::SetNextItemWidth(120 * app.ui.scale);
  ImGui::InputInt("##count", &choice.count, 0);
  choice.count = std::clamp(choice.count, 2, 100);
  note_widget(app.ui.widgets, "circular/count", KeyUse::type);
  help_on_hover("How many there are then, the selected one included.");
  if (accepted(app.ui, "circular", "Copy"))
    edit(app.session, "Circular copy", [&](Mechanism& mechanism, Selection& selection) {
      selection = circular_copy(mechanism, selection, choice.point, unit(choice.axis), choice.count);
    });
  end_dialog();
}

} // namespace flyball
