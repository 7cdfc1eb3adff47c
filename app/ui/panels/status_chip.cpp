// One line at the foot of the view: solved, solving, or what is missing.
#include "app/render/icons.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/remedies.hpp"
#include "app/ui/widgets/mistake_list.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double patience = 0.15; // s: a shorter wait is not worth a word

struct StatusLine {
  std::string text;
  ImVec4 color;
  const char* icon = "";
};

// Whether dry friction leaves open where the state is.
bool holds_a_band(const Session& session) {
  const FrictionReport* friction = friction_report(session);
  return friction && std::ranges::any_of(friction->band.extents,
                                         [](const BandExtent& extent) { return extent.high > extent.low; });
}

StatusLine motion_line(const PeriodicState& motion, const UiColors& colors) {
  const std::string words = motion.drive_periods == 0 ? "Limit cycle" : "Moves periodically";
  return motion.stable == true    ? StatusLine{words + ", stable", colors.good, icon::check}
         : motion.stable == false ? StatusLine{words + ", unstable", colors.warn, icon::warning}
                                  : StatusLine{words, colors.warn, icon::info};
}

StatusLine status_line(const Session& session, const Ui& ui) {
  const UiColors& colors = colors_of(ui);
  if (session.mechanism().bodies.empty()) return {};
  if (!session.mistakes.empty()) {
    const std::size_t more = session.mistakes.size() - 1;
    return {words_for(session.mistakes.front()) +
                (more > 0 ? "  (and " + std::to_string(more) + " more)" : ""),
            colors.warn, icon::warning};
  }
  if (solving(session) && (session.waited > patience || !session.answer.ticket))
    return {"Solving…", colors.dim, icon::refresh};
  if (session.answer.error) return {words_for(*session.answer.error), colors.bad, icon::warning};
  if (!session.answer.ticket) return {};
  const Solution& solution = session.answer.solution;
  if (const PeriodicState* cycle = cycle_instead(session)) return motion_line(*cycle, colors);
  switch (solution.status) {
  case Status::converged: break;
  case Status::not_converged:
    return {solution.unheld.empty() ? "No steady state found" : unheld_words(solution), colors.bad,
            icon::warning};
  case Status::no_steady_state:
    if (const PeriodicState* motion = periodic_motion(session)) return motion_line(*motion, colors);
    return {session.study.periodic.search.running() ? "No steady state; looking for a periodic motion…"
                                                    : "There is no steady state",
            colors.bad, icon::warning};
  case Status::infeasible: return {"The loops cannot be closed", colors.bad, icon::warning};
  }
  const std::string held = holds_a_band(session) ? "; friction holds it within a band" : "";
  if (solution.stable == true) return {"Steady state, stable" + held, colors.good, icon::check};
  if (solution.stable == false) return {"Steady state, unstable", colors.warn, icon::warning};
  if (solution.stability_reason == StabilityReason::neutral)
    return {"Steady state, neutral", colors.good, icon::check};
  return {"Steady state, " +
              std::string(!solution.stability_reason ? "stability unknown"
                          : *solution.stability_reason == StabilityReason::marginal
                              ? "stability undecided"
                              : word(*solution.stability_reason)) +
              held,
          colors.warn, icon::info};
}

} // namespace

void status_chip(const Session& session, Ui& ui, const PanelRect& view) {
  const StatusLine line = status_line(session, ui);
  if (line.text.empty()) return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, pad = 8 * s, room = std::max(view.width - 100 * s, 60 * s);
  const float icon_width = ImGui::CalcTextSize(line.icon).x + 6 * s;
  const ImVec2 size = ImGui::CalcTextSize(line.text.c_str(), nullptr, false, room - icon_width - 2 * pad);
  const ImVec2 to(view.x + view.width - 10 * s, view.y + view.height - 10 * s);
  const ImVec2 from(to.x - size.x - icon_width - 2 * pad, to.y - size.y - pad);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, to, packed(colors.panel), 5 * s);
  list.AddRect(from, to, packed(colors.border), 5 * s, 0, std::max(1.f, std::round(s)));
  list.AddText({from.x + pad, from.y + pad / 2}, packed(line.color), line.icon);
  list.AddText(ui.fonts.text, ImGui::GetFontSize(), {from.x + pad + icon_width, from.y + pad / 2},
               packed(colors.text), line.text.c_str(), nullptr, room - icon_width - 2 * pad);
  ui.widgets["status"] = {from, to};
}

} // namespace flyball
