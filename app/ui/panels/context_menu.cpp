#include "app/ui/panels/context_menu.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/session/units.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/inspector/coordinate_drive.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_frame.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <initializer_list>

namespace flyball {

namespace {

constexpr const char* context_popup = "view menu";

// What is chosen happens after the frame, as it may change what the rest of it shows.
void command_item(Ui& ui, const CommandRunner& commands, const char* id) {
  const Command& wanted = command(id);
  const bool on = commands.checked(wanted);
  ImGui::PushID(id);
  if (ImGui::MenuItem(wanted.title, key_text(wanted.key).c_str(), on, commands.enabled(wanted)))
    later(ui, [commands, id] { commands.run(id); });
  ImGui::PopID();
  note_widget(ui.widgets, std::string("view/menu/") + id);
  help_on_hover(wanted.help);
}

void command_items(Ui& ui, const CommandRunner& commands, std::initializer_list<const char*> ids) {
  for (const char* id : ids)
    command_item(ui, commands, id);
}

void menu_title(Ui& ui, const std::string& name, const std::string& what) {
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopFont();
  note_widget(ui.widgets, "view/menu/title");
  if (!what.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s", what.c_str());
  }
  ImGui::Separator();
}

std::string menu_kind(const Mechanism& mechanism, PartId part) {
  const auto i = static_cast<std::size_t>(part.index);
  if (part.kind == PartKind::joint) return joint_noun(mechanism.joints[i]);
  if (part.kind == PartKind::force) return force_noun(mechanism.forces[i]);
  return "body";
}

// "joints.spin." of a joint.
std::string addresses_begin(const Part& part) {
  const char* list = part.kind == PartKind::body    ? "bodies."
                     : part.kind == PartKind::joint ? "joints."
                                                    : "forces.";
  return list + part.name + ".";
}

// A tick for each number of the part: whether it has a slider.
void number_items(Session& session, Ui& ui, const Part& part) {
  const std::string begins = addresses_begin(part);
  std::vector<std::string> addresses;
  for (std::string& address : parameter_addresses(session.mechanism()))
    if (address.starts_with(begins)) addresses.push_back(std::move(address));
  if (addresses.empty() || !ImGui::BeginMenu("Slider for")) {
    note_widget(ui.widgets, "view/menu/pins");
    return;
  }
  note_widget(ui.widgets, "view/menu/pins");
  for (const std::string& address : addresses) {
    const bool pinned = is_pinned(session.mechanism(), address);
    const std::string words = address.substr(begins.size());
    const ShownUnit unit = shown_unit(parameter_unit(session.mechanism(), address), session.units);
    const std::string value = short_text(unit.shown(get_parameter(session.mechanism(), address))) +
                              (unit.text.empty() ? "" : " " + unit.text);
    if (ImGui::MenuItem(words.c_str(), value.c_str(), pinned))
      later(ui, [&session, address, pinned] { pin(session, address, !pinned); });
    note_widget(ui.widgets, "view/menu/pin/" + address);
  }
  ImGui::EndMenu();
}

void drive_items(Session& session, Ui& ui, const Joint& joint) {
  for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
    const int coordinate = static_cast<int>(i);
    const bool on = joint.coordinates[i].drive.has_value();
    const char* refused = on ? nullptr : drive_refused(joint, coordinate);
    const std::string words = joint.coordinates.size() == 1 ? "Driven" : "Driven: " + std::to_string(i);
    if (ImGui::MenuItem(words.c_str(), nullptr, on, !refused))
      later(ui, [&session, &ui, name = joint.name, coordinate, on] {
        set_driven(session, ui, name, coordinate, !on);
      });
    note_widget(ui.widgets, "view/menu/drive/" + std::to_string(i));
    help_on_hover(refused ? refused : "Moves the coordinate at a constant speed.");
  }
}

// The loads of a steady state, which is shown while exploring.
void free_body_item(Session& session, Ui& ui, ViewState& view) {
  const bool on = view.loads && session.mode == Mode::explore;
  if (ImGui::MenuItem("Free-body diagram", key_text(command("view.loads").key).c_str(), on))
    later(ui, [&session, &view, on] {
      view.loads = !on;
      view.fit_loads = true;
      if (!on) set_mode(session, Mode::explore);
    });
  note_widget(ui.widgets, "view/menu/view.loads");
  help_on_hover("What acts on this body alone in the steady state; it adds up to zero.");
}

} // namespace

