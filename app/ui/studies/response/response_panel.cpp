// The response curve's choices, design mode, and the plot.
#include "app/session/coordinate_words.hpp"
#include "app/session/resonance.hpp"
#include "app/session/response_design.hpp"
#include "app/session/response_pull.hpp"
#include "app/session/units.hpp"
#include "app/session/variable_numbers.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/studies/response/resonance_plot.hpp"
#include "app/ui/studies/response/response_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace flyball {

namespace {

constexpr float response_choices_width = 300; // points
constexpr double curve_patience = 0.25;       // s: a shorter wait is not worth a bar

void parameter_choice(Session& session, Ui& ui) {
  if (const auto other = number_choice_row(
          session.mechanism(), ui, "response/parameter", "Vary",
          [&] { return variable_numbers(session, Dampers::with); },
          number_phrase(session.mechanism(), session.study.response.choice.address),
          "The number along the plot: of a slider, or any other."))
    choose_response(session, *other);
}

// One end of the range.
void range_field(Session& session, Ui& ui, const char* name, const char* help, double ResponseChoice::*end,
                 float width) {
  const std::optional<ParameterControl> control = response_control(session);
  ResponseState& state = session.study.response;
  const QuantityField field{
      .name = name,
      .value = state.choice.*end,
      .unit = control ? control->unit : "",
      .help = help,
      .set = [&session, end](double typed) { choose_response_end(session, end, typed); },
      .at_once = true};
  quantity_field(session, ui, field, width);
}

void range_row(Session& session, Ui& ui) {
  const std::optional<ParameterControl> control = response_control(session);
  const float width =
      row_label(ui,
                range_label(session, ui, "Range", control ? control->unit : "",
                            {session.study.response.choice.from, session.study.response.choice.to}),
                "Where the curve begins and where it ends.");
  const float gap = 6 * ui.scale, each = std::floor((width - gap) / 2);
  range_field(session, ui, "response/from",
              is_resonance(session)
                  ? "The curve begins here."
                  : "The curve begins here, with the steady state nearest to the drawn pose.",
              &ResponseChoice::from, each);
  ImGui::SameLine(0, gap);
  range_field(session, ui, "response/to", "The curve goes as far as this.", &ResponseChoice::to, each);
}

void shown_quantity_choice(Session& session, Ui& ui) {
  const ResponseState& state = session.study.response;
  ImGui::SetNextItemWidth(row_label(ui, "Show", "What is drawn over it."));
  ImGui::PushStyleColor(ImGuiCol_Button, colors_of(ui).raised);
  const bool open =
      ImGui::BeginCombo("##response/quantity", state.shown.title.c_str(), ImGuiComboFlags_HeightLarge);
  ImGui::PopStyleColor();
  if (!open) {
    note_widget(ui.widgets, "response/quantity");
    return;
  }
  std::string group;
  for (const ResponseQuantity& each : offered_quantities(session)) {
    if (each.group != group) {
      ImGui::PushFont(ui.fonts.strong);
      ImGui::TextDisabled("%s", (group = each.group).c_str());
      ImGui::PopFont();
    }
    ImGui::PushID(each.key.c_str());
    ImGui::Indent(10 * ui.scale);
    if (ImGui::Selectable(each.title.c_str(), each.key == state.choice.quantity))
      choose_quantity(session, each);
    note_widget(ui.widgets, "response/quantity/" + each.key);
    ImGui::Unindent(10 * ui.scale);
    ImGui::PopID();
    if (each.key == state.choice.quantity) mark_chosen(ui.widgets);
  }
  ImGui::EndCombo();
}

// Where along the curve something is missing, and why.
template <class Gap>
void gap_lines(Ui& ui, const ShownUnit& unit, const std::vector<Gap>& gaps, const std::string& widget,
               const ImVec4& color) {
  constexpr std::size_t most_gaps = 4;
  const std::string after = unit.text.empty() ? "" : " " + unit.text;
  for (std::size_t i = 0; i < gaps.size() && i < most_gaps; ++i) {
    const std::string from = short_text(unit.shown(gaps[i].from), 5),
                      to = short_text(unit.shown(gaps[i].to), 5);
    paragraph((from == to ? "At " + from : "From " + from + " to " + to) + after + ": " + gaps[i].why, color);
    note_widget(ui.widgets, widget + std::to_string(i + 1));
  }
  if (gaps.size() > most_gaps)
    paragraph("And " + std::to_string(gaps.size() - most_gaps) + " more gaps.", colors_of(ui).dim);
}

// Of periodic motions: "65 points", and where there are none.
void found_motions(Session& session, Ui& ui) {
  const auto& found = session.study.response.resonance.found;
  if (!found) return;
  const NumberStyle& numbers = session.options.numbers;
  paragraph(resonance_words(session) +
                (numbers.run_times ? ", " + duration_text(found->run_time, numbers) : std::string()),
            colors_of(ui).dim);
  note_widget(ui.widgets, "response/found");
  help_on_hover(
      "The balance turns with the drives: of the motion that comes back after each period the line is the "
      "mean, the band reaches from least to most. Dashed where Floquet's multipliers say that it is left.\n"
      "Points lie closer where the curve bends; a peak narrower than the first of them are apart, a 32nd of "
      "the range, may lie between two: a shorter range shows it.");
  const ShownUnit unit = shown_unit(parameter_unit(*found->of.mechanism, found->of.address), session.units);
  gap_lines(ui, unit, resonance_gaps(found->result), "response/gap/", colors_of(ui).warn);
}

// "3 branches, 277 points", and what they are bounded by.
void found(Session& session, Ui& ui) {
  const ResponseState& state = session.study.response;
  const UiColors& colors = colors_of(ui);
  if (const std::string refusal = response_refusal(session); !refusal.empty()) {
    paragraph(refusal, colors.bad);
    note_widget(ui.widgets, "response/problem");
    return;
  }
  if (is_resonance(session)) return found_motions(session, ui);
  if (!state.curve.found) return;
  const ResponseResult& result = state.curve.found->result;
  std::size_t points = 0, apart = 0;
  for (const ResponseLine& line : result.lines) {
    points += line.points.size();
    if (!line.connected) ++apart;
  }
  const std::size_t branches = result.lines.size();
  std::string text = std::to_string(branches) + (branches == 1 ? " branch, " : " branches, ");
  if (apart > 0) text += std::to_string(apart) + " apart, ";
  text += std::to_string(points) + " points";
  std::string help = result.diagram.message;
  for (std::size_t i = 0; i < branches && i < 8; ++i) {
    const ResponseBranch& b = result.diagram.branches[i];
    help += "\nBranch " + std::to_string(i + 1) + " ends: " + b.end + ".";
  }
  const NumberStyle& numbers = session.options.numbers;
  if (numbers.run_times) text += ", " + duration_text(result.diagram.run_time_s, numbers);
  paragraph(text, colors.dim);
  note_widget(ui.widgets, "response/found");
  help_on_hover(help.c_str());
}

void band_choice(Session& session, Ui& ui) {
  BandState& band = session.study.band;
  const std::string refusal = band_refusal(session);
  if (check_row(ui, "response/band", "Band of the tolerances", band.wanted,
                "How far the steady states along the curve scatter with the tolerances that Spread has: the "
                "middle 90 % of samples.",
                refusal.empty() || band.wanted ? nullptr : refusal.c_str()))
    band.wanted = !band.wanted;
  if (!band.wanted) return;
  if (!band.computed.problem.empty())
    paragraph(band.computed.problem, colors_of(ui).bad);
  else if (const std::string words = refusal.empty() ? band_words(session) : refusal; !words.empty())
    paragraph(words, colors_of(ui).dim);
  note_widget(ui.widgets, "response/band/words");
}

void ribbon_choice(Session& session, Ui& ui) {
  if (!has_friction(session.mechanism())) return;
  bool& wanted = session.study.friction.ribbon_wanted;
  if (check_row(ui, "response/ribbon", "Band of friction", wanted,
                "Where friction lets it stand: along the lower edge as it rises, along the upper as it "
                "falls. Where "
                "no edge is drawn it runs away over it."))
    wanted = !wanted;
  if (!wanted) return;
  const auto& ribbon = session.study.friction.ribbon;
  if (!ribbon.problem.empty()) return paragraph(ribbon.problem, colors_of(ui).bad);
  if (const auto shown = shown_ribbon(session)) {
    const ResponseRequest& of = shown->of.curve->of;
    const ShownUnit unit = shown_unit(parameter_unit(*of.mechanism, of.address), session.units);
    gap_lines(ui, unit, ribbon_gaps(session), "response/ribbon/gap/", colors_of(ui).dim);
  }
}

// Of the fields above and below, which leave a margin.
float column_width(const Ui& ui) {
  return ImGui::GetContentRegionAvail().x - margin_width(ui);
}

// A bar for what takes long; false where there is none.
bool progress(Session& session, Ui& ui, ResponseView& drawn) {
  ResponseState& state = session.study.response;
  ResponseCurve& curve = state.curve;
  auto& design = state.design.answer;
  auto& band = session.study.band.computed;
  ResonanceStudy& resonance = state.resonance;
  double& waiting_since = drawn.waiting_since;
  if (!curve.running() && !design.running() && !band.running() && !resonance.running()) {
    waiting_since = -1;
    return false;
  }
  if (waiting_since < 0) waiting_since = ImGui::GetTime();
  if (ImGui::GetTime() - waiting_since < curve_patience) return false;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float button = ImGui::CalcTextSize("Cancel").x + 2 * style.FramePadding.x + style.ItemSpacing.x;
  const float room = std::max(column_width(ui) - button, 20 * ui.scale);
  const auto bar = [&](const auto& study) {
    task_bar(ui, "response/progress", study.progress(), study.seconds(), room);
  };
  if (curve.running())
    bar(curve);
  else if (resonance.running())
    bar(resonance);
  else if (design.running())
    bar(design);
  else
    bar(band);
  ImGui::SameLine();
  if (text_button(ui, "response/cancel", "Cancel")) {
    curve.stop();
    resonance.stop();
    design.stop();
    band.stop();
  }
  return true;
}

// How far the search is, and else what was found: in one place, so that nothing below moves as they change.
void search_line(Session& session, Ui& ui, ResponseView& drawn) {
  const float below = ImGui::GetCursorPosY() + ImGui::GetFrameHeightWithSpacing();
  if (!progress(session, ui, drawn)) found(session, ui);
  if (ImGui::GetCursorPosY() < below) ImGui::SetCursorPosY(below);
}

// Where the present state is not in the plot.
void range_note(const Session& session, Ui& ui) {
  const std::optional<ParameterControl> control = response_control(session);
  const ResponseChoice& choice = session.study.response.choice;
  if (!control || (control->value - choice.from) * (control->value - choice.to) <= 0) return;
  const ShownUnit unit = shown_unit(control->unit, session.units);
  paragraph("It is " + short_text(unit.shown(control->value)) + (unit.text.empty() ? "" : " " + unit.text) +
                " now, outside this range.",
            colors_of(ui).warn);
  note_widget(ui.widgets, "response/outside");
}

void branch_note(const Session& session, Ui& ui) {
  if (!session.on_branch) return;
  paragraph("Sliders follow the branch you chose.", colors_of(ui).dim);
  note_widget(ui.widgets, "response/on_branch");
  help_on_hover("\"Restart from drawn pose\" leaves it, and so does undoing.");
}

void choose_design(Session& session, const DesignGoal& goal) {
  ResponseDesign& design = session.study.response.design;
  design.coordinate = goal.key;
  design.answer.found.reset();
  const ShownUnit unit = shown_unit(goal.unit, session.units);
  const double shown = unit.shown(goal.value.value_or(0));
  if (!goal.place) { // three digits
    design.value = unit.si(std::strtod(rounded_text(shown, 3).c_str(), nullptr));
    return;
  }
  // The nearest whole degree, millimetre or hundredth of a radian.
  const double digits = unit.text == "rad" ? 100 : unit.text == "m" ? 1000 : 1;
  design.value = unit.si(std::round(shown * digits) / digits);
}

// One number with all poses that have it, as mirrored ones do: the first is what the present one is like.
struct SharedNumber {
  const DesignSolution* first = nullptr;
  int poses = 1;
};

std::vector<SharedNumber> shared_numbers(const DesignAnswer& answer) {
  constexpr double same = 1e-9; // of the number
  std::vector<SharedNumber> numbers;
  for (const DesignSolution& s : answer.solutions) {
    const auto known = std::ranges::find_if(numbers, [&](const SharedNumber& each) {
      return each.first->at.stable == s.at.stable &&
             std::abs(each.first->parameter - s.parameter) <=
                 same * std::abs(s.parameter) + each.first->parameter_error + s.parameter_error;
    });
    if (known != numbers.end())
      ++known->poses;
    else
      numbers.push_back({&s});
  }
  return numbers;
}

void solution_row(Session& session, Ui& ui, const DesignRequest& of, const SharedNumber& shared,
                  std::size_t i, const std::string& si_unit) {
  const DesignSolution& s = *shared.first;
  const UiColors& colors = colors_of(ui);
  const NumberStyle& numbers = session.options.numbers;
  const ShownUnit parameter = shown_unit(si_unit, session.units);
  const std::string& unit = parameter.text;
  const std::string name = "response/solution/" + std::to_string(i + 1);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(column_width(ui), 1.f), height = ImGui::GetFrameHeight();
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {width, height});
  note_widget(ui.widgets, name, KeyUse::row);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s1 = ui.scale, y = from.y + (height - ImGui::GetFontSize()) / 2;
  list.AddRectFilled(from, {from.x + width, from.y + height},
                     packed(ImGui::IsItemHovered() ? colors.border : colors.raised),
                     ImGui::GetStyle().FrameRounding);
  // As there is no error beside it, down to the last place that is true.
  const double error = 10 * std::max(s.parameter_error, numbers.noise) * parameter.factor;
  const std::string value = value_text(parameter.shown(s.parameter), error, numbers);
  float x = from.x + 8 * s1;
  list.PushClipRect(from, {from.x + width, from.y + height}, true);
  list.AddText(ui.fonts.digits, ui.fonts.digits->FontSize, {x, y + digits_drop(ui)}, packed(colors.text),
               value.c_str());
  x += ui.fonts.digits->CalcTextSizeA(ui.fonts.digits->FontSize, 1e9f, 0, value.c_str()).x + 5 * s1;
  list.AddText({x, y}, packed(colors.dim), unit.c_str());
  const char* kind = !s.at.stable ? "undecided" : *s.at.stable ? "stable" : "unstable";
  const ImVec4& color = !s.at.stable ? colors.dim : *s.at.stable ? colors.good : colors.warn;
  const std::string words =
      shared.poses == 1 ? kind : std::string(kind) + " in " + std::to_string(shared.poses) + " poses";
  list.AddText({from.x + width - 8 * s1 - ImGui::CalcTextSize(words.c_str()).x, y}, packed(color),
               words.c_str());
  list.PopClipRect();
  std::string help =
      shared.poses == 1 ? "Click to go there."
                        : "So many poses of the mechanism, mirrored ones for instance, are as wanted at this "
                          "number: a click goes to the one that is nearest to the present one.";
  help += "\nError estimate " + magnitude_text(s.parameter_error * parameter.factor, numbers) + " " + unit +
          ", " + std::to_string(s.iterations) + " iterations.";
  if (s.rate) {
    const ShownUnit coordinate = shown_unit(of.goal.unit, session.units);
    help += "\n" + of.goal.title + " changes by " +
            short_text(*s.rate * coordinate.factor / parameter.factor, 4) + " " + coordinate.text + " per " +
            (unit.empty() ? "unit." : unit + ".");
  }
  constexpr std::size_t most_told = 8;
  for (std::size_t k = 0; k < s.at.coordinates.size() && k < most_told; ++k) {
    const CoordinateSolution& c = s.at.coordinates[k];
    if (c.driven) continue;
    const ShownUnit coordinate = coordinate_unit(c.angle, session.units);
    help +=
        "\n" + coordinate_words(c) + "  " + short_text(coordinate.shown(c.value), 6) + " " + coordinate.text;
  }
  help_on_hover(help.c_str());
  if (clicked) later(ui, [&session, solution = s] { go_to_design(session, solution); });
}

