// All equilibria: how they were searched, and a table of them.
#include "app/render/icons.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/stability_words.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>

namespace flyball {

namespace {

constexpr float states_words_width = 292; // points
constexpr float most_title = 170;         // points, of a coordinate's name above its column
constexpr std::size_t most_numbers = 58;  // columns; Dear ImGui takes 64
constexpr ImGuiTableFlags states_table_flags =
    ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerH |
    ImGuiTableFlags_NoSavedSettings | ImGuiTableFlags_SizingFixedFit;

std::string number_of(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

// "4 equilibria", "2 stable, 2 unstable".
void summary(const Session& session, Ui& ui, const std::vector<Solution>& all) {
  const UiColors& colors = colors_of(ui);
  ImGui::PushFont(ui.fonts.strong);
  paragraph(all.empty() ? "No equilibrium was found" : number_of(all.size(), "equilibrium", "equilibria"),
            colors.text);
  ImGui::PopFont();
  note_widget(ui.widgets, "states/count");
  const auto stable = static_cast<std::size_t>(std::ranges::count(all, true, [](const Solution& s) {
    return s.stable == true || s.stability_reason == StabilityReason::neutral;
  }));
  const auto unstable = static_cast<std::size_t>(
      std::ranges::count(all, true, [](const Solution& s) { return s.stable == false; }));
  std::string words;
  const auto add = [&](std::size_t count, const char* word) {
    if (count > 0) words += (words.empty() ? "" : ", ") + std::to_string(count) + " " + word;
  };
  add(stable, "stable");
  add(unstable, "unstable");
  add(all.size() - stable - unstable, "undecided");
  if (!words.empty()) paragraph(words + ". Click one to see it.", colors.dim);
  const auto on_friction = static_cast<std::size_t>(
      std::ranges::count(all, false, [](const Solution& s) { return s.frictions.empty(); }));
  if (on_friction > 0) {
    paragraph(on_friction == 1 ? "One rests on friction."
                               : std::to_string(on_friction) + " rest on friction.",
              colors.dim);
    note_widget(ui.widgets, "states/friction");
  }
  if (states_are_current(session) && converged(session) && !solving(session) && !shown_state(session))
    paragraph("The state that is shown was not found by this search.", colors.warn);
}

// Where it was looked, and from how many starts.
void search_bounds(Session& session, Ui& ui, const StatesStudy::Found& search) {
  const AllSolutions& found = search.result;
  const UiColors& colors = colors_of(ui);
  heading(ui, "How it was searched");
  paragraph(number_of(static_cast<std::size_t>(found.starts), "run", "runs") +
                " of Newton-Raphson, from starts spread over these ranges and deflated at what was found. No "
                "such search is complete.",
            colors.dim);
  note_widget(ui.widgets, "states/search");
  for (const AllSolutions::Bound& b : found.bounds) {
    const ShownUnit unit =
        b.speed ? rate_unit(b.angle, session.units) : coordinate_unit(b.angle, session.units);
    row(ui, b.speed ? speed_words(coordinate_words(b)) : coordinate_words(b),
        short_text(unit.shown(b.lower), 5) + " … " + short_text(unit.shown(b.upper), 5), unit.text.c_str(),
        "Where starts lay. What was found a range's width further out was kept, too.");
    note_widget(ui.widgets, "states/bound/" + coordinate_label(b.joint, b.index, b.count));
  }
  if (session.options.numbers.run_times)
    row(ui, "Run time", duration_text(search.run_time, session.options.numbers), "");
}

void states_words(Session& session, Ui& ui) {
  StatesStudy& states = session.study.states;
  const UiColors& colors = colors_of(ui);
  if (states.running()) {
    task_bar(ui, "states/progress", states.progress(), states.seconds());
    if (text_button(ui, "states/cancel", "Cancel")) states.stop();
  } else {
    const bool refused = !session.mistakes.empty() || session.mechanism().bodies.empty();
    ImGui::BeginDisabled(refused);
    if (text_button(ui, "states/search_again", "Search again", !states_are_current(session)))
      search_states(session);
    ImGui::EndDisabled();
    if (refused) paragraph("There is nothing to solve until what is missing is mended.", colors.warn);
  }
  if (!states.problem.empty()) paragraph(states.problem, colors.bad);
  if (!states.found) return;
  if (!states_are_current(session))
    paragraph("Found before the last changes: search again to choose one.", colors.warn);
  summary(session, ui, states.found->result.equilibria);
  search_bounds(session, ui, *states.found);
}

struct Column {
  std::string title, help;
  float width = 0; // pixels
};

float value_width(const Ui& ui, const std::string& text) {
  const ImFont* font = ui.fonts.digits;
  return font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.c_str()).x;
}

// One equilibrium as it is written into the table.
struct StateLine {
  std::string potential;
  std::vector<std::string> values, details; // of the numbers; details: in SI with the error
};

// What is told of an equilibrium: free coordinates and speeds that are found, then measures.
struct StateNumber {
  std::string name, unit; // SI
  std::optional<double> value;
  double error = 0;
  std::string reason; // where there is no value
};

std::vector<StateNumber> numbers_of(const Solution& solution) {
  std::vector<StateNumber> all;
  for (const CoordinateSolution& c : solution.coordinates)
    if (const auto found = found_number(c))
      all.push_back({found_words(c), std::string(found->unit), found->value, found->error, ""});
  for (const MeasureSolution& m : solution.measures)
    all.push_back({m.name, m.unit, m.value, m.error.value_or(0), m.reason});
  all.resize(std::min(all.size(), most_numbers));
  return all;
}

// Of all states: what stands in one may slip on friction in another.
std::vector<StateNumber> numbers_of(const std::vector<Solution>& all) {
  std::vector<StateNumber> out;
  for (const Solution& solution : all)
    for (const StateNumber& n : numbers_of(solution))
      if (std::ranges::find(out, n.name, &StateNumber::name) == out.end()) out.push_back(n);
  out.resize(std::min(out.size(), most_numbers));
  return out;
}

StateLine line_of(const Solution& solution, const std::vector<StateNumber>& columns,
                  const NumberStyle& numbers, const DisplayUnits& units) {
  StateLine line;
  line.potential = solution.potential ? short_text(*solution.potential, 8) : "–";
  const std::vector<StateNumber> own = numbers_of(solution);
  for (const StateNumber& column : columns) {
    const auto found = std::ranges::find(own, column.name, &StateNumber::name);
    if (found == own.end()) {
      line.values.push_back("–");
      line.details.push_back(column.name + (column.unit.ends_with("/s") ? ": it stands." : ": it goes on."));
      continue;
    }
    const StateNumber& n = *found;
    if (!n.value) {
      line.values.push_back("–");
      line.details.push_back(n.name + ": " + n.reason);
      continue;
    }
    const ShownUnit shown = shown_unit(n.unit, units);
    line.values.push_back(value_text(shown.shown(*n.value), n.error * shown.factor, numbers));
    const std::string unit = n.unit.empty() ? "" : " " + n.unit;
    std::string detail = n.name + ": " + value_text(*n.value, n.error, numbers) + unit;
    if (n.error > 0) detail += " ± " + magnitude_text(std::max(n.error, numbers.noise), numbers) + unit;
    line.details.push_back(std::move(detail));
  }
  return line;
}

// "held", "slips"; empty where the state does not rest on friction.
const char* friction_of(const Solution& solution) {
  if (solution.frictions.empty()) return "";
  return std::ranges::any_of(solution.frictions, &FrictionForce::slips) ? "slips" : "held";
}

void header(Ui& ui, const std::vector<Column>& columns) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!ImGui::TableSetColumnIndex(static_cast<int>(i))) continue;
    // Numbers stand at the right, and so does what they are.
    if (i >= 2)
      ImGui::SetCursorPosX(
          ImGui::GetCursorPosX() +
          std::max(0.f, ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(columns[i].title.c_str()).x));
    ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).dim);
    ImGui::TextUnformatted(columns[i].title.c_str());
    note_widget(ui.widgets, "states/column/" + std::to_string(i), KeyUse::none);
    ImGui::PopStyleColor();
    if (!columns[i].help.empty()) help_on_hover(columns[i].help.c_str());
  }
}

