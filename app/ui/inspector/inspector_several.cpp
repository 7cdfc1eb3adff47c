// Several parts at once: the numbers all of them have, and what is done with them together.
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>

namespace flyball {

namespace {

// Every part's numbers are looked up by their names in every frame, which takes longer the more parts the
// mechanism has; of more parts nobody sets one number.
constexpr std::size_t most_parts = 200, most_names = 400'000;

// Whether an end of a gear is on an angle, rather than a length.
bool turns_at(const Mechanism& mechanism, const Joint& gear, std::size_t end) {
  const auto [joint, i] = find_coordinate(mechanism, gear.joints[end]);
  return joint >= 0 && is_angle(mechanism.joints[static_cast<std::size_t>(joint)].type, i);
}

// Whether their numbers are the same, in the same units.
bool are_alike(const Mechanism& mechanism, const Joint& a, const Joint& b) {
  if (a.type != b.type || a.kind != b.kind) return false;
  return a.type != JointType::gear || (turns_at(mechanism, a, 0) == turns_at(mechanism, b, 0) &&
                                       turns_at(mechanism, a, 1) == turns_at(mechanism, b, 1));
}

// Those that the rows of the last one picked stand for: of its kind and type, it first.
std::vector<Part> alike(const Session& session) {
  const Mechanism& mechanism = session.mechanism();
  const std::vector<PartId> ids = find_parts(mechanism, session.selection());
  const std::size_t all = mechanism.bodies.size() + mechanism.joints.size() + mechanism.forces.size();
  if (ids.empty() || ids.size() > most_parts || ids.size() * all > most_names) return {};
  const auto is_alike = [&](const PartId& id) {
    const auto i = static_cast<std::size_t>(id.index), last = static_cast<std::size_t>(ids.back().index);
    if (id.kind != ids.back().kind) return false;
    if (id.kind == PartKind::joint) return are_alike(mechanism, mechanism.joints[i], mechanism.joints[last]);
    return id.kind != PartKind::force || mechanism.forces[i].type == mechanism.forces[last].type;
  };
  std::vector<Part> parts;
  for (auto id = ids.rbegin(); id != ids.rend(); ++id)
    if (is_alike(*id)) parts.push_back(part_of(mechanism, *id));
  return parts;
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

void several_inspector(Session& session, Ui& ui, InspectorState& inspector, ToolState& tool,
                       const CommandRunner& commands) {
  actions(ui, commands);
  std::vector<Part> parts = alike(session);
  if (parts.size() < 2) return;
  const PartId id = find_part(session.mechanism(), parts.front());
  const auto i = static_cast<std::size_t>(id.index);
  if (parts.size() < session.selection().parts.size())
    paragraph("Below: the " + several_words(session.mechanism(), id, parts.size()) + ".", colors_of(ui).dim);
  ui.fields.together = std::move(parts);
  if (id.kind == PartKind::body) body_inspector(session, ui, inspector, tool, session.mechanism().bodies[i]);
  if (id.kind == PartKind::joint) joint_inspector(session, ui, session.mechanism().joints[i]);
  if (id.kind == PartKind::force) force_inspector(session, ui, session.mechanism().forces[i]);
}

} // namespace flyball
