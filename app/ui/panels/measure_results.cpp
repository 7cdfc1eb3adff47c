// The scene's measures, live: in the units of the screen, with the error that the coordinates' errors make.
#include "app/session/units.hpp"
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/goal_handle.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>

namespace flyball {

void measure_results(Session& session, Ui& ui) {
  const std::vector<MeasureSolution>& all = session.answer.solution.measures;
  if (all.empty()) return;
  const NumberStyle& numbers = session.options.numbers;
  const std::vector<NamedMeasure>& named = session.answer.mechanism->measures;
  heading(ui, "Measures");
  help_on_hover("At the phase of the drives as drawn.");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const MeasureSolution& m = all[i];
    const ShownUnit unit = shown_unit(m.unit, session.units);
    std::string help = named[i].description.empty() ? "" : named[i].description + "\n";
    help += "=" + named[i].text;
    if (!m.value) {
      row(ui, m.name, "-", "", (help + "\n" + m.reason).c_str());
      note_widget(ui.widgets, "results/measure/" + m.name);
    } else {
      const double error = m.error.value_or(numbers.noise * std::abs(*m.value));
      if (m.error)
        help += "\n± " + magnitude_text(std::max(*m.error, numbers.noise) * unit.factor, numbers) + " " +
                unit.text;
      if (m.nonunique) help += "\nNot unique: loops are redundant, and share their forces in many ways.";
      row(ui, m.name, value_text(unit.shown(*m.value), error * unit.factor, numbers), unit.text.c_str());
      goal_handle(session, ui,
                  {.name = "results/measure/" + m.name,
                   .wanted = m.name,
                   .value = *m.value,
                   .unit = m.unit,
                   .help = std::move(help)});
    }
  }
}

} // namespace flyball
