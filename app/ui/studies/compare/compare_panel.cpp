// Error against run time: the direct solution and the motion, measured on the scene as it is now.
#include "app/plot/comparison_plot.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace flyball {

namespace {

constexpr float words_width = 292; // points

void found(const Session& session, Ui& ui, const Comparison& c) {
  const UiColors& colors = colors_of(ui);
  const NumberStyle& numbers = session.options.numbers;
  if (c.status != Status::converged) return paragraph(c.message, colors.bad);
  row(ui, "Direct solution", duration_text(c.answer.run_time_s, numbers), "",
      "From the drawn pose to the accepted answer, existence and stability included.");
  row(ui, "its error", magnitude_text(c.answer.error, numbers), "",
      "The largest of all coordinates, in radians "
      "or relative to the mechanism's reach.");
  row(ui, "Reference", "± " + magnitude_text(c.reference_error, numbers), "",
      "The reference is the direct solution iterated in extended precision; so far its last correction moved "
      "it.");
  if (!c.complete || !c.best) paragraph(c.message, colors.warn);
  if (!c.best) return;
  row(ui, "Motion at its best", duration_text(c.best->motion_s, numbers), "",
      "The run whose end comes nearest to the reference.");
  row(ui, "its error", magnitude_text(c.best->error, numbers), "");
  ImGui::PushFont(ui.fonts.strong);
  const double speed_ratio = c.best->ratio();
  paragraph("The direct solution is as near " +
                std::to_string(std::lround(std::max(speed_ratio, 1 / speed_ratio))) +
                (speed_ratio < 1 ? " times later." : " times sooner."),
            colors.good);
  ImGui::PopFont();
  note_widget(ui.widgets, "compare/ratio");
}

constexpr const char* all_coordinates = "all coordinates";

// Which errors are shown: of the coordinates, or of a measure where there are some.
void shown_choice(Session& session, Ui& ui, const Comparison& c) {
  if (c.measures.empty()) return;
  std::vector<std::string> names{all_coordinates};
  for (const MeasureSolution& measure : c.measures)
    names.push_back(measure.name);
  std::string& shown = session.study.compare.shown;
  if (const auto other =
          name_choice_row(ui, "compare/shown", "Show", names, shown.empty() ? all_coordinates : shown,
                          "The coordinates, of which the largest error counts, or a measure."))
    shown = *other == all_coordinates ? "" : *other;
}

// The measure that is shown; nothing: the coordinates.
std::optional<std::size_t> shown_measure(const Session& session, const Comparison& c) {
  const auto found = std::ranges::find(c.measures, session.study.compare.shown, &MeasureSolution::name);
  if (found == c.measures.end()) return {};
  return static_cast<std::size_t>(found - c.measures.begin());
}

void words(Session& session, Ui& ui) {
  auto& measured = session.study.compare.measured;
  const UiColors& colors = colors_of(ui);
  if (comparing(session)) {
    task_bar(ui, "compare/progress", measured.progress(), measured.seconds());
    if (text_button(ui, "compare/cancel", "Cancel")) measured.stop();
    return;
  }
  ImGui::BeginDisabled(!session.mistakes.empty() || session.mechanism().bodies.empty());
  if (text_button(ui, "compare/run", measured.found ? "Measure again" : "Measure", true))
    begin_comparison(session);
  ImGui::EndDisabled();
  if (!measured.problem.empty()) paragraph(measured.problem, colors.bad);
  if (!measured.found) {
    paragraph(
        "The direct solution, one Newton-Raphson iteration after the other, and the damped motion with every "
        "integrator over tolerances and durations: what error is left after which time.",
        colors.dim);
    return;
  }
  ImGui::SameLine();
  if (text_button(ui, "compare/copy", "Copy the table")) {
    ImGui::SetClipboardText(comparison_csv(measured.found->result).c_str());
    session.notice = "The measurements are on the clipboard, as CSV.";
  }
  if (!comparison_is_current(session)) paragraph("Measured before the last changes.", colors.warn);
  shown_choice(session, ui, measured.found->result);
  found(session, ui, measured.found->result);
}

} // namespace

void compare_panel(Session& session, Ui& ui, CompareView& drawn) {
  const float s = ui.scale;
  ImGui::BeginChild("words", {words_width * s, 0});
  words(session, ui);
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("plot", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (const auto& measured = session.study.compare.measured.found) {
    if (drawn.of != measured || drawn.shown != session.study.compare.shown) {
      drawn.of = measured;
      drawn.shown = session.study.compare.shown;
      replace_plot(drawn.plot,
                   comparison_plot("", measured->result, shown_measure(session, measured->result)));
      fit_plot(drawn.view);
    }
    const ImVec2 room = ImGui::GetContentRegionAvail();
    plot_view(session, ui, "compare", drawn.view, drawn.plot,
              {std::max(room.x, 40.f), std::max(room.y, 40.f)});
  }
  ImGui::EndChild();
}

} // namespace flyball
