// Error against run time: the direct solution and the motion, measured on the scene as it is now.
#include "app/plot/comparison_plot.hpp"
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace flyball {

namespace {

constexpr float words_width = 292; // points

// The measure that is shown; nothing: the coordinates.
std::optional<std::size_t> shown_measure(const Session& session, const Comparison& c) {
  const auto found = std::ranges::find(c.measures, session.study.compare.shown, &MeasureSolution::name);
  if (found == c.measures.end()) return {};
  return static_cast<std::size_t>(found - c.measures.begin());
}

// The error of a mark, of the coordinates or of a measure; not a number where it has none.
template <typename Mark>
double compared_error(const Mark& mark, const std::optional<std::size_t>& measure) {
  if (!measure) return mark.error;
  return *measure < mark.measure_errors.size() ? mark.measure_errors[*measure]
                                               : std::numeric_limits<double>::quiet_NaN();
}

// The run that ends nearest.
struct NearestRun {
  const MotionCurve* of = nullptr;
  const MotionMark* run = nullptr;
};
NearestRun nearest_run(const Comparison& c, const std::optional<std::size_t>& measure) {
  NearestRun nearest;
  for (const MotionCurve& curve : c.motion)
    for (const MotionMark& mark : curve.points) {
      const double error = compared_error(mark, measure);
      if (std::isfinite(error) && (!nearest.run || error < compared_error(*nearest.run, measure)))
        nearest = {&curve, &mark};
    }
  return nearest;
}

// Two digits: run times are worth no more.
std::string times_text(double ratio) {
  if (ratio < 10) return short_text(ratio, 2);
  const double unit = std::pow(10, std::max(0., std::floor(std::log10(ratio)) - 1));
  return std::to_string(std::llround(std::round(ratio / unit) * unit));
}

void found(const Session& session, Ui& ui, const Comparison& c) {
  const UiColors& colors = colors_of(ui);
  const NumberStyle& numbers = session.options.numbers;
  if (c.status != Status::converged) return paragraph(c.message, colors.bad);
  const std::optional<std::size_t> measure = shown_measure(session, c);
  const std::string unit = measure ? written_unit(c.measures[*measure].unit) : "";
  if (c.best) {
    const double ratio = c.best->ratio();
    ImGui::PushFont(ui.fonts.strong);
    paragraph("The direct solution is as near about " + times_text(std::max(ratio, 1 / ratio)) +
                  (ratio < 1 ? " times later than the motion." : " times sooner than the motion."),
              colors.good);
    ImGui::PopFont();
    note_widget(ui.widgets, "compare/ratio");
    help_on_hover("When the motion that comes nearest is there, and when the direct solution was as near. Of "
                  "the coordinates.");
  }
  if (!c.complete || !c.best) paragraph(c.message, colors.warn);
  heading(ui, "Direct solution");
  row(ui, "Run time", duration_text(c.answer.run_time_s, numbers), "",
      "From the drawn pose to the accepted answer, existence and stability included; the median of repeats, "
      "without reading and compiling the scene.");
  const double error = compared_error(c.answer, measure);
  row(ui, "Error", std::isfinite(error) ? magnitude_text(error, numbers) : "-", unit.c_str(),
      "Against the same solution iterated in extended precision.");
  if (!measure)
    row(ui, "Reference", "± " + magnitude_text(c.reference_error, numbers), "",
        "So far the last correction moved that.");
  if (const NearestRun nearest = nearest_run(c, measure); nearest.run) {
    heading(ui, "Motion that comes nearest");
    row(ui, "Run time", duration_text(nearest.run->run_time_s, numbers), "",
        "Of the run whose end comes nearest to the reference.");
    row(ui, "Error", magnitude_text(compared_error(*nearest.run, measure), numbers), unit.c_str());
    row(ui, "Simulated", short_text(nearest.of->duration, 3), "s", "Of the mechanism's time.");
    row(ui, "Tolerance", short_text(nearest.run->tolerance, 1), "", "Of the error of a step.");
  }
  ImGui::Dummy({0, 2 * ui.scale});
  paragraph(std::string(measure ? ""
                                : "Errors are the largest of all coordinates: angles in rad, lengths as "
                                  "parts of the mechanism's size. ") +
                "Each dot is a run; a line joins those of one integrator that none beats in both time and "
                "error. Point at a dot to read it.",
            colors.dim);
  note_widget(ui.widgets, "compare/words");
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

void time_field(Session& session, Ui& ui) {
  const char* help =
      "How long it measures at most. Then it keeps what it has; a single run is given up after "
      "a tenth of it. It does not limit the solution before, which may take long for large mechanisms: a "
      "change of the mechanism ends that. Cancel and closing the studies end either.";
  const float width = row_label(ui, "Time limit", help);
  quantity_field(session, ui,
                 {.name = "compare/time_limit",
                  .value = session.study.compare.time_limit,
                  .unit = "s",
                  .help = help,
                  .least = Least::above_zero,
                  .set = [&session](double typed) { session.study.compare.time_limit = typed; },
                  .at_once = true},
                 width);
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
  if (measured.found) {
    ImGui::SameLine();
    if (text_button(ui, "compare/copy", "Copy the table")) {
      ImGui::SetClipboardText(comparison_csv(measured.found->result).c_str());
      session.notice = "The measurements are on the clipboard, as CSV.";
    }
  }
  time_field(session, ui);
  if (!measured.problem.empty()) paragraph(measured.problem, colors.bad);
  if (!measured.found) {
    paragraph(
        "The direct solution, one Newton-Raphson iteration after the other, and the damped motion with every "
        "integrator over tolerances and durations: what error is left after which time. Some hundred runs, "
        "each repeated.",
        colors.dim);
    return;
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
