// The response curve's choices, design mode, and the plot.
#include "app/session/response_pull.hpp"
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/studies/response/response_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace flyball {

namespace {

constexpr float response_choices_width = 300; // points
constexpr double curve_patience = 0.25;       // s: a shorter wait is not worth a bar

void parameter_choice(App& app) {
  std::vector<std::string> phrases;
  phrases.reserve(app.parameters.size());
  std::string chosen;
  for (const ParameterControl& control : app.parameters) {
    phrases.push_back(parameter_phrase(control.address));
    if (control.address == app.study.response.choice.address) chosen = phrases.back();
  }
  const auto other = name_choice_row(app, "response/parameter", "Vary", phrases, chosen,
                                     "The number along the plot: one of the sliders, or pin another.");
  if (!other) return;
  const auto i = static_cast<std::size_t>(std::ranges::find(phrases, *other) - phrases.begin());
  choose_response(app, app.parameters[i].address);
}

// One end of the range.
void range_field(App& app, const char* name, const char* help, double ResponseChoice::*end, float width) {
  const ParameterControl* control = response_control(app);
  ResponseState& state = app.study.response;
  const QuantityField field{.name = name,
                            .value = state.choice.*end,
                            .unit = control ? control->unit : "",
                            .help = help,
                            .set = [&app, end](double typed) { choose_response_end(app, end, typed); },
                            .at_once = true};
  quantity_field(app, field, width);
}

void range_row(App& app) {
  const float width = row_label(app, "Range", "Where the curve begins and where it ends.");
  const float gap = 6 * app.scale, each = std::floor((width - gap) / 2);
  range_field(app, "response/from", "The curve begins here, with the equilibrium nearest to the drawn pose.",
              &ResponseChoice::from, each);
  ImGui::SameLine(0, gap);
  range_field(app, "response/to", "The curve is followed as far as this.", &ResponseChoice::to, each);
}

void quantity_choice(App& app) {
  const ResponseState& state = app.study.response;
  ImGui::SetNextItemWidth(row_label(app, "Show", "What is drawn over it."));
  ImGui::PushStyleColor(ImGuiCol_Button, colors_of(app).raised);
  const bool open =
      ImGui::BeginCombo("##response/quantity", state.shown.title.c_str(), ImGuiComboFlags_HeightLarge);
  ImGui::PopStyleColor();
  if (!open) {
    note_widget(app.widgets, "response/quantity");
    return;
  }
  std::string group;
  for (const ResponseQuantity& each : offered_quantities(app)) {
    if (each.group != group) ImGui::TextDisabled("%s", (group = each.group).c_str());
    ImGui::PushID(each.key.c_str());
    if (ImGui::Selectable(each.title.c_str(), each.key == state.choice.quantity)) choose_quantity(app, each);
    ImGui::PopID();
    note_widget(app.widgets, "response/quantity/" + each.key);
    if (each.key == state.choice.quantity) mark_chosen(app.widgets);
  }
  ImGui::EndCombo();
}

// "3 branches, 277 points", and what they are bounded by.
void found(App& app) {
  const ResponseState& state = app.study.response;
  const UiColors& colors = colors_of(app);
  if (const std::string refusal = response_refusal(app); !refusal.empty()) {
    paragraph(refusal, colors.bad);
    note_widget(app.widgets, "response/problem");
    return;
  }
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
  const NumberStyle& numbers = app.options.numbers;
  row(app, text, numbers.run_times ? duration_text(result.diagram.run_time_s, numbers) : "", "",
      help.c_str());
  note_widget(app.widgets, "response/found");
}

void band_choice(App& app) {
  BandState& band = app.study.band;
  const std::string refusal = band_refusal(app);
  if (check_row(app, "response/band", "Band of the tolerances", band.wanted,
                "How far the steady states along the curve scatter with the tolerances that Spread has: the "
                "middle 90 % of samples.",
                refusal.empty() || band.wanted ? nullptr : refusal.c_str()))
    band.wanted = !band.wanted;
  if (!band.wanted) return;
  if (!band.computed.problem.empty())
    paragraph(band.computed.problem, colors_of(app).bad);
  else if (const std::string words = refusal.empty() ? band_words(app) : refusal; !words.empty())
    paragraph(words, colors_of(app).dim);
  note_widget(app.widgets, "response/band/words");
}

void ribbon_choice(App& app) {
  if (!has_friction(app.mechanism())) return;
  bool& wanted = app.study.friction.ribbon_wanted;
  if (check_row(
          app, "response/ribbon", "Band of friction", wanted,
          "Where friction lets it stand: along the lower edge as it rises, along the upper as it falls."))
    wanted = !wanted;
  if (const std::string& problem = app.study.friction.ribbon.problem; wanted && !problem.empty())
    paragraph(problem, colors_of(app).bad);
}

// A bar for what takes long.
void progress(App& app) {
  ResponseState& state = app.study.response;
  ResponseCurve& curve = state.curve;
  auto& design = state.design.answer;
  auto& band = app.study.band.computed;
  double& waiting_since = app.plots.response.waiting_since;
  if (!curve.running() && !design.running() && !band.running()) {
    waiting_since = -1;
    return;
  }
  if (waiting_since < 0) waiting_since = ImGui::GetTime();
  if (ImGui::GetTime() - waiting_since < curve_patience) return;
  const float room = ImGui::GetContentRegionAvail().x - 70 * app.scale;
  const auto bar = [&](const auto& study) {
    task_bar(app, "response/progress", study.progress(), study.seconds(), room);
  };
  if (curve.running())
    bar(curve);
  else if (design.running())
    bar(design);
  else
    bar(band);
  ImGui::SameLine();
  if (text_button(app, "response/cancel", "Cancel")) {
    curve.stop();
    design.stop();
    band.stop();
  }
}

void branch_note(App& app) {
  if (!app.on_branch) return;
  paragraph("Sliders follow the branch you chose.", colors_of(app).dim);
  note_widget(app.widgets, "response/on_branch");
  help_on_hover("\"Restart from drawn pose\" leaves it, and so does undoing.");
}

// The coordinate of the answer that design mode asks for.
const CoordinateSolution* design_coordinate(const App& app) {
  for (const CoordinateSolution& c : app.answer.summary.coordinates)
    if (!c.driven && !c.dependent && coordinate_label(c) == app.study.response.design.coordinate) return &c;
  return nullptr;
}

// The unit of what design mode asks for: of a coordinate, else of a measure.
std::string design_unit(const App& app) {
  if (const CoordinateSolution* c = design_coordinate(app)) return c->angle ? "rad" : "m";
  const int i = measure_index(app.mechanism(), app.study.response.design.coordinate);
  return i < 0 ? "m" : app.mechanism().measures[static_cast<std::size_t>(i)].unit;
}

double present_value(const App& app, const std::string& name) {
  for (const CoordinateSolution& c : app.answer.solution.coordinates)
    if (coordinate_label(c) == name) return c.value;
  for (const MeasureSolution& m : app.answer.solution.measures)
    if (m.name == name) return m.value.value_or(0);
  return 0;
}

void choose_design(App& app, const std::string& name) {
  ResponseDesign& design = app.study.response.design;
  design.coordinate = name;
  design.answer.found.reset();
  const ShownUnit unit = shown_unit(design_unit(app), app.units);
  const double shown = unit.shown(present_value(app, name));
  if (!design_coordinate(app)) { // three digits
    design.value = unit.si(std::strtod(rounded_text(shown, 3).c_str(), nullptr));
    return;
  }
  // The nearest whole degree, millimetre or hundredth of a radian.
  const double digits = unit.text == "rad" ? 100 : unit.text == "m" ? 1000 : 1;
  design.value = unit.si(std::round(shown * digits) / digits);
}

void solution_row(App& app, const DesignAnswer& answer, const DesignSolution& s, std::size_t i,
                  const std::string& si_unit) {
  const UiColors& colors = colors_of(app);
  const NumberStyle& numbers = app.options.numbers;
  const ShownUnit parameter = shown_unit(si_unit, app.units);
  const std::string& unit = parameter.text;
  const std::string name = "response/solution/" + std::to_string(i + 1);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFrameHeight();
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {std::max(width, 1.f), height});
  note_widget(app.widgets, name, KeyUse::row);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s1 = app.scale, y = from.y + (height - ImGui::GetFontSize()) / 2;
  list.AddRectFilled(from, {from.x + width, from.y + height},
                     packed(ImGui::IsItemHovered() ? colors.border : colors.raised),
                     ImGui::GetStyle().FrameRounding);
  const std::string value = value_text(
      parameter.shown(s.parameter), std::max(s.parameter_error, numbers.noise) * parameter.factor, numbers);
  float x = from.x + 8 * s1;
  list.PushClipRect(from, {from.x + width, from.y + height}, true);
  list.AddText(app.fonts.digits, app.fonts.digits->FontSize, {x, y + digits_drop(app)}, packed(colors.text),
               value.c_str());
  x += app.fonts.digits->CalcTextSizeA(app.fonts.digits->FontSize, 1e9f, 0, value.c_str()).x + 5 * s1;
  list.AddText({x, y}, packed(colors.dim), unit.c_str());
  const char* kind = !s.at.stable ? "undecided" : *s.at.stable ? "stable" : "unstable";
  const ImVec4& color = !s.at.stable ? colors.dim : *s.at.stable ? colors.good : colors.warn;
  list.AddText({from.x + width - 8 * s1 - ImGui::CalcTextSize(kind).x, y}, packed(color), kind);
  list.PopClipRect();
  std::string help = "Click to go there.\nError estimate " +
                     magnitude_text(s.parameter_error * parameter.factor, numbers) + " " + unit + ", " +
                     std::to_string(s.iterations) + " iterations.";
  if (s.rate) {
    const ShownUnit coordinate = shown_unit(answer.unit, app.units);
    help += "\n" + answer.wanted + " changes by " +
            short_text(*s.rate * coordinate.factor / parameter.factor, 4) + " " + coordinate.text + " per " +
            (unit.empty() ? "unit." : unit + ".");
  }
  constexpr std::size_t most_told = 8;
  for (std::size_t k = 0; k < s.at.coordinates.size() && k < most_told; ++k) {
    const CoordinateSolution& c = s.at.coordinates[k];
    if (c.driven) continue;
    const ShownUnit coordinate = coordinate_unit(c.angle, app.units);
    help +=
        "\n" + coordinate_label(c) + "  " + short_text(coordinate.shown(c.value), 6) + " " + coordinate.text;
  }
  help_on_hover(help.c_str());
  if (clicked) later(app, [&app, solution = s] { go_to_design(app, solution); });
}

void design_answer(App& app) {
  const ResponseDesign& design = app.study.response.design;
  const UiColors& colors = colors_of(app);
  if (!design.answer.problem.empty()) return paragraph(design.answer.problem, colors.bad);
  if (!design.answer.found) return;
  const DesignAnswer& answer = design.answer.found->result;
  if (answer.solutions.empty()) {
    paragraph(answer.message, colors.warn);
    note_widget(app.widgets, "response/never");
    return;
  }
  const ParameterControl* control = response_control(app);
  for (std::size_t i = 0; i < answer.solutions.size(); ++i)
    solution_row(app, answer, answer.solutions[i], i, control ? control->unit : "");
  if (app.options.numbers.run_times)
    row(app, "Run time", duration_text(answer.run_time_s, app.options.numbers), "", answer.message.c_str());
}

void design_rows(App& app) {
  const ParameterControl* control = response_control(app);
  if (!control) return;
  std::vector<std::string> names;
  for (const CoordinateSolution& c : app.answer.summary.coordinates)
    if (!c.driven && !c.dependent) names.push_back(coordinate_label(c));
  const std::string first = names.empty() ? "" : names.back();
  for (const NamedMeasure& measure : app.mechanism().measures)
    names.push_back(measure.name);
  if (names.empty()) return;
  ResponseDesign& design = app.study.response.design;
  if (std::ranges::find(names, design.coordinate) == names.end()) {
    const std::string& quantity = app.study.response.choice.quantity;
    const auto shown = std::ranges::find_if(
        names, [&](const std::string& n) { return quantity == "value " + n || quantity == "measure " + n; });
    choose_design(app, shown == names.end() ? (first.empty() ? names.front() : first) : *shown);
  }
  heading(app, ("Find the " + parameter_phrase(control->address)).c_str());
  help_on_hover("Solves for the number so that a coordinate or measure has the value that is asked for.");
  if (const auto chosen = name_choice_row(app, "response/design", "so that", names, design.coordinate,
                                          "The coordinate or measure that is wanted somewhere."))
    choose_design(app, *chosen);
  const float width = row_label(app, "is", "Where it is wanted.");
  const float button = 62 * app.scale, gap = 6 * app.scale;
  quantity_field(app,
                 {.name = "response/value",
                  .value = design.value,
                  .unit = design_unit(app),
                  .help = "Where it is wanted.",
                  .set =
                      [&app](double typed) {
                        app.study.response.design.value = typed;
                        find_design(app);
                      },
                  .at_once = true},
                 width + margin_width(app) - button - gap);
  ImGui::SameLine(0, gap);
  ImGui::BeginDisabled(app.mistakes.size() > 0);
  if (text_button(app, "response/find", "Find", true)) find_design(app);
  ImGui::EndDisabled();
  design_answer(app);
}

void response_choices(App& app) {
  if (app.parameters.empty()) {
    paragraph("There is nothing to vary: no drive, no spring, no pinned number.", colors_of(app).dim);
    return;
  }
  parameter_choice(app);
  range_row(app);
  quantity_choice(app);
  if (check_row(
          app, "response/all", "Disconnected branches, too", app.study.response.choice.all,
          "Also looks for branches that nothing connects with the drawn pose's: a bounded search at both "
          "ends and at the present value, which takes longer."))
    app.study.response.choice.all = !app.study.response.choice.all;
  band_choice(app);
  ribbon_choice(app);
  progress(app);
  found(app);
  branch_note(app);
  design_rows(app);
}

} // namespace

void response_panel(App& app) {
  const float s = app.scale;
  ImGui::BeginChild("choices", {response_choices_width * s, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  response_choices(app);
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("plot", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ResponseView& drawn = app.plots.response;
  if (app.study.response.curve.found && response_refusal(app).empty()) {
    draw_response(app);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const PlotEvents events =
        plot_view(app, "response", drawn.view, drawn.plot, {std::max(room.x, 40.f), std::max(room.y, 40.f)});
    const bool dragged = events.dragged_to.has_value();
    if (const auto hit = dragged ? events.dragged_to : events.clicked)
      later(app, [&app, hit = *hit, dragged] { go_to_hit(app, hit, dragged); });
    if (const auto& to = events.pulled_to)
      later(app, [&app, x = to->x ? std::optional(*to->x / drawn.plot.x.factor) : std::nullopt,
                  y = to->y / drawn.plot.y.factor] { pull_response(app, x, y); });
  } else if (!app.mistakes.empty()) {
    paragraph("The mechanism is not finished; see the line below the view.", colors_of(app).dim);
  }
  ImGui::EndChild();
}

} // namespace flyball
