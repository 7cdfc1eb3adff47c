// Measures of the scene, shown while nothing is selected: names, expressions, what they come to.
#include "app/document/measure_edits.hpp"
#include "app/render/icons.hpp"
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>

namespace flyball {

namespace {

// A text of a measure, which is checked in the place of the one there is.
void measure_field(Session& session, Ui& ui, const NamedMeasure& measure, const std::string& widget,
                   const std::string& step, const std::string& shown, float width, const char* hint,
                   const std::function<NamedMeasure(const std::string& typed)>& with) {
  text_field(session, ui,
             {.name = widget,
              .text = shown,
              .check =
                  [&session, name = measure.name, with](const std::string& typed) {
                    return measure_mistake(session.document.stored(), name, with(typed));
                  },
              .take =
                  [&session, name = measure.name, step, with](const std::string& typed) {
                    edit(session, step, [&](Mechanism& mechanism, Selection&) {
                      set_measure(mechanism, name, with(typed));
                    });
                  },
              .hint = hint,
              .expression = widget == "inspector/measure/" + measure.name},
             width);
}

// Unit, note and the way out.
void measure_popup(Session& session, Ui& ui, const NamedMeasure& measure, const std::string& widget) {
  if (!ImGui::BeginPopup("measure")) return;
  const float labels = 52 * ui.scale, width = 150 * ui.scale;
  const auto label = [&](const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(labels);
  };
  label("Unit");
  measure_field(session, ui, measure, widget + "/unit", "Unit of " + measure.name, measure.unit, width,
                "a plain number", [measure](const std::string& typed) {
                  NamedMeasure changed = measure;
                  changed.unit = typed;
                  return changed;
                });
  label("Note");
  measure_field(session, ui, measure, widget + "/note", "Describe " + measure.name, measure.description,
                width, "", [measure](const std::string& typed) {
                  NamedMeasure changed = measure;
                  changed.description = typed;
                  return changed;
                });
  if (text_button(ui, widget + "/remove", "Remove")) {
    edit_later(session, ui, "Remove " + measure.name,
               [name = measure.name](Mechanism& mechanism, Selection&) { remove_measure(mechanism, name); });
    ImGui::CloseCurrentPopup();
  }
  help_on_hover("Measures that use it have its expression instead.");
  ImGui::EndPopup();
}

// What it comes to now: "0.134 m".
std::string present_text(const Session& session, const std::string& name) {
  const std::vector<MeasureSolution>& all = session.answer.solution.measures;
  const auto found = std::ranges::find(all, name, &MeasureSolution::name);
  if (found == all.end()) return "No value: there is no steady state.";
  if (!found->value) return found->reason;
  const ShownUnit unit = shown_unit(found->unit, session.units);
  return short_text(unit.shown(*found->value), 6) + (unit.text.empty() ? "" : " " + unit.text);
}

// "=y(ball)", with or without what makes it an expression.
std::string without_sign(const std::string& typed) {
  return typed.starts_with("=") ? typed.substr(1) : typed;
}

void measure_row(Session& session, Ui& ui, const NamedMeasure& measure) {
  const std::string widget = "inspector/measure/" + measure.name;
  const float labels = label_width(ui), margin = margin_width(ui), start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  measure_field(session, ui, measure, widget + "/name", "Rename " + measure.name, measure.name,
                labels - 4 * ui.scale, "", [measure](const std::string& typed) {
                  NamedMeasure changed = measure;
                  changed.name = typed;
                  return changed;
                });
  help_on_hover(present_text(session, measure.name).c_str());
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(start + labels);
  measure_field(session, ui, measure, widget, "Change " + measure.name, "=" + measure.text,
                std::max(width - labels - margin, 20 * ui.scale), "=y(ball)",
                [&session, measure](const std::string& typed) {
                  return with_expression(session.document.stored(), measure, without_sign(typed));
                });
  help_on_hover(present_text(session, measure.name).c_str());
  ImGui::SameLine(0, 0);
  ImGui::PushID(widget.c_str());
  if (margin_button(ui, widget + "/more", icon::gear, "Unit, note; remove it.")) ImGui::OpenPopup("measure");
  measure_popup(session, ui, measure, widget);
  ImGui::PopID();
}

// "x(ball@A), torque(spin), ...": what can be asked for.
std::string all_functions() {
  std::string all;
  for (const ResultFunction& function : result_functions())
    all += (all.empty() ? "" : ", ") + std::string(function.example);
  return all;
}

} // namespace

void measures_section(Session& session, Ui& ui) {
  const Mechanism& mechanism = session.mechanism();
  if (!inspector_section(session, ui, "inspector/measures section", "Measures", !mechanism.measures.empty()))
    return;
  for (const NamedMeasure& measure : mechanism.measures)
    measure_row(session, ui, measure);
  if (text_button(ui, "inspector/measures/add", "Add a measure"))
    edit_later(session, ui, "Add a measure",
               [](Mechanism& changed, Selection&) { changed.measures.push_back(new_measure(changed)); });
  static const std::string help =
      "A number made of results, shown with them, in curves and over time, and wanted in design. It may ask "
      "for " +
      all_functions() + "; names that are no words in quotes.";
  help_on_hover(help.c_str());
}

} // namespace flyball
