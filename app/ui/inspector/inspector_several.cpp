// Several parts at once: the numbers all of them have, and what is done with them together.
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace flyball {

namespace {

// Looking up every part's numbers in every frame; of more parts nobody sets one number.
constexpr std::size_t most_parts = 200;

struct CommonNumber {
  const char *key, *label, *help;
  Least least = Least::any;
};

constexpr std::array body_numbers{
    CommonNumber{"mass", "Mass", "The mass of each.", Least::zero},
};
constexpr std::array joint_numbers{
    CommonNumber{"drive.speed", "Speed", "The drive speed of each."},
    CommonNumber{"spring.stiffness", "Stiffness", "The stiffness of each one's spring."},
    CommonNumber{"spring.free", "Unstressed at", "Where each one's spring exerts nothing."},
    CommonNumber{"damping", "Damping", "The damping of each.", Least::zero},
    CommonNumber{"stop.stiffness", "Stop", "The stiffness of each one's stop.", Least::above_zero},
    CommonNumber{"length", "Length", "The length of each.", Least::above_zero},
    CommonNumber{"ratio", "Ratio", "The ratio of each."},
};
constexpr std::array force_numbers{
    CommonNumber{"stiffness", "Stiffness", "The stiffness of each."},
    CommonNumber{"free_length", "Free length", "The length at which each is slack.", Least::zero},
    CommonNumber{"damping", "Damping", "The damping of each.", Least::zero},
    CommonNumber{"linear", "Linear", "The linear drag of each.", Least::zero},
    CommonNumber{"quadratic", "Quadratic", "The quadratic drag of each.", Least::zero},
    CommonNumber{"vector.0", "Along x", "The x component of each."},
    CommonNumber{"vector.1", "Along y", "The y component of each."},
    CommonNumber{"vector.2", "Along z", "The z component of each."},
};

const char* list_of(PartKind kind) {
  return kind == PartKind::body ? "bodies." : kind == PartKind::joint ? "joints." : "forces.";
}

void common_number(Session& session, Ui& ui, InspectorState& inspector, PartKind kind,
                   const std::vector<std::string>& names, const CommonNumber& number) {
  std::vector<std::string> addresses;
  std::optional<double> value;
  std::string unit;
  bool same = true;
  try {
    for (const std::string& name : names) {
      addresses.push_back(list_of(kind) + name + "." + number.key);
      const double found = get_parameter(session.mechanism(), addresses.back());
      const std::string its_unit = parameter_unit(session.mechanism(), addresses.back());
      if (value && its_unit != unit) return;
      same = same && value.value_or(found) == found;
      value = found;
      unit = its_unit;
    }
  } catch (const SceneError&) {
    return; // not all of them have it
  }
  quantity_row(session, ui, number.label,
               {.name = std::string("inspector/all/") + number.key,
                .value = value.value_or(0),
                .unit = unit,
                .help = number.help,
                .least = number.least,
                .set =
                    [&session, &inspector, addresses, names, label = std::string(number.label),
                     mass = kind == PartKind::body](double typed) {
                      if (mass)
                        for (const std::string& name : names)
                          inspector.given_masses[name] = {true, 0};
                      edit(session, label + " of " + std::to_string(addresses.size()) + " parts",
                           [&](Mechanism& mechanism, Selection&) {
                             for (std::size_t i = 0; i < addresses.size(); ++i)
                               if (const int body = mass ? body_index(mechanism, names[i]) : -1; body >= 0)
                                 give_mass(inspector, mechanism.bodies[static_cast<std::size_t>(body)],
                                           typed);
                               else
                                 set_parameter(mechanism, addresses[i], typed);
                           });
                    },
                .various = same ? "" : "various"});
}

void actions(Ui& ui, const CommandRunner& commands) {
  constexpr std::array ids{"edit.duplicate", "edit.mirror", "edit.circular", "insert.gear",
                           "insert.belt",    "insert.rack", "insert.screw",  "edit.delete"};
  const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
  bool first = true;
  for (const char* id : ids) {
    const Command& wanted = command(id);
    if (!commands.enabled(wanted)) continue;
    const float width = ImGui::CalcTextSize(wanted.title).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (!first && ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width < right)
      ImGui::SameLine();
    first = false;
    if (text_button(ui, std::string("inspector/") + id, wanted.title))
      later(ui, [commands, id] { commands.run(id); });
    help_on_hover(wanted.help);
  }
}

} // namespace

void several_inspector(Session& session, Ui& ui, InspectorState& inspector, const CommandRunner& commands) {
  const Selection& selection = session.selection();
  const PartKind kind = selection.parts.front().kind;
  const bool alike =
      std::ranges::all_of(selection.parts, [&](const Part& part) { return part.kind == kind; });
  if (alike && selection.parts.size() <= most_parts) {
    std::span<const CommonNumber> numbers = body_numbers;
    if (kind == PartKind::joint) numbers = joint_numbers;
    if (kind == PartKind::force) numbers = force_numbers;
    for (const CommonNumber& number : numbers)
      common_number(session, ui, inspector, kind, selection.names(kind), number);
    ImGui::Dummy({0, 3 * ui.scale});
  }
  actions(ui, commands);
}

} // namespace flyball
