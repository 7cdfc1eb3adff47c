#include "app/ui/inspector/inspector_rows.hpp"

#include "app/document/formula_edits.hpp"
#include "app/document/rename.hpp"
#include "app/render/icons.hpp"
#include "app/ui/widgets/number_menu.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace flyball {

namespace {

template <class List, class Change>
void change_named(List& list, const std::string& name, const Change& change) {
  const auto found = std::ranges::find_if(list, [&](const auto& part) { return part.name == name; });
  if (found != list.end()) change(*found);
}

// Of a joint or force, whose fields are called the same.
template <class Change>
void change_bodies(Session& session, Ui& ui, const Part& part, const Change& change) {
  if (part.kind == PartKind::joint)
    edit_joint(session, ui, "Bodies of " + part.name, part.name, change);
  else
    edit_force(session, ui, "Bodies of " + part.name, part.name, change);
}

void swap_bodies(Session& session, Ui& ui, const Part& part) {
  change_bodies(session, ui, part, [](auto& held) {
    std::swap(held.bodies[0], held.bodies[1]);
    std::swap(held.points[0], held.points[1]);
  });
}

} // namespace

void edit_later(Session& session, Ui& ui, const std::string& step,
                std::function<void(Mechanism&, Selection&)> change) {
  later(ui, [&session, step, change = std::move(change)] {
    edit(session, step, [&](Mechanism& mechanism, Selection& selection) {
      change(mechanism, selection);
      drop_lost_sliders(session.mechanism(), mechanism);
    });
  });
}

std::vector<std::string> edited_with(const Ui& ui, const Part& part) {
  std::vector<std::string> names{part.name};
  const std::vector<Part>& together = ui.fields.together;
  if (!together.empty() && together.front() == part)
    for (auto other = together.begin() + 1; other != together.end(); ++other)
      names.push_back(other->name);
  return names;
}

bool is_of_several(const Ui& ui) {
  return !ui.fields.together.empty();
}

namespace {

template <class PartType>
std::vector<const PartType*> others_among(const std::vector<PartType>& list, const Ui& ui, PartKind kind,
                                          const std::string& name) {
  const std::vector<std::string> names = edited_with(ui, {kind, name});
  std::vector<const PartType*> others;
  for (auto other = names.begin() + 1; other != names.end(); ++other)
    if (const auto found = std::ranges::find(list, *other, &PartType::name); found != list.end())
      others.push_back(&*found);
  return others;
}

template <class PartType>
void edit_each(Session& session, Ui& ui, const std::string& step, const Part& part,
               std::vector<PartType> Mechanism::*list, std::function<void(PartType&)> change) {
  const std::vector<std::string> names = edited_with(ui, part);
  edit_later(session, ui, step + and_more(names.size() - 1),
             [names, list, change = std::move(change)](Mechanism& mechanism, Selection&) {
               for (const std::string& name : names)
                 change_named(mechanism.*list, name, change);
             });
}

} // namespace

std::vector<const Body*> others_edited(const Session& session, const Ui& ui, const Body& body) {
  return others_among(session.mechanism().bodies, ui, PartKind::body, body.name);
}

std::vector<const Joint*> others_edited(const Session& session, const Ui& ui, const Joint& joint) {
  return others_among(session.mechanism().joints, ui, PartKind::joint, joint.name);
}

std::vector<const Force*> others_edited(const Session& session, const Ui& ui, const Force& force) {
  return others_among(session.mechanism().forces, ui, PartKind::force, force.name);
}

void edit_body(Session& session, Ui& ui, const std::string& step, const std::string& name,
               std::function<void(Body&)> change) {
  edit_each(session, ui, step, {PartKind::body, name}, &Mechanism::bodies, std::move(change));
}

void edit_joint(Session& session, Ui& ui, const std::string& step, const std::string& name,
                std::function<void(Joint&)> change) {
  edit_each(session, ui, step, {PartKind::joint, name}, &Mechanism::joints, std::move(change));
}

void edit_force(Session& session, Ui& ui, const std::string& step, const std::string& name,
                std::function<void(Force&)> change) {
  edit_each(session, ui, step, {PartKind::force, name}, &Mechanism::forces, std::move(change));
}