void state_row(Session& session, Ui& ui, std::size_t index, const Solution& solution, const StateLine& line,
               bool shown) {
  const UiColors& colors = colors_of(ui);
  ImGui::TableNextRow();
  if (shown) {
    ImVec4 tint = colors.accent;
    tint.w = 0.16f;
    ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, packed(tint));
  }
  ImGui::TableNextColumn();
  const std::string name = "states/row/" + std::to_string(index + 1);
  ImGui::PushID(static_cast<int>(index));
  const ImVec2 at = ImGui::GetCursorPos();
  if (ImGui::Selectable("##row", false, ImGuiSelectableFlags_SpanAllColumns))
    later(ui, [&session, index] { show_state(session, index); });
  note_widget(ui.widgets, name, KeyUse::row);
  if (shown) mark_chosen(ui.widgets);
  ImGui::PopID();
  ImGui::SetCursorPos(at);
  if (shown) {
    ImGui::TextColored(colors.accent, "%s", icon::eye);
    note_widget(ui.widgets, "states/shown");
  } else {
    ImGui::TextColored(colors.dim, "%s", std::to_string(index + 1).c_str());
  }
  ImGui::TableNextColumn();
  const StabilityWords words = stability_words(solution.stable, solution.stability_reason, colors);
  ImGui::TextColored(words.color, "%s", words.icon);
  ImGui::SameLine(0, 6 * ui.scale);
  ImGui::TextColored(words.color, "%s", words.word);
  help_on_hover(words.sentence);
  if (const char* friction = friction_of(solution); *friction) {
    ImGui::SameLine(0, 6 * ui.scale);
    ImGui::TextColored(colors.dim, "%s", friction);
    note_widget(ui.widgets, name + "/friction");
    help_on_hover(solution.message.c_str());
  }
  if (ImGui::TableNextColumn()) right_digits(ui, line.potential, colors.text);
  for (std::size_t c = 0; c < line.values.size(); ++c) {
    if (!ImGui::TableNextColumn()) continue;
    right_digits(ui, line.values[c], colors.text);
    help_on_hover(line.details[c].c_str());
  }
}

