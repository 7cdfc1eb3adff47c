// Named parameters and points of the scene, shown while nothing is selected.
#include "app/document/formula_edits.hpp"
#include "app/render/icons.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

namespace flyball {

namespace {

using Rename = void (*)(Mechanism&, const std::string&, const std::string&);

std::string used_by(const Mechanism& mechanism, const std::string& name) {
  const std::vector<std::string> users = users_of(mechanism, name);
  if (users.empty()) return "No expression uses it yet: type = and its name where a number stands.";
  return "Used by " + name_list(users) + ".";
}

// The name, in which it is given another one.
void named_field(App& app, const std::string& widget, const std::string& name, float width, Rename rename) {
  const TextField field{.name = widget,
                        .text = name,
                        .check =
                            [&app, name, rename](const std::string& typed) {
                              try {
                                Mechanism copy = app.document.stored();
                                rename(copy, name, typed);
                                return std::string();
                              } catch (const SceneError& error) {
                                return error.expected();
                              }
                            },
                        .take =
                            [&app, name, rename](const std::string& typed) {
                              edit(app, "Rename " + name + " to " + typed,
                                   [&](Mechanism& mechanism, Selection&) { rename(mechanism, name, typed); });
                            }};
  if (!text_field(app, field, width)) help_on_hover(used_by(app.mechanism(), name).c_str());
}

void edit_parameter_of_name(App& app, const std::string& step, const std::string& name,
                            std::function<void(NamedParameter&)> change) {
  edit_later(app, step, [name, change = std::move(change)](Mechanism& mechanism, Selection&) {
    if (const int i = parameter_index(mechanism, name); i >= 0)
      change(mechanism.parameters[static_cast<std::size_t>(i)]);
  });
}

std::string unit_mistake(const std::string& typed) {
  const std::optional<Unit> unit = parse_unit(typed);
  return unit && unit->factor == 1 ? "" : "Expected an SI unit, such as m, kg, N/m, rad/s, or nothing.";
}

// Unit, range, note and the way out.
void parameter_popup(App& app, const NamedParameter& parameter, const std::string& widget) {
  if (!ImGui::BeginPopup("parameter")) return;
  const float labels = 52 * app.scale, width = 150 * app.scale;
  const auto label = [&](const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(labels);
  };
  const std::string& name = parameter.name;
  label("Unit");
  text_field(app,
             {.name = widget + "/unit",
              .text = parameter.unit,
              .check = unit_mistake,
              .take =
                  [&app, name](const std::string& typed) {
                    edit_parameter_of_name(app, "Unit of " + name, name,
                                           [typed](NamedParameter& each) { each.unit = typed; });
                  },
              .hint = "a plain number"},
             width);
  const std::array<double, 2> range = parameter.range.value_or(std::array{parameter.value, parameter.value});
  for (const std::size_t end : {0U, 1U}) {
    label(end == 0 ? "From" : "To");
    quantity_field(app,
                   {.name = widget + (end == 0 ? "/from" : "/to"),
                    .value = range[end],
                    .unit = parameter.unit,
                    .help = "Where its slider ends.",
                    .set =
                        [&app, name, range, end](double typed) {
                          edit_parameter_of_name(app, "Range of " + name, name,
                                                 [range, end, typed](NamedParameter& each) {
                                                   each.range = range;
                                                   (*each.range)[end] = typed;
                                                 });
                        },
                    .standard = !parameter.range},
                   width);
  }
  label("Note");
  text_field(app,
             {.name = widget + "/note",
              .text = parameter.description,
              .check = {},
              .take =
                  [&app, name](const std::string& typed) {
                    edit_parameter_of_name(app, "Describe " + name, name,
                                           [typed](NamedParameter& each) { each.description = typed; });
                  }},
             width);
  if (text_button(app, widget + "/remove", "Remove")) {
    edit_later(app, "Remove " + name,
               [name](Mechanism& mechanism, Selection&) { remove_parameter(mechanism, name); });
    ImGui::CloseCurrentPopup();
  }
  help_on_hover("What it gave stays what it is now.");
  ImGui::EndPopup();
}

void parameter_row(App& app, const NamedParameter& parameter) {
  const std::string widget = "inspector/parameter/" + parameter.name;
  const float labels = label_width(app), margin = margin_width(app), start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  named_field(app, widget + "/name", parameter.name, labels - 4 * app.scale, rename_parameter);
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(start + labels);
  quantity_field(app,
                 {.name = widget,
                  .value = parameter.value,
                  .unit = parameter.unit,
                  .help = parameter.description,
                  .address = "parameters." + parameter.name},
                 std::max(width - labels - margin, 20 * app.scale));
  ImGui::SameLine(0, 0);
  ImGui::PushID(widget.c_str());
  if (margin_button(app, widget + "/more", icon::gear, "Unit, range, note; remove it."))
    ImGui::OpenPopup("parameter");
  parameter_popup(app, parameter, widget);
  ImGui::PopID();
}

// The point whose row is worked in is selected in the view, and marked in the list.
void follow_row(App& app, const NamedPoint& point, const std::string& widget, const ImVec2& from) {
  for (const char* field : {"/name", "/x", "/y", "/z"})
    if (typing_in(app, widget + field) || has_keyboard(app, widget + field)) select_point(app, point.name);
  if (selected_point(app) != &point) return;
  const float x = from.x - 5 * app.scale;
  ImGui::GetWindowDrawList()->AddRectFilled({x, from.y}, {x + 2 * app.scale, ImGui::GetItemRectMax().y},
                                            packed(colors_of(app).accent));
}

void point_rows(App& app, const NamedPoint& point) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const std::string widget = "inspector/point/" + point.name;
  const float width = ImGui::GetContentRegionAvail().x, margin = margin_width(app);
  named_field(app, widget + "/name", point.name, width - margin, rename_point);
  ImGui::SameLine(0, 0);
  if (margin_button(app, widget + "/remove", icon::trash, "Remove it; what stands there stays where it is."))
    edit_later(app, "Remove " + point.name,
               [name = point.name](Mechanism& mechanism, Selection&) { remove_point(mechanism, name); });
  vector_rows(app, "",
              {.name = widget,
               .value = point.at,
               .unit = "m",
               .help = "In the world, as drawn; what stands there moves along.",
               .address = "points." + point.name});
  follow_row(app, point, widget, from);
}

void points_section(App& app) {
  for (const NamedPoint& point : app.mechanism().points)
    point_rows(app, point);
  if (text_button(app, "inspector/points/add", "Add a point"))
    edit_later(app, "Add a point", [](Mechanism& changed, Selection&) {
      NamedPoint point;
      point.name = free_name(changed, "A");
      changed.points.push_back(std::move(point));
    });
  help_on_hover(
      "A place with a name. =A.x, =A.y and =A.z give its coordinates, and what they give moves with it.");
}

} // namespace

void named_sections(App& app) {
  const Mechanism& mechanism = app.mechanism();
  if (inspector_section(app, "inspector/parameters section", "Parameters", !mechanism.parameters.empty())) {
    for (const NamedParameter& parameter : mechanism.parameters)
      parameter_row(app, parameter);
    if (text_button(app, "inspector/parameters/add", "Add a parameter"))
      edit_later(app, "Add a parameter", [](Mechanism& changed, Selection&) {
        NamedParameter parameter;
        parameter.name = free_name(changed, "p");
        parameter.value = 1;
        changed.parameters.push_back(std::move(parameter));
      });
    help_on_hover(
        "A number with a name. Where a number stands, =name uses it, as in =2*p or =p*cos(30 deg).");
  }
  if (inspector_section(app, "inspector/points section", "Points", !mechanism.points.empty()))
    points_section(app);
  measures_section(app);
}

} // namespace flyball
