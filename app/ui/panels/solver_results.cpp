// How the answer was found: as much of it as a person needs to believe the digits.
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

namespace {

const char* fallback_text(Fallback fallback) {
  switch (fallback) {
  case Fallback::stops: return "start pressed against stops";
  case Fallback::damped: return "damped steps";
  case Fallback::homotopy: return "speeding up from rest";
  case Fallback::descent: return "descent of the potential";
  case Fallback::slow_motion: return "slow motion from the start";
  case Fallback::search: return "search all over the ranges";
  }
  return "";
}

} // namespace

void solver_results(const Session& session, Ui& ui) {
  const Solution& solution = session.answer.solution;
  const NumberStyle& numbers = session.options.numbers;
  if (solution.history.empty() && solution.iterations == 0) return;
  // Beside a periodic motion these would be read as its numbers.
  heading(ui, solution.status == Status::converged ? "How it was found" : "How a steady state was sought");
  const std::string time = duration_text(solution.run_time_s, numbers);
  const auto space = time.find(' ');
  row(ui, "Time", time.substr(0, space), time.c_str() + space + 1,
      solution.status == Status::converged ? "From the start to the accepted answer, its stability included."
                                           : "From the start to the last attempt.");
  note_widget(ui.widgets, "results/time");
  row(ui, "Iterations", std::to_string(solution.iterations), "");
  // Where none was found one that is at rounding would read as if there were one.
  if (constexpr double rounding = 1e-9; solution.status == Status::converged || solution.residual > rounding)
    row(ui, "Scaled residual", magnitude_text(solution.residual, numbers), "",
        "The largest equation of the balance, in units in which its terms are of the order of one.");
  if (solution.condition)
    row(ui, "Condition", short_text(*solution.condition, 2), "",
        "Condition number (2-norm) of the scaled equations.");
  if (solution.fallback)
    row(ui, "Fallback", fallback_text(*solution.fallback), "",
        "The method that led to the answer where plain Newton-Raphson steps did not.");
  if (solution.history.size() > 1) history_plot(session, ui, ImGui::GetContentRegionAvail().x, 84 * ui.scale);
}

} // namespace flyball