std::vector<Column> columns_of(const Session& session, const Ui& ui, const std::vector<Solution>& all,
                               const std::vector<StateNumber>& numbers, const std::vector<StateLine>& lines) {
  const float s = ui.scale;
  const bool friction = std::ranges::any_of(all, [](const Solution& x) { return !x.frictions.empty(); });
  std::vector<Column> columns{
      {"", "", 24 * s},
      {"Stability", "", (friction ? 150 : 112) * s},
      {"Potential [J]",
       "The amended potential: of weight, springs and constant forces, less the kinetic "
       "energy of the drives' motion. Where it is least a state is stable.",
       0}};
  for (const StateNumber& n : numbers) {
    const std::string unit = shown_unit(n.unit, session.units).text;
    const std::string bracket = unit.empty() ? "" : " [" + unit + "]";
    // A longer name would take its numbers, at the right end of the column, out of sight.
    const std::string name = cut_to(n.name, most_title * s - ImGui::CalcTextSize(bracket.c_str()).x);
    columns.push_back({name + bracket, name == n.name ? "" : n.name, 0});
  }
  for (std::size_t i = 2; i < columns.size(); ++i) {
    float& width = columns[i].width;
    width = ImGui::CalcTextSize(columns[i].title.c_str()).x;
    for (const StateLine& line : lines)
      if (i == 2 || i - 3 < line.values.size())
        width = std::max(width, value_width(ui, i == 2 ? line.potential : line.values[i - 3]));
    width += 14 * s;
  }
  return columns;
}

void states_table(Session& session, Ui& ui) {
  const auto& found = session.study.states.found;
  if (!found || found->result.equilibria.empty()) return;
  const std::vector<Solution>& all = found->result.equilibria;
  std::vector<StateLine> lines;
  lines.reserve(all.size());
  const std::vector<StateNumber> numbers = numbers_of(all);
  for (const Solution& solution : all)
    lines.push_back(line_of(solution, numbers, session.options.numbers, session.units));
  const std::vector<Column> columns = columns_of(session, ui, all, numbers, lines);
  ImGui::PushID(found.get()); // new widths with every list
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {6 * ui.scale, 3 * ui.scale});
  ImGui::PushStyleColor(ImGuiCol_TableHeaderBg, colors_of(ui).panel);
  ImGui::PushStyleColor(ImGuiCol_TableBorderLight, colors_of(ui).border);
  if (ImGui::BeginTable("states", static_cast<int>(columns.size()), states_table_flags,
                        ImGui::GetContentRegionAvail())) {
    ImGui::TableSetupScrollFreeze(2, 1);
    for (const Column& column : columns)
      ImGui::TableSetupColumn(column.title.c_str(), ImGuiTableColumnFlags_WidthFixed, column.width);
    header(ui, columns);
    const std::optional<std::size_t> shown = shown_state(session);
    ImGui::BeginDisabled(!states_are_current(session));
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(all.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const auto index = static_cast<std::size_t>(i);
        state_row(session, ui, index, all[index], lines[index], shown == index);
      }
    ImGui::EndDisabled();
    ImGui::EndTable();
  }
  ImGui::PopStyleColor(2);
  ImGui::PopStyleVar();
  ImGui::PopID();
}

} // namespace

void states_panel(Session& session, Ui& ui) {
  const float s = ui.scale;
  ImGui::BeginChild("words", {states_words_width * s, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 4 * s});
  states_words(session, ui);
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("table", {0, 0}, false,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  states_table(session, ui);
  ImGui::EndChild();
}

} // namespace flyball