// Into sight where it lies below, once for each answer.
void reveal_answer(const void* answer, ResponseView& drawn) {
  if (std::exchange(drawn.answer_seen, answer) == answer || !answer) return;
  if (ImGui::GetCursorPosY() - ImGui::GetScrollY() > ImGui::GetWindowHeight()) ImGui::SetScrollHereY(1);
}

void design_answer(Session& session, Ui& ui) {
  const ResponseDesign& design = session.study.response.design;
  const UiColors& colors = colors_of(ui);
  if (!design.answer.problem.empty()) return paragraph(design.answer.problem, colors.bad);
  if (!design.answer.found) return;
  const DesignAnswer& answer = design.answer.found->result;
  if (answer.solutions.empty()) {
    paragraph(design_words(session), colors.warn);
    note_widget(ui.widgets, "response/never");
    return;
  }
  const std::optional<ParameterControl> control = response_control(session);
  const std::vector<SharedNumber> numbers = shared_numbers(answer);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    solution_row(session, ui, design.answer.found->of, numbers[i], i, control ? control->unit : "");
  if (design.answer.running()) { // what hangs together with the drawn pose is found first
    ImGui::TextDisabled("Looking for other poses");
    note_widget(ui.widgets, "response/looking");
    return;
  }
  if (!session.options.numbers.run_times) return;
  row(ui, "Run time", duration_text(answer.run_time_s, session.options.numbers), "",
      design_words(session).c_str(), margin_width(ui));
  note_widget(ui.widgets, "response/run time");
}