bool edit_together(const Session& session, const Ui& ui, QuantityField& field) {
  if (!is_of_several(ui)) return true;
  const Part& first = ui.fields.together.front();
  const std::string list = first.kind == PartKind::body    ? "bodies."
                           : first.kind == PartKind::joint ? "joints."
                                                           : "forces.";
  const std::string& place = place_of(field);
  const std::string part = list + first.name + ".";
  if (!place.starts_with(part)) return false;
  const Mechanism& mechanism = session.mechanism();
  try {
    const double value = expressed_value(mechanism, place);
    const std::optional<std::string> expression = expression_at(mechanism, place);
    for (auto other = ui.fields.together.begin() + 1; other != ui.fields.together.end(); ++other) {
      const std::string its = list + other->name + "." + place.substr(part.size());
      if (expressed_value(mechanism, its) != value || expression_at(mechanism, its) != expression)
        field.various = "various";
      field.also.push_back(its);
    }
  } catch (const SceneError&) {
    return false; // not all of them have it
  }
  if (!field.various.empty()) field.law.clear();
  return true;
}

void number_row(Session& session, Ui& ui, const std::string& label, QuantityField field,
                const std::function<void()>& reset) {
  if (edit_together(session, ui, field)) quantity_row(session, ui, label, field, reset);
}

void drop_lost_sliders(const Mechanism& before, Mechanism& mechanism) {
  const auto known = [](const Mechanism& in, const std::string& address) {
    try {
      get_parameter(in, address);
      return true;
    } catch (const SceneError&) {
      return false;
    }
  };
  std::erase_if(mechanism.sliders, [&](const Slider& slider) {
    return !known(mechanism, slider.parameter) && known(before, slider.parameter);
  });
}

bool inspector_section(const Session& session, Ui& ui, const std::string& name, const char* title,
                       bool open) {
  const auto found = ui.sections.open.find(name);
  bool now = open;
  if (found != ui.sections.open.end()) {
    now = found->second;
  } else {
    // What is open stays open while one works in it, even if the last number that opened it goes. None opens
    // of itself while the hand is in the inspector: what is below would move from under it.
    if (ui.sections.seen_of.parts != session.selection().parts) {
      ui.sections.seen.clear();
      ui.sections.seen_of = session.selection();
    }
    const bool first = !ui.sections.seen.contains(name);
    const bool at_work =
        ui.keyboard.at.starts_with("inspector/") || ui.fields.typing.name.starts_with("inspector/");
    bool& seen = ui.sections.seen[name];
    now = seen = seen || (open && (first || !at_work));
  }
  const bool before = now;
  ImGui::Dummy({0, 2 * ui.scale});
  section(ui, name, title, now);
  if (now != before) ui.sections.open[name] = now;
  // A number is looked for that may be in it.
  ui.keyboard.section = name;
  return now || !ui.keyboard.sought.empty();
}

float row_label(const Ui& ui, const std::string& label, const char* help) {
  const float labels = label_width(ui), width = ImGui::GetContentRegionAvail().x;
  const float start = ImGui::GetCursorPosX();
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).dim);
  clipped_text(label, labels - 3 * ui.scale);
  ImGui::PopStyleColor();
  help_on_hover(help);
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(start + labels);
  return std::max(width - labels - margin_width(ui), 20 * ui.scale);
}

namespace {

// Without blanks at its ends: nobody sees them, and two names that differ in them alone look the same.
std::string without_ends(const std::string& name) {
  const std::size_t first = name.find_first_not_of(' ');
  return first == std::string::npos ? std::string()
                                    : name.substr(first, name.find_last_not_of(' ') - first + 1);
}

} // namespace

bool name_field(Session& session, Ui& ui, const std::string& widget, const Part& part, float width) {
  TextField field{.name = widget,
                  .text = part.name,
                  .check =
                      [&session, part](const std::string& typed) {
                        try {
                          Mechanism copy = session.mechanism();
                          rename_part(copy, part, without_ends(typed));
                          return std::string();
                        } catch (const SceneError& error) {
                          return error.expected();
                        }
                      },
                  .take =
                      [&session, part](const std::string& typed) {
                        const std::string name = without_ends(typed);
                        edit(session, "Rename " + part.name + " to " + name,
                             [&](Mechanism& mechanism, Selection& selection) {
                               rename_part(mechanism, part, name);
                               std::ranges::replace(selection.parts, part, Part{part.kind, name});
                             });
                      }};
  return text_field(session, ui, field, width);
}

void name_row(Session& session, Ui& ui, const Part& part) {
  const char* help = "What the part is called in the scene, in results and in addresses.";
  const float width = row_label(ui, "Name", help);
  if (!name_field(session, ui, "inspector/name", part, width)) help_on_hover(help);
}

void text_row(Session& session, Ui& ui, const std::string& name, const std::string& label,
              const std::string& text, const char* help,
              const std::function<void(const std::string&)>& take) {
  const float width = row_label(ui, label, help);
  if (!text_field(session, ui, {.name = name, .text = text, .check = {}, .take = take}, width) &&
      !text.empty())
    help_on_hover(text.c_str());
}

