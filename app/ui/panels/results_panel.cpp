#include "app/ui/panels/results_panel.hpp"

#include "app/render/icons.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/session/session.hpp"
#include "app/session/state_words.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/widgets/mistake_list.hpp"
#include "app/ui/widgets/task_bar.hpp"
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
  const bool own = motion.drive_periods == 0; // its period
  if (motion.stable == true)
    return {icon::check, own ? "Limit cycle, stable" : "Moves periodically, stable", colors.good};
  if (motion.stable == false)
    return {icon::warning, own ? "Limit cycle, unstable" : "Moves periodically, unstable", colors.bad};
  return {icon::question,
          own ? "Limit cycle, stability undecided" : "Moves periodically, stability undecided", colors.warn};
}

Verdict verdict_of(const Solution& solution, const UiColors& colors) {
  switch (solution.status) {
  case Status::not_converged: return {icon::warning, "No steady state found", colors.bad};
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

void verdict(const Session& session, Ui& ui) {
  const UiColors& colors = colors_of(ui);
  const Solution& solution = session.answer.solution;
  const PeriodicState *motion = periodic_motion(session), *cycle = cycle_instead(session);
  const Verdict verdict = motion  ? verdict_of(*motion, colors)
                          : cycle ? verdict_of(*cycle, colors)
                                  : verdict_of(solution, colors);
  const std::string unheld = cycle ? "" : unheld_words(solution),
                    headline = unheld.empty() ? verdict.text : unheld;
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextColored(verdict.color, "%s", verdict.icon);
  ImGui::SameLine(0, 7 * ui.scale);
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(verdict.color, "%s", headline.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  note_widget(ui.widgets, "results/verdict");
  // Why nothing stands is no news where the motion is found.
  if (motion || cycle) help_on_hover(without_repetition(window_message(solution), headline).c_str());
  if (cycle) return; // told below, with what asks for it
  std::string growth = solution.status == Status::converged ? growth_words(solution) : std::string();
  if (growth.empty() && solution.status == Status::converged) growth = undamped_words(solution);
  if (solution.status == Status::converged && solution.stability_reason)
    paragraph(growth.empty() ? reason_text(*solution.stability_reason) : growth, colors.dim);
  if (const PeriodicState* state = periodic_state(session))
    paragraph(state->message, motion ? colors.dim : colors.text);
  else if (const auto& search = session.study.periodic.search; search.running()) {
    paragraph("Looking for a periodic motion…", colors.dim);
    task_bar(ui, "results/periodic/running", search.progress(), search.seconds());
  }
  // Where all went well the words above say it already.
  const bool said = solution.message == "Converged." ||
                    (!growth.empty() && solution.message == "Converged. This state is unstable.");
  if (!motion && (solution.status != Status::converged || !said))
    paragraph(without_repetition(window_message(solution), headline),
              solution.status == Status::converged ? colors.dim : colors.text);
}

// Directions that nothing resists: in the lines below where the names find no room beside the words.
void neutral_joints(const Session& session, Ui& ui) {
  std::vector<std::string> neutral = session.answer.solution.neutral;
  if (neutral.empty()) return;
  std::ranges::transform(neutral, neutral.begin(), joint_words);
  constexpr const char *label = "Nothing resists",
                       *help = "Joints that take part in a direction in which the mechanism stands anywhere.";
  const std::string names = name_list(neutral);
  const ImFont* digits = ui.fonts.digits;
  const float wide =
      ImGui::CalcTextSize(label).x + digits->CalcTextSizeA(digits->FontSize, 1e9f, 0, names.c_str()).x;
  if (wide + 10 * ui.scale <= ImGui::GetContentRegionAvail().x) {
    row(ui, label, names, "", help);
  } else {
    ImGui::BeginGroup();
    paragraph(label, colors_of(ui).dim);
    paragraph(names, colors_of(ui).text);
    ImGui::EndGroup();
    offer_copy(names);
    help_on_hover(help);
  }
  note_widget(ui.widgets, "results/neutral", KeyUse::none);
}

// Why there is nothing to tell: the first mistake in large, the others below.
void refusal(Session& session, Ui& ui) {
  const UiColors& colors = colors_of(ui);
  constexpr std::size_t most = 12;
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextColored(colors.warn, "%s", icon::warning);
  ImGui::SameLine(0, 7 * ui.scale);
  mistake_row(session, ui, "results/mistakes", 0, colors.warn);
  ImGui::PopFont();
  const std::string advice = advice_for(session.mistakes.front());
  paragraph(advice.empty() ? "There is a steady state to look for once this is mended." : advice, colors.dim);
  if (session.mistakes.size() == 1) return;
  heading(ui, "And");
  mistake_rows(session, ui, "results/mistakes", 1, most);
}

// Below an inspector its numbers would be read as part of it: a title of their own stays where it is while
// they scroll. Returns what is left for them.
PanelRect below_title(Ui& ui, const PanelRect& rect) {
  const UiColors& colors = colors_of(ui);
  const float pad = ImGui::GetStyle().WindowPadding.x;
  PanelRect title = rect, rest = rect;
  title.height = std::min(results_title_height(ui), rect.height);
  rest.y += title.height;
  rest.height = std::max(rect.height - title.height, 1.f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("results title", title, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({title.x, title.y}, {title.x + title.width, title.y + title.height},
                     packed(colors.raised));
  list.AddText(ui.fonts.strong, ui.fonts.strong->FontSize,
               {title.x + pad, std::round(title.y + (title.height - ui.fonts.strong->FontSize) / 2)},
               packed(colors.text), "Results");
  ui.widgets["results/title"] = {{title.x, title.y}, {title.x + title.width, title.y + title.height}};
  ImGui::End();
  return rest;
}

void result_contents(Session& session, Ui& ui, ResultSections& open, InBearings& in_bearings,
                     const ToolState& tool) {
  if (session.mechanism().bodies.empty()) {
    paragraph("Place a body and join it to the ground: where everything settles is told here, at every step.",
              colors_of(ui).dim);
  } else if (!session.mistakes.empty()) {
    refusal(session, ui);
  } else if (session.answer.error) {
    ImGui::TextColored(colors_of(ui).bad, "%s  Cannot be solved", icon::warning);
    paragraph(words_for(*session.answer.error), colors_of(ui).text);
  } else if (session.answer.ticket) {
    verdict(session, ui);
    remedies(session, ui, in_bearings);
    periodic_results(session, ui, open);
    cycle_offer(session, ui);
    warning_rows(session, ui, "results/warnings", 3);
    pull_results(session, ui, tool);
    neutral_joints(session, ui);
    coordinate_results(session, ui, open);
    friction_results(session, ui);
    measure_results(session, ui);
    cycle_results(session, ui, open);
    body_results(session, ui);
    // What runs away leaves a residual that says nothing: it is small because everything else is large.
    if (session.answer.solution.unheld.empty()) solver_results(session, ui);
    load_results(session, ui, open);
    eigenvalue_results(session, ui, open);
    system_results(session, ui, open);
  } else if (solving(session)) {
    paragraph("Solving…", colors_of(ui).dim);
  }
}

} // namespace

void ResultsPanel::draw(Session& session, Ui& ui, const ToolState& tool, const PanelRect& rect,
                        bool below_inspector) {
  begin_panel("results", below_inspector ? below_title(ui, rect) : rect);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * ui.scale, 4 * ui.scale});
  result_contents(session, ui, open_, in_bearings_, tool);
  ImGui::PopStyleVar();
  ImGui::End();
}

} // namespace flyball