// What is chosen as long as nobody has: what is shown, or else the last coordinate.
const DesignGoal& first_goal(const Session& session, const std::vector<DesignGoal>& goals) {
  const auto shown = std::ranges::find(goals, session.study.response.choice.quantity, &DesignGoal::quantity);
  if (shown != goals.end()) return *shown;
  const auto last = std::find_if(goals.rbegin(), goals.rend(),
                                 [](const DesignGoal& goal) { return goal.quantity.starts_with("value "); });
  return last == goals.rend() ? goals.front() : *last;
}

void design_rows(Session& session, Ui& ui, ResponseView& drawn) {
  const std::optional<ParameterControl> control = response_control(session);
  const std::vector<DesignGoal>& goals = design_goals(session).goals;
  if (!control || goals.empty()) return;
  ResponseDesign& design = session.study.response.design;
  auto chosen = std::ranges::find(goals, design.coordinate, &DesignGoal::key);
  if (chosen == goals.end() && converged(session)) {
    choose_design(session, first_goal(session, goals));
    chosen = std::ranges::find(goals, design.coordinate, &DesignGoal::key);
  }
  heading(ui, ("Find the " + number_phrase(session.mechanism(), control->address)).c_str());
  help_on_hover("Solves for the number so that a coordinate, a speed that is found, a measure, a force or a "
                "torque has the value that is asked for.");
  if (const auto other = name_choice_row(ui, "response/design", "so that", design_goals(session).titles,
                                         chosen == goals.end() ? design.coordinate : chosen->title,
                                         "The coordinate, speed, measure, force or torque that is wanted "
                                         "somewhere.")) {
    chosen = std::ranges::find(goals, *other, &DesignGoal::title);
    choose_design(session, *chosen);
  }
  const float width = row_label(ui, "is", "Where it is wanted.");
  const float button = 62 * ui.scale, gap = 6 * ui.scale;
  quantity_field(session, ui,
                 {.name = "response/value",
                  .value = design.value,
                  .unit = chosen == goals.end() ? "" : chosen->unit,
                  .help = "Where it is wanted.",
                  .set =
                      [&session](double typed) {
                        session.study.response.design.value = typed;
                        find_design(session);
                      },
                  .at_once = true},
                 width + margin_width(ui) - button - gap);
  ImGui::SameLine(0, gap);
  ImGui::BeginDisabled(session.mistakes.size() > 0);
  if (text_button(ui, "response/find", "Find", true)) find_design(session);
  ImGui::EndDisabled();
  design_answer(session, ui);
  reveal_answer(design.answer.found.get(), drawn);
}

