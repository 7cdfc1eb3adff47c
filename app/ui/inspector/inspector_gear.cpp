// Gears, belts, racks and screws.
#include "app/document/gear_kinds.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/gear_ratio.hpp"

#include <algorithm>
#include <array>

namespace flyball {

namespace {

std::string gear_address(const Joint& gear, const char* key) {
  return "joints." + gear.name + "." + key;
}

void end_rows(Session& session, Ui& ui, const Joint& gear) {
  std::vector<std::string> choices;
  for (const Joint& other : session.mechanism().joints)
    for (int i = 0; i < coordinate_count(other.type); ++i)
      if (!is_rotation_vector(other.type, i)) choices.push_back(coordinate_name(other, i));
  constexpr std::array<const char*, 2> labels{"Joint a", "Joint b"};
  for (std::size_t end = 0; end < 2; ++end) {
    const std::string name = "inspector/joints/" + std::to_string(end);
    const auto chosen = name_choice_row(ui, name, labels[end], choices, gear.joints[end],
                                        "A coordinate the gear couples: b = ratio a + offset.");
    if (chosen)
      edit_joint(session, ui, "Joints of " + gear.name, gear.name, [end, chosen = *chosen](Joint& same) {
        if (same.joints[1 - end] == chosen) same.joints[1 - end] = same.joints[end];
        same.joints[end] = chosen;
      });
  }
}

void kind_row(Session& session, Ui& ui, const Joint& gear) {
  std::vector<GearKind> kinds = gear_kinds(session.mechanism(), gear.joints);
  if (std::ranges::count(kinds, gear.kind) == 0) kinds.push_back(gear.kind); // which does not suit them
  if (kinds.size() < 2) return;
  std::vector<std::string_view> words;
  for (const GearKind kind : kinds)
    words.push_back(type_name(kind));
  const auto present = static_cast<std::size_t>(std::ranges::find(kinds, gear.kind) - kinds.begin());
  const auto chosen =
      choice_row(ui, "inspector/kind", "Kind", words, present,
                 "What ties the two coordinates; another kind has the same ratio, by numbers of its own.");
  if (chosen)
    edit_later(session, ui, "Kind of " + gear.name,
               [names = edited_with(ui, {PartKind::joint, gear.name}), kind = kinds[*chosen]](Mechanism& m,
                                                                                              Selection&) {
                 for (Joint& each : m.joints)
                   if (std::ranges::count(names, each.name) > 0) change_gear_kind(m, each, kind);
               });
}

void belt_rows(Session& session, Ui& ui, const Joint& belt) {
  constexpr std::array<const char*, 2> labels{"Radius a", "Radius b"}, keys{"radii.0", "radii.1"},
      helps{"Of the wheel on joint a.", "Of the wheel on joint b."};
  for (std::size_t end = 0; end < 2; ++end)
    number_row(session, ui, labels[end],
               {.name = "inspector/radii/" + std::to_string(end),
                .value = belt.radii[end],
                .unit = "m",
                .help = helps[end],
                .least = Least::above_zero,
                .address = gear_address(belt, keys[end])});
  const std::vector<const Joint*> others = others_edited(session, ui, belt);
  const auto is_crossed = [](const Joint* each) { return each->crossed; };
  const bool crossed = belt.crossed && std::ranges::all_of(others, is_crossed),
             mixed = !crossed && (belt.crossed || std::ranges::any_of(others, is_crossed));
  if (check_row(ui, "inspector/crossed", "Crossed", crossed,
                "Whether the belt is crossed, so that the coordinates turn against each other.", nullptr,
                mixed))
    edit_joint(session, ui, "Cross " + belt.name, belt.name,
               [crossed = !crossed](Joint& same) { same.crossed = crossed; });
}

void ratio_rows(Session& session, Ui& ui, const Joint& gear, const std::string& unit) {
  switch (gear.kind) {
  case GearKind::belt: return belt_rows(session, ui, gear);
  case GearKind::rack:
    return number_row(session, ui, "Radius",
                      {.name = "inspector/radius",
                       .value = gear.radii[0],
                       .unit = "m",
                       .help =
                           "Pitch radius of the pinion, below zero on its other side: the rack moves by it "
                           "as the pinion turns by a radian.",
                       .address = gear_address(gear, "radius")});
  case GearKind::screw:
    return number_row(
        session, ui, "Lead",
        {.name = "inspector/lead",
         .value = gear.lead,
         .unit = "m",
         .help = "How far it slides as it makes a whole turn; below zero of a left-handed thread.",
         .address = gear_address(gear, "lead")});
  case GearKind::gear: break;
  }
  number_row(session, ui, "Ratio",
             {.name = "inspector/ratio",
              .value = gear.ratio,
              .unit = unit,
              .help = "How far b moves while a moves by one; negative where they turn against each other.",
              .address = gear_address(gear, "ratio")});
}

} // namespace

void gear_rows(Session& session, Ui& ui, const Joint& gear) {
  kind_row(session, ui, gear);
  if (!is_of_several(ui)) end_rows(session, ui, gear);
  const auto unit_of = [&](std::size_t end) -> std::string {
    const auto [other, i] = find_coordinate(session.mechanism(), gear.joints[end]);
    if (other < 0) return "";
    return is_angle(session.mechanism().joints[static_cast<std::size_t>(other)].type, i) ? "rad" : "m";
  };
  const std::string a = unit_of(0), b = unit_of(1);
  ratio_rows(session, ui, gear, a == b ? "" : b + "/" + a);
  std::function<void()> reset;
  if (gear.offset)
    reset = [&session, &ui, name = gear.name] {
      edit_joint(session, ui, "Offset of " + name + " as drawn", name,
                 [](Joint& same) { same.offset.reset(); });
    };
  number_row(session, ui, "Offset",
             {.name = "inspector/offset",
              .value = gear.offset.value_or(drawn_offset(session.mechanism(), gear)),
              .unit = b,
              .help = "Where b stands while a is zero.",
              .address = gear_address(gear, "offset"),
              .standard = !gear.offset},
             reset);
  if (is_of_several(ui)) return;
  const Command& backlash = command("edit.backlash");
  if (text_button(ui, "inspector/edit.backlash", backlash.title))
    later(ui, [&session] { give_backlash_to_selected(session); });
  help_on_hover(backlash.help);
}

} // namespace flyball
