#include "app/ui/widgets/number_menu.hpp"

#include "app/document/formula_edits.hpp"
#include "app/document/named_edits.hpp"
#include "app/session/parameter_list.hpp"
#include "app/ui/keyboard/keyboard.hpp"
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
bool entry(Ui& ui, const QuantityField& field, const char* text, const std::string& name) {
  const bool chosen = ImGui::Selectable(text);
  note_widget(ui.widgets, field.name + "/" + name);
  return chosen;
}

void name_it(Session& session, Ui& ui, const std::string& field, const std::string& place,
             const std::vector<std::string>& also) {
  const std::string name = suggested_name(session.document.stored(), place),
                    phrase = parameter_phrase(place) + and_more(also.size());
  edit(session, "Name " + phrase, [&](Mechanism& mechanism, Selection&) {
    name_number(mechanism, place, name);
    for (const std::string& other : also)
      set_expression(mechanism, other, name);
  });
  if (parameter_index(session.mechanism(), name) < 0) return;
  session.notice =
      "The " + phrase + " is the parameter " + name +
      " now, with a slider. Its name can be changed in the scene's inspector, too, where nothing is "
      "selected.";
  start_typing(session, ui, naming_field(field), name);
}

void name_the_point(Session& session, const std::string& vector) {
  const std::string name = free_name(session.document.stored(), "A");
  edit(session, "Name a point",
       [&](Mechanism& mechanism, Selection&) { name_place(mechanism, vector, name); });
  if (point_index(session.mechanism(), name) >= 0)
    session.notice =
        "The point is called " + name +
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

void leave_point(Session& session, const std::string& vector, const std::string& point) {
  edit(session, "Leave " + point, [&](Mechanism& mechanism, Selection&) {
    for (const int i : {0, 1, 2})
      set_expression(mechanism, vector + "." + std::to_string(i), "");
  });
}

// Of a vector that may stand at a point; a named point's own stays where it is.
void point_entries(Session& session, Ui& ui, const QuantityField& field) {
  const std::string vector = vector_of(field);
  if (vector.empty() || vector.starts_with("points.")) return;
  const std::string at = named_point_of(session.mechanism(), vector);
  if (!at.empty() && entry(ui, field, ("Leave " + at).c_str(), "leave point"))
    later(ui, [&session, vector, at] { leave_point(session, vector, at); });
  if (at.empty() && entry(ui, field, "Name this point", "name point"))
    later(ui, [&session, vector] { name_the_point(session, vector); });
  const std::vector<NamedPoint>& points = session.mechanism().points;
  for (const NamedPoint& point : points)
    if (point.name != at && entry(ui, field, ("Stand at " + point.name).c_str(), "at " + point.name))
      later(ui, [&session, vector, name = point.name] {
        edit(session, "Stand at " + name,
             [&](Mechanism& mechanism, Selection&) { stand_at_point(mechanism, vector, name); });
      });
  if (points.empty() || session.mode != Mode::build) return;
  if (entry(ui, field, "Pick a named point in the view", "pick"))
    later(ui, [&ui, vector] { ui.fields.picking = vector; });
}

} // namespace

const std::string& place_of(const QuantityField& field) {
  return field.address.empty() ? field.expression : field.address;
}

std::string vector_of(const QuantityField& field) {
  const std::string& place = place_of(field);
  return field.axis >= 0 && field.unit == "m" ? place.substr(0, place.rfind('.')) : "";
}

std::optional<std::string> formula_of(const Session& session, const QuantityField& field) {
  if (place_of(field).empty() || !field.various.empty()) return {};
  return expression_at(session.mechanism(), place_of(field));
}

std::string naming_field(const std::string& field) {
  return field + "/name";
}

TextField name_text_field(Session& session, const std::string& widget, const std::string& name,
                          Rename rename) {
  return {.name = widget,
          .text = name,
          .check =
              [&session, name, rename](const std::string& typed) {
                try {
                  Mechanism copy = session.document.stored();
                  rename(copy, name, typed);
                  return std::string();
                } catch (const SceneError& error) {
                  return error.expected();
                }
              },
          .take =
              [&session, name, rename](const std::string& typed) {
                edit(session, "Rename " + name + " to " + typed,
                     [&](Mechanism& mechanism, Selection&) { rename(mechanism, name, typed); });
              }};
}

void number_menu(Session& session, Ui& ui, const QuantityField& field, bool asked) {
  const std::string& place = place_of(field);
  if (place.empty() || !field.various.empty() || !field.law.empty() || field.name.starts_with("parameters/"))
    return;
  ImGui::PushID(field.name.c_str());
  if (asked || takes_menu_key(ui, field.name)) ImGui::OpenPopup("number");
  if (ImGui::BeginPopup("number")) {
    if (!place.starts_with("parameters.") && entry(ui, field, "Name this number", "name it"))
      later(ui, [&session, &ui, name = field.name, place, also = field.also] {
        name_it(session, ui, name, place, also);
      });
    if (formula_of(session, field) && entry(ui, field, "Leave the value without its expression", "take off"))
      later(ui, [&session, place, also = field.also] {
        edit(session, "Take the expression off " + parameter_phrase(place) + and_more(also.size()),
             [&](Mechanism& mechanism, Selection&) {
               set_expression(mechanism, place, "");
               for (const std::string& other : also)
                 set_expression(mechanism, other, "");
             });
      });
    if (field.also.empty()) point_entries(session, ui, field);
    if (!field.address.empty() && entry(ui, field, "Copy the address", "copy address"))
      ImGui::SetClipboardText(field.address.c_str());
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

} // namespace flyball
