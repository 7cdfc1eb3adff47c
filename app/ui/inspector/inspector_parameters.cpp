// Named parameters and points of the scene, shown while nothing is selected.
#include "app/document/named_edits.hpp"
#include "app/render/icons.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/widgets/number_menu.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flyball {

namespace {

std::string used_by(const Mechanism& mechanism, const std::string& name) {
  const std::vector<std::string> users = users_of(mechanism, name);
  if (users.empty()) return "No expression uses it yet: type = and its name where a number stands.";
  return "Used by " + name_list(users) + ".";
}

// The name, in which it is given another one.
void named_field(Session& session, Ui& ui, const std::string& widget, const std::string& name, float width,
                 Rename rename) {
  if (!text_field(session, ui, name_text_field(session, widget, name, rename), width))
    help_on_hover(used_by(session.mechanism(), name).c_str());
}

void edit_parameter_of_name(Session& session, Ui& ui, const std::string& step, const std::string& name,
                            std::function<void(NamedParameter&)> change) {
  edit_later(session, ui, step, [name, change = std::move(change)](Mechanism& mechanism, Selection&) {
    if (const int i = parameter_index(mechanism, name); i >= 0)
      change(mechanism.parameters[static_cast<std::size_t>(i)]);
  });
}

std::string unit_mistake(const std::string& typed) {
  const std::optional<Unit> unit = parse_unit(typed);
  return unit && unit->factor == 1 ? "" : "Expected an SI unit, such as m, kg, N/m, rad/s, or nothing.";
}

// Unit, range, note and the way out.
void parameter_popup(Session& session, Ui& ui, const NamedParameter& parameter, const std::string& widget) {
  if (!ImGui::BeginPopup("parameter")) return;
  const float labels = 52 * ui.scale, width = 150 * ui.scale;
  const auto label = [&](const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(labels);
  };
  const std::string& name = parameter.name;
  label("Unit");
  text_field(session, ui,
             {.name = widget + "/unit",
              .text = parameter.unit,
              .check = unit_mistake,
              .take =
                  [&session, &ui, name](const std::string& typed) {
                    edit_parameter_of_name(session, ui, "Unit of " + name, name,
                                           [typed](NamedParameter& each) { each.unit = typed; });
                  },
              .hint = "a plain number"},
             width);
  // Without a range of its own, that which its slider has.
  const auto slid = std::ranges::find(session.parameters, "parameters." + name, &ParameterControl::address);
  const std::array<double, 2> range =
      parameter.range.value_or(slid == session.parameters.end() ? std::array{parameter.value, parameter.value}
                                                                : std::array{slid->from, slid->to});
  for (const std::size_t end : {0U, 1U}) {
    label(end == 0 ? "From" : "To");
    quantity_field(session, ui,
                   {.name = widget + (end == 0 ? "/from" : "/to"),
                    .value = range[end],
                    .unit = parameter.unit,
                    .help = "Where its slider ends.",
                    .set =
                        [&session, &ui, name, range, end](double typed) {
                          edit_parameter_of_name(session, ui, "Range of " + name, name,
                                                 [range, end, typed](NamedParameter& each) {
                                                   each.range = range;
                                                   (*each.range)[end] = typed;
                                                 });
                        },
                    .standard = !parameter.range},
                   width);
  }
  label("Note");
  text_field(session, ui,
             {.name = widget + "/note",
              .text = parameter.description,
              .check = {},
              .take =
                  [&session, &ui, name](const std::string& typed) {
                    edit_parameter_of_name(session, ui, "Describe " + name, name,
                                           [typed](NamedParameter& each) { each.description = typed; });
                  }},
             width);
  if (text_button(ui, widget + "/remove", "Remove")) {
    edit_later(session, ui, "Remove " + name,
               [name](Mechanism& mechanism, Selection&) { remove_parameter(mechanism, name); });
    ImGui::CloseCurrentPopup();
  }
  help_on_hover("What it gave stays what it is now.");
  ImGui::EndPopup();
}

void parameter_row(Session& session, Ui& ui, const NamedParameter& parameter) {
  const std::string widget = "inspector/parameter/" + parameter.name;
  const float labels = label_width(ui), margin = margin_width(ui), start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  named_field(session, ui, widget + "/name", parameter.name, labels - 4 * ui.scale, rename_parameter);
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(start + labels);
  QuantityField field{.name = widget,
                      .value = parameter.value,
                      .unit = parameter.unit,
                      .help = parameter.description,
                      .address = "parameters." + parameter.name};
  if (parameter.unit.empty())
    field.set_with_unit = [&session, &ui, name = parameter.name](double value, const std::string& unit) {
      edit_parameter_of_name(session, ui, "Set " + name, name, [value, unit](NamedParameter& each) {
        each.value = value;
        each.unit = unit;
      });
    };
  quantity_field(session, ui, field, std::max(width - labels - margin, 20 * ui.scale));
  ImGui::SameLine(0, 0);
  ImGui::PushID(widget.c_str());
  if (margin_button(ui, widget + "/more", icon::gear, "Unit, range, note; remove it."))
    ImGui::OpenPopup("parameter");
  parameter_popup(session, ui, parameter, widget);
  ImGui::PopID();
}

// The point whose row is worked in is selected in the view, and marked in the list.
void follow_row(Session& session, const Ui& ui, ToolState& tool, const NamedPoint& point,
                const std::string& widget, const ImVec2& from) {
  for (const char* field : {"/name", "/x", "/y", "/z"})
    if (typing_in(ui, widget + field) || has_keyboard(ui, widget + field))
      select_point(session, tool, point.name);
  if (selected_point(session, tool) != &point) return;
  const float x = from.x - 5 * ui.scale;
  ImGui::GetWindowDrawList()->AddRectFilled({x, from.y}, {x + 2 * ui.scale, ImGui::GetItemRectMax().y},
                                            packed(colors_of(ui).accent));
}

void point_rows(Session& session, Ui& ui, ToolState& tool, const NamedPoint& point) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const std::string widget = "inspector/point/" + point.name;
  const float width = ImGui::GetContentRegionAvail().x, margin = margin_width(ui);
  named_field(session, ui, widget + "/name", point.name, width - margin, rename_point);
  ImGui::SameLine(0, 0);
  if (margin_button(ui, widget + "/remove", icon::trash, "Remove it; what stands there stays where it is."))
    edit_later(session, ui, "Remove " + point.name,
               [name = point.name](Mechanism& mechanism, Selection&) { remove_point(mechanism, name); });
  vector_rows(session, ui, "",
              {.name = widget,
               .value = point.at,
               .unit = "m",
               .help = "In the world, as drawn; what stands there moves along.",
               .address = "points." + point.name});
  follow_row(session, ui, tool, point, widget, from);
}