void response_choices(Session& session, Ui& ui, ResponseView& drawn) {
  if (session.mechanism().bodies.empty()) {
    paragraph("There is nothing to vary.", colors_of(ui).dim);
    return;
  }
  parameter_choice(session, ui);
  range_row(session, ui);
  range_note(session, ui);
  shown_quantity_choice(session, ui);
  if (is_resonance(session)) {
    progress(session, ui, drawn);
    if (resonance_stopped(session)) {
      if (text_button(ui, "response/go_on", "Go on")) go_on_with_resonance(session);
      help_on_hover("Finds the motions that are missing; those that are there stay.");
    }
    return found(session, ui);
  }
  if (check_row(
          ui, "response/all", "Disconnected branches, too", session.study.response.choice.all,
          "Also looks for branches that nothing connects with the drawn pose's: a bounded search at both "
          "ends and at the present value, which takes longer."))
    session.study.response.choice.all = !session.study.response.choice.all;
  band_choice(session, ui);
  ribbon_choice(session, ui);
  search_line(session, ui, drawn);
  branch_note(session, ui);
  design_rows(session, ui, drawn);
}

} // namespace

void response_panel(Session& session, Ui& ui, ResponseView& drawn) {
  const float s = ui.scale;
  ImGui::BeginChild("choices", {response_choices_width * s, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  response_choices(session, ui, drawn);
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("plot", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const bool resonance = is_resonance(session);
  const bool found = resonance ? session.study.response.resonance.found != nullptr
                               : session.study.response.curve.found != nullptr;
  if (found && response_refusal(session).empty()) {
    if (resonance)
      draw_resonance(session, drawn);
    else
      draw_response(session, drawn);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const PlotEvents events = plot_view(session, ui, "response", drawn.view, drawn.plot,
                                        {std::max(room.x, 40.f), std::max(room.y, 40.f)});
    const bool dragged = events.dragged_to.has_value();
    if (const auto hit = dragged ? events.dragged_to : events.clicked)
      later(ui, [&session, &drawn, hit = *hit, dragged, resonance] {
        if (resonance)
          go_to_resonance(session, drawn, hit);
        else
          go_to_hit(session, drawn, hit, dragged);
      });
    if (const auto& to = events.pulled_to)
      later(ui, [&session, x = to->x ? std::optional(*to->x / drawn.plot.x.factor) : std::nullopt,
                 y = to->y / drawn.plot.y.factor] { pull_response(session, x, y); });
  } else if (!session.mistakes.empty()) {
    paragraph("The mechanism is not finished; see the line below the view.", colors_of(ui).dim);
  }
  ImGui::EndChild();
}

} // namespace flyball