void part_items(Session& session, Ui& ui, ViewState& view, const CommandRunner& commands) {
  const Selection selection = session.selection(); // a copy, as what is chosen may change it
  const Mechanism& mechanism = session.mechanism();
  const Part& part = selection.parts.back();
  const PartId id = find_part(mechanism, part);
  const bool alone = selection.parts.size() == 1 && id.kind != PartKind::none;
  if (alone)
    menu_title(ui, part.name, menu_kind(mechanism, id));
  else
    menu_title(ui, std::to_string(selection.parts.size()) + " parts", "");
  if (alone) command_item(ui, commands, "edit.rename");
  command_items(ui, commands, {"edit.duplicate", "edit.copy", "edit.delete"});
  if (selection.has(PartKind::body)) command_items(ui, commands, {"edit.mirror", "edit.circular"});
  if (selection.names(PartKind::joint).size() >= 2) command_item(ui, commands, "insert.gear");
  for (const auto& [kind, command_id] : {std::pair(GearKind::belt, "insert.belt"),
                                         {GearKind::rack, "insert.rack"},
                                         {GearKind::screw, "insert.screw"}})
    if (can_gear_selected(session, kind)) command_item(ui, commands, command_id);
  if (can_give_backlash(session)) command_item(ui, commands, "edit.backlash");
  if (can_drive_in_bearings(session)) command_item(ui, commands, "edit.bearing_drive");
  ImGui::Separator();
  if (alone && id.kind == PartKind::joint)
    drive_items(session, ui, mechanism.joints[static_cast<std::size_t>(id.index)]);
  if (alone) number_items(session, ui, part);
  if (alone && id.kind == PartKind::body) free_body_item(session, ui, view);
  ImGui::Separator();
  command_items(ui, commands, {"view.fit_selected", "view.hide", "view.isolate", "view.show_all"});
}

namespace {

void view_items(const Session& session, Ui& ui, const CommandRunner& commands) {
  menu_title(ui, "View", "");
  command_items(ui, commands, {"view.fit", "view.front", "view.side", "view.top", "view.iso"});
  ImGui::Separator();
  command_items(
      ui, commands,
      {"view.ghost", "view.loads", "view.loads_by_root", "view.grid", "view.shadow", "view.show_all"});
  ImGui::Separator();
  command_item(ui, commands, "view.mode");
  if (session.mode != Mode::build) return command_item(ui, commands, "view.play");
  if (ImGui::BeginMenu("Add")) {
    note_widget(ui.widgets, "view/menu/add");
    for (const Command& each : flyball::commands())
      if (std::string_view(each.id).starts_with("insert.")) {
        if (each.separated) ImGui::Separator();
        command_item(ui, commands, each.id);
      }
    ImGui::EndMenu();
  } else {
    note_widget(ui.widgets, "view/menu/add");
  }
  command_items(ui, commands, {"edit.paste", "edit.all"});
}

// Where a key has asked for it: at the selected part, else in the middle of the view.
ImVec2 place_for_key(const ViewContext& context, const ViewInput& input) {
  const std::vector<PartId> selected =
      find_parts(*shown_mechanism(context.session, context.tool), context.session.selection());
  Bounds bounds;
  for (const Instance& instance : shown_scene(context)->solid.instances)
    if (!selected.empty() && instance.part == selected.back()) bounds.add(instance_bounds(instance));
  const auto at = bounds.empty ? std::nullopt : input.on_screen(bounds.center());
  return at.value_or(ImVec2(input.rect.x + input.rect.width / 2, input.rect.y + input.rect.height / 2));
}

} // namespace

namespace {

// A panel that appears with what is selected takes the focus, which would close a menu that is open already.
constexpr int frames_to_settle = 2;

} // namespace

void ContextMenu::open(const Session& session) {
  in_ = frames_to_settle;
  at_.reset();
  of_part_ = !session.selection().empty();
}

void ContextMenu::draw(const ViewContext& context, const CommandRunner& commands, const ViewInput& input) {
  if (input.menu && !context.tool.grab) {
    const auto hit = part_under_cursor(context, input);
    if (hit) {
      Part part = part_of(*shown_mechanism(context.session, context.tool), hit->part);
      if (!context.session.selection().has(part)) select(context.session, {{std::move(part)}});
    }
    const ImVec2 at = ImGui::GetIO().MousePos;
    in_ = frames_to_settle;
    at_ = Vec2(static_cast<double>(at.x), static_cast<double>(at.y));
    of_part_ = hit.has_value();
  } else if (in_ > 0 && --in_ == 0) {
    ImGui::SetNextWindowPos(at_ ? ImVec2(static_cast<float>(at_->x()), static_cast<float>(at_->y()))
                                : place_for_key(context, input));
    ImGui::OpenPopup(context_popup);
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * context.ui.scale, 8 * context.ui.scale});
  if (ImGui::BeginPopup(context_popup)) {
    if (of_part_ && !context.session.selection().empty())
      part_items(context.session, context.ui, context.view, commands);
    else
      view_items(context.session, context.ui, commands);
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar();
}

} // namespace flyball
