#include "app/render/icons.hpp"
#include "app/session/state_words.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/remedies.hpp"
#include "app/ui/widgets/mistake_list.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace flyball {

namespace {

struct Verdict {
  const char* icon;
  const char* text;
  ImVec4 color;
};

Verdict verdict_of(const PeriodicState& motion, const UiColors& colors) {
  if (motion.stable == true) return {icon::check, "Moves periodically, stable", colors.good};
  if (motion.stable == false) return {icon::warning, "Moves periodically, unstable", colors.bad};
  return {icon::question, "Moves periodically, stability undecided", colors.warn};
}

Verdict verdict_of(const Solution& solution, const UiColors& colors) {
  switch (solution.status) {
  case Status::not_converged: return {icon::warning, "Not converged", colors.bad};
  case Status::no_steady_state: return {icon::close, "No steady state", colors.bad};
  case Status::infeasible: return {icon::close, "The loops cannot be closed", colors.bad};
  case Status::converged: break;
  }
  if (solution.stable == true) return {icon::check, "Stable steady state", colors.good};
  if (solution.stable == false) return {icon::warning, "Unstable steady state", colors.bad};
  if (solution.stability_reason == StabilityReason::neutral)
    return {icon::check, "Steady state, neutral", colors.good};
  if (solution.stability_reason == StabilityReason::gyroscopic_only)
    return {icon::warning, "Steady state, held by spin alone", colors.warn};
  return {icon::question, "Steady state, stability undecided", colors.warn};
}

// "No steady state: the weight turns" below a "No steady state".
std::string without_repetition(const std::string& message, const std::string& headline) {
  if (!message.starts_with(headline + ": ")) return message;
  std::string rest = message.substr(headline.size() + 2);
  if (!rest.empty()) rest[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(rest[0])));
  return rest;
}

void verdict(App& app) {
  const UiColors& colors = colors_of(app);
  const Solution& solution = app.answer.solution;
  const PeriodicState* motion = periodic_motion(app);
  const Verdict verdict = motion ? verdict_of(*motion, colors) : verdict_of(solution, colors);
  const std::string unheld = unheld_words(solution), headline = unheld.empty() ? verdict.text : unheld;
  ImGui::PushFont(app.fonts.strong);
  ImGui::TextColored(verdict.color, "%s", verdict.icon);
  ImGui::SameLine(0, 7 * app.scale);
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(verdict.color, "%s", headline.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  note_widget(app.widgets, "results/verdict");
  if (solution.status == Status::converged && solution.stability_reason)
    paragraph(reason_text(*solution.stability_reason), colors.dim);
  if (const PeriodicState* state = periodic_state(app))
    paragraph(state->message, motion ? colors.dim : colors.text);
  else if (app.study.periodic.search.running())
    paragraph("Looking for a periodic motion…", colors.dim);
  // Where all went well the words above say it already.
  if (solution.status != Status::converged || solution.message != "Converged.")
    paragraph(without_repetition(solution.message, headline),
              solution.status == Status::converged || motion ? colors.dim : colors.text);
}

// Directions that nothing resists.
void neutral_joints(App& app) {
  const std::vector<std::string>& neutral = app.answer.solution.neutral;
  if (neutral.empty()) return;
  row(app, "Nothing resists", name_list(neutral), "",
      "Joints that take part in a direction in which the mechanism stands anywhere.");
}

// Why there is nothing to tell: the first mistake in large, the others below.
void refusal(App& app) {
  const UiColors& colors = colors_of(app);
  constexpr std::size_t most = 12;
  ImGui::PushFont(app.fonts.strong);
  ImGui::TextColored(colors.warn, "%s", icon::warning);
  ImGui::SameLine(0, 7 * app.scale);
  mistake_row(app, "results/mistakes", 0, colors.warn);
  ImGui::PopFont();
  const std::string advice = advice_for(app.mistakes.front());
  paragraph(advice.empty() ? "There is a steady state to look for once this is mended." : advice, colors.dim);
  if (app.mistakes.size() == 1) return;
  heading(app, "And");
  mistake_rows(app, "results/mistakes", 1, most);
}

// Below an inspector its numbers would be read as part of it: a title of their own stays where it is while
// they scroll. Returns what is left for them.
PanelRect below_title(App& app, const PanelRect& rect) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  if (layout_of(app, window.x, window.y).inspector.height <= 0) return rect;
  const UiColors& colors = colors_of(app);
  const float s = app.scale, pad = ImGui::GetStyle().WindowPadding.x;
  PanelRect title = rect, rest = rect;
  title.height = std::min(std::round(ImGui::GetFontSize() + 9 * s), rect.height);
  rest.y += title.height;
  rest.height = std::max(rect.height - title.height, 1.f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("results title", title, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({title.x, title.y}, {title.x + title.width, title.y + title.height},
                     packed(colors.raised));
  list.AddText(app.fonts.strong, app.fonts.strong->FontSize,
               {title.x + pad, std::round(title.y + (title.height - app.fonts.strong->FontSize) / 2)},
               packed(colors.text), "Results");
  app.widgets["results/title"] = {{title.x, title.y}, {title.x + title.width, title.y + title.height}};
  ImGui::End();
  return rest;
}

} // namespace

void results_panel(App& app, const PanelRect& rect) {
  begin_panel("results", below_title(app, rect));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * app.scale, 4 * app.scale});
  if (app.mechanism().bodies.empty()) {
    paragraph("Place a body and join it to the ground: where everything settles is told here, at every step.",
              colors_of(app).dim);
  } else if (!app.mistakes.empty()) {
    refusal(app);
  } else if (app.answer.error) {
    ImGui::TextColored(colors_of(app).bad, "%s  Cannot be solved", icon::warning);
    paragraph(*app.answer.error, colors_of(app).text);
  } else if (app.answer.ticket) {
    verdict(app);
    remedies(app);
    periodic_results(app);
    warning_rows(app, "results/warnings", 3);
    pull_results(app);
    neutral_joints(app);
    coordinate_results(app);
    friction_results(app);
    measure_results(app);
    body_results(app);
    // What runs away leaves a residual that says nothing: it is small because everything else is large.
    if (app.answer.solution.unheld.empty()) solver_results(app);
    load_results(app);
    eigenvalue_results(app);
    system_results(app);
  } else if (solving(app)) {
    paragraph("Solving…", colors_of(app).dim);
  }
  ImGui::PopStyleVar();
  ImGui::End();
}

} // namespace flyball