void points_section(Session& session, Ui& ui, ToolState& tool) {
  for (const NamedPoint& point : session.mechanism().points)
    point_rows(session, ui, tool, point);
  if (text_button(ui, "inspector/points/add", "Add a point"))
    edit_later(session, ui, "Add a point", [](Mechanism& changed, Selection&) {
      NamedPoint point;
      point.name = free_name(changed, "A");
      changed.points.push_back(std::move(point));
    });
  help_on_hover(
      "A place with a name. =A.x, =A.y and =A.z give its coordinates, and what they give moves with it.");
}

} // namespace

void named_sections(Session& session, Ui& ui, ToolState& tool) {
  const Mechanism& mechanism = session.mechanism();
  if (inspector_section(session, ui, "inspector/parameters section", "Parameters",
                        !mechanism.parameters.empty())) {
    for (const NamedParameter& parameter : mechanism.parameters)
      parameter_row(session, ui, parameter);
    if (text_button(ui, "inspector/parameters/add", "Add a parameter"))
      edit_later(session, ui, "Add a parameter", [](Mechanism& changed, Selection&) {
        NamedParameter parameter;
        parameter.name = free_name(changed, "p");
        parameter.value = 1;
        changed.parameters.push_back(std::move(parameter));
      });
    help_on_hover(
        "A number with a name. Where a number stands, =name uses it, as in =2*p or =p*cos(30 deg).");
  }
  if (inspector_section(session, ui, "inspector/points section", "Points", !mechanism.points.empty()))
    points_section(session, ui, tool);
  measures_section(session, ui);
}

} // namespace flyball
