#include "app/ui/widgets/number_menu.hpp"

#include "app/document/formula_edits.hpp"
#include "app/session/parameter_list.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <cctype>

namespace flyball {

namespace {

// "m" for a mass, "stiffness" for a stiffness: a name to begin with.
std::string suggested_name(const Mechanism& mechanism, const std::string& address) {
  std::string last = parameter_phrase(address);
  last = last.substr(0, last.find(" of "));
  std::string name;
  for (const char c : last)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return free_name(mechanism, is_expression_name(name) ? name : "p");
}

// An entry of the menu; whether it was chosen.
bool entry(App& app, const QuantityField& field, const char* text, const std::string& name) {
  const bool chosen = ImGui::Selectable(text);
  note_widget(app.widgets, field.name + "/" + name);
  return chosen;
}

void name_it(App& app, const std::string& place) {
  const std::string name = suggested_name(app.document.stored(), place), phrase = parameter_phrase(place);
  edit(app, "Name " + phrase, [&](Mechanism& mechanism, Selection&) { name_number(mechanism, place, name); });
  if (parameter_index(app.mechanism(), name) >= 0)
    app.notice = "The " + phrase + " is the parameter " + name +
                 " now, with a slider. It is renamed in the scene's inspector, where nothing is selected.";
}

void name_the_point(App& app, const std::string& vector) {
  const std::string name = free_name(app.document.stored(), "A");
  edit(app, "Name a point", [&](Mechanism& mechanism, Selection&) { name_place(mechanism, vector, name); });
  if (point_index(app.mechanism(), name) >= 0)
    app.notice = "The point is called " + name +
                 " now, and what stands there moves with it. It is renamed in the scene's inspector, where "
                 "nothing is selected.";
}

// The named point that a vector stands at; empty: none.
std::string named_point_of(const Mechanism& mechanism, const std::string& vector) {
  for (const NamedPoint& point : mechanism.points) {
    bool stands = true;
    for (const int i : {0, 1, 2})
      stands = stands &&
               expression_at(mechanism, vector + "." + std::to_string(i)) == point_coordinate(point.name, i);
    if (stands) return point.name;
  }
  return {};
}

void leave_point(App& app, const std::string& vector, const std::string& point) {
  edit(app, "Leave " + point, [&](Mechanism& mechanism, Selection&) {
    for (const int i : {0, 1, 2})
      set_expression(mechanism, vector + "." + std::to_string(i), "");
  });
}

// Of a vector that may stand at a point; a named point's own stays where it is.
void point_entries(App& app, const QuantityField& field) {
  const std::string vector = vector_of(field);
  if (vector.empty() || vector.starts_with("points.")) return;
  const std::string at = named_point_of(app.mechanism(), vector);
  if (!at.empty() && entry(app, field, ("Leave " + at).c_str(), "leave point"))
    later(app, [&app, vector, at] { leave_point(app, vector, at); });
  if (at.empty() && entry(app, field, "Name this point", "name point"))
    later(app, [&app, vector] { name_the_point(app, vector); });
  const std::vector<NamedPoint>& points = app.mechanism().points;
  for (const NamedPoint& point : points)
    if (point.name != at && entry(app, field, ("Stand at " + point.name).c_str(), "at " + point.name))
      later(app, [&app, vector, name = point.name] {
        edit(app, "Stand at " + name,
             [&](Mechanism& mechanism, Selection&) { stand_at_point(mechanism, vector, name); });
      });
  if (points.empty() || app.mode != Mode::build) return;
  if (entry(app, field, "Pick a named point in the view", "pick"))
    later(app, [&app, vector] { app.fields.picking = vector; });
}

} // namespace

const std::string& place_of(const QuantityField& field) {
  return field.address.empty() ? field.expression : field.address;
}

std::string vector_of(const QuantityField& field) {
  const std::string& place = place_of(field);
  return field.axis >= 0 && field.unit == "m" ? place.substr(0, place.rfind('.')) : "";
}

std::optional<std::string> formula_of(const App& app, const QuantityField& field) {
  if (place_of(field).empty() || !field.various.empty()) return {};
  return expression_at(app.mechanism(), place_of(field));
}

void number_menu(App& app, const QuantityField& field, bool asked) {
  const std::string& place = place_of(field);
  if (place.empty() || !field.various.empty() || field.name.starts_with("parameters/")) return;
  ImGui::PushID(field.name.c_str());
  if (asked || takes_menu_key(app, field.name)) ImGui::OpenPopup("number");
  if (ImGui::BeginPopup("number")) {
    if (!place.starts_with("parameters.") && entry(app, field, "Name this number", "name it"))
      later(app, [&app, place] { name_it(app, place); });
    if (formula_of(app, field) && entry(app, field, "Leave the value without its expression", "take off"))
      later(app, [&app, place] {
        edit(app, "Take the expression off " + parameter_phrase(place),
             [&](Mechanism& mechanism, Selection&) { set_expression(mechanism, place, ""); });
      });
    point_entries(app, field);
    if (!field.address.empty() && entry(app, field, "Copy the address", "copy address"))
      ImGui::SetClipboardText(field.address.c_str());
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

} // namespace flyball