bool check_row(Ui& ui, const std::string& name, const std::string& label, bool on, const char* help,
               const char* refused, bool mixed) {
  bool now = on;
  const float row_height = ImGui::GetFrameHeight();
  ImGui::BeginDisabled(refused != nullptr);
  ImGui::PushID(name.c_str());
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, std::max(1.f, std::round(ui.scale)));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {8 * ui.scale, 1 * ui.scale});
  // As high as other rows, so that several can stand in one.
  const float spare = std::max(row_height - ImGui::GetFrameHeight(), 0.f);
  ImGui::BeginGroup();
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + spare / 2);
  ImGui::PushItemFlag(ImGuiItemFlags_MixedValue, mixed);
  const bool clicked = ImGui::Checkbox(label.c_str(), &now);
  ImGui::PopItemFlag();
  note_stop(ui.widgets, name);
  const float used = ImGui::GetItemRectSize().x;
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y);
  ImGui::Dummy({used, spare / 2});
  ImGui::EndGroup();
  ImGui::PopStyleVar(2);
  ImGui::PopID();
  ImGui::EndDisabled();
  note_widget(ui.widgets, name);
  help_on_hover(refused ? refused : help);
  return clicked;
}

void vector_rows(Session& session, Ui& ui, const std::string& label, const VectorField& field,
                 const std::function<void()>& reset) {
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    QuantityField number{.name = field.name + "/" + axis_letters[at],
                         .value = field.value[i],
                         .unit = field.unit,
                         .help = field.help,
                         .standard = field.standard,
                         .axis = i,
                         .follow = field.follow};
    if (!field.address.empty()) number.address = field.address + "." + std::to_string(i);
    if (!field.expression.empty()) number.expression = field.expression + "." + std::to_string(i);
    if (field.set) number.set = [set = field.set, i](double value) { set(i, value); };
    number_row(session, ui, i == 0 ? label : "", std::move(number), i == 0 ? reset : std::function<void()>());
  }
}

std::vector<std::string> body_choices(const Mechanism& mechanism, bool ground) {
  std::vector<std::string> names;
  if (ground) names.emplace_back(ground_name);
  for (const Body& body : mechanism.bodies)
    names.push_back(body.name);
  return names;
}

namespace {

// Whether an end of the parts that are edited together is on different bodies.
template <class List>
bool differ_at(const List& list, const Ui& ui, const Part& part, std::size_t end) {
  const std::vector<std::string> names = edited_with(ui, part);
  const std::string* first = nullptr;
  for (const std::string& name : names)
    for (const auto& each : list)
      if (each.name == name && !first)
        first = &each.bodies[end];
      else if (each.name == name && each.bodies[end] != *first)
        return true;
  return false;
}

} // namespace

void body_end_row(Session& session, Ui& ui, const Part& part, const std::array<std::string, 2>& bodies,
                  std::size_t end, const char* label, const char* help) {
  const std::vector<std::string> choices = body_choices(session.mechanism(), true);
  const std::string name = "inspector/bodies/" + std::to_string(end);
  const bool various = part.kind == PartKind::joint ? differ_at(session.mechanism().joints, ui, part, end)
                                                    : differ_at(session.mechanism().forces, ui, part, end);
  if (!help)
    help = end == 0 ? "The first body: what coordinates and reactions are counted from."
                    : "The second body, which a positive coordinate moves.";
  if (const auto chosen =
          name_choice_row(ui, name, label, choices, various ? "various" : bodies[end], help)) {
    if (!is_of_several(ui) && *chosen == bodies[1 - end]) // two ends on one body have no meaning
      swap_bodies(session, ui, part);
    else
      change_bodies(session, ui, part, [end, body = *chosen](auto& held) {
        if (held.bodies[1 - end] != body) held.bodies[end] = body;
      });
  }
  if (end == 0) return;
  ImGui::SameLine(0, 0);
  if (margin_button(ui, "inspector/bodies/swap", icon::swap, "Swap the two.")) swap_bodies(session, ui, part);
}

void end_point_rows(Session& session, Ui& ui, const Part& part, const std::array<Vec3, 2>& points,
                    std::size_t end) {
  const char* list = part.kind == PartKind::joint ? "joints." : "forces.";
  vector_rows(session, ui, "at",
              {.name = "inspector/points/" + std::to_string(end),
               .value = points[end],
               .unit = "m",
               .help = "Where it holds that body, in the world, as drawn.",
               .address = list + part.name + ".points." + std::to_string(end)});
}

} // namespace flyball
