// The map of two parameters: what is wanted of it, and the plot.
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/studies/map/map_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/stability_words.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace flyball {

namespace {

constexpr float map_choices_width = 320; // points
constexpr int fewest_cells = 2, most_cells = 401;

// Two fields side by side after one label.
void two_fields(Session& session, Ui& ui, const std::string& label, const char* help, QuantityField first,
                QuantityField second) {
  const float gap = 6 * ui.scale;
  const float width = std::floor((row_label(ui, label, help) - gap) / 2);
  quantity_field(session, ui, first, width);
  ImGui::SameLine(0, gap);
  quantity_field(session, ui, second, width);
}

void axis_choice(Session& session, Ui& ui, MapView& drawn, std::size_t which) {
  MapState& map = session.study.map;
  const MapAxis& axis = map.choice.axes[which];
  const std::string name = which == 0 ? "map/x" : "map/y";
  const auto addresses = [&] {
    std::vector<std::string> all = map_addresses(session);
    std::erase(all, map.choice.axes[1 - which].address);
    return all;
  };
  if (const auto chosen =
          number_choice_row(session.mechanism(), ui, name, which == 0 ? "Across" : "Up", addresses,
                            number_phrase(session.mechanism(), axis.address), "The number along this axis."))
    later(ui, [&session, &drawn, which, address = *chosen] {
      session.study.map.choice.axes[which] = map_axis(session, address);
      fit_plot(drawn.view);
    });
  if (!has_number(session.mechanism(), axis.address)) return; // gone in this frame, by an undo
  const auto end = [&](const char* key, double value, bool upper) {
    return QuantityField{.name = name + "/" + key,
                         .value = value,
                         .unit = parameter_unit(session.mechanism(), axis.address),
                         .help = upper ? "Where the axis ends." : "Where the axis begins.",
                         .set = [&session, &drawn, which, upper](double typed) {
                           MapAxis& changed = session.study.map.choice.axes[which];
                           (upper ? changed.to : changed.from) = typed;
                           if (changed.from > changed.to) std::swap(changed.from, changed.to);
                           if (changed.from == changed.to) changed.to = changed.from + 1;
                           fit_plot(drawn.view);
                         }};
  };
  two_fields(session, ui,
             range_label(session, ui, "from, to", parameter_unit(session.mechanism(), axis.address),
                         {axis.from, axis.to}),
             "The range of this axis.", end("from", axis.from, false), end("to", axis.to, true));
}

void point_counts(Session& session, Ui& ui) {
  const auto field = [&](const char* name, std::size_t which) {
    return QuantityField{.name = name,
                         .value = static_cast<double>(session.study.map.choice.axes[which].count),
                         .unit = "",
                         .help = "Values along the axis, 2 to 401. Each place is a solve of its own.",
                         .least = Least::above_zero,
                         .set = [&session, which](double typed) {
                           session.study.map.choice.axes[which].count = static_cast<int>(
                               std::clamp(std::round(typed), double{fewest_cells}, double{most_cells}));
                         }};
  };
  two_fields(session, ui, "Points", "How many values across, and up.", field("map/x/count", 0),
             field("map/y/count", 1));
}

void quantity_choice(Session& session, Ui& ui) {
  MapChoice& choice = session.study.map.choice;
  const std::vector<MapQuantity> all = map_quantities(session);
  std::vector<std::string> titles;
  for (const MapQuantity& quantity : all)
    titles.push_back(quantity.title);
  const std::optional<MapQuantity> shown = map_quantity(session);
  if (const auto chosen =
          name_choice_row(ui, "map/shown", "Colour", titles, shown ? shown->title : choice.shown,
                          "The coordinate or measure that the colours tell.")) {
    choice.shown = std::ranges::find(all, *chosen, &MapQuantity::title)->name;
    choice.level.reset();
  }
}

void curve_choices(Session& session, Ui& ui) {
  MapChoice& choice = session.study.map.choice;
  if (check_row(ui, "map/folds", "Folds and crossings", choice.folds,
                "The curves on which equilibria meet and vanish, or branches cross."))
    choice.folds = !choice.folds;
  if (check_row(ui, "map/hunting", "Boundary of hunting", choice.hunting,
                "The curves on which a steady state begins to hunt: a damped pair of eigenvalues crosses the "
                "imaginary axis (Hopf).\nSoft (supercritical): beyond it the swings grow from nothing. Hard "
                "(subcritical): they are large at once, and before it a push can start them.\nDampers can be "
                "varied, too."))
    choice.hunting = !choice.hunting;
  if (choice.hunting && has_friction(session.mechanism())) {
    paragraph(friction_left_out, colors_of(ui).warn);
    note_widget(ui.widgets, "map/friction");
  }
  const std::optional<MapQuantity> shown = map_quantity(session);
  if (shown && !shown->followed) return; // what follows from the others cannot be asked for
  if (check_row(ui, "map/level", "Curve of a constant value", choice.level.has_value(),
                "The curve on which it keeps a value.")) {
    if (choice.level)
      choice.level.reset();
    else
      choice.level = shown ? shown->value.value_or(0) : 0;
  }
  if (!choice.level || !shown) return;
  double value = *choice.level;
  if (plain_quantity_field(session, ui, "map/level/value", "Value", shown->unit.c_str(),
                           "What it is on the curve.", value))
    choice.level = value;
}

void map_words(Session& session, Ui& ui) {
  MapState& map = session.study.map;
  const UiColors& colors = colors_of(ui);
  if (computing_map(session)) return; // it has the bar above
  const auto& curves = map.curves.found;
  if (curves && map.choice.folds && curves->result.folds && curves->result.folds->curves.empty())
    paragraph(curves->result.folds->message, colors.dim);
  if (curves && map.choice.hunting && curves->result.hunting && curves->result.hunting->curves.empty())
    paragraph(curves->result.hunting->message, colors.dim);
  if (!map.cells.found) return;
  const MapCells& cells = map.cells.found->result;
  std::size_t unsolved = 0, unstable = 0;
  for (const MapCell& cell : cells) {
    unsolved += std::isfinite(cell.value) ? 0 : 1;
    unstable += cell.stable == false ? 1 : 0;
  }
  std::string text;
  if (unsolved > 0) text += std::to_string(unsolved) + " without a steady state (left free). ";
  if (unstable > 0) text += std::to_string(unstable) + " unstable (hatched). ";
  paragraph(text + "Each starts from the drawn pose. Click a place, or drag the mark, to go there.",
            colors.dim);
  note_widget(ui.widgets, "map/words");
}

// How far it is, or that it is of another mechanism by now, on top, where it is in sight whatever the panel's
// height; nothing moves as it comes and goes.
void map_progress_line(Session& session, Ui& ui) {
  const float below = ImGui::GetCursorPosY() + ImGui::GetFrameHeightWithSpacing();
  const bool again = session.study.map.stale || !map_problem(session).empty();
  if (computing_map(session)) {
    if (text_button(ui, "map/cancel", "Cancel")) cancel_map(session);
    ImGui::SameLine();
    task_bar(ui, "map/progress", map_progress(session), map_seconds(session),
             std::max(ImGui::GetContentRegionAvail().x - margin_width(ui), 20 * ui.scale));
  } else if (again) {
    if (text_button(ui, "map/again", "Compute again", true)) compute_map(session);
    if (session.study.map.stale) {
      ImGui::SameLine();
      ImGui::AlignTextToFramePadding();
      ImGui::TextColored(colors_of(ui).warn, "Out of date");
      note_widget(ui.widgets, "map/stale", KeyUse::none);
    }
  } else if (const auto& cells = session.study.map.cells.found) {
    std::string text = std::to_string(cells->result.size()) + " solves";
    if (session.options.numbers.run_times)
      text += " in " + duration_text(cells->run_time, session.options.numbers);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text.c_str());
  }
  ImGui::SetCursorPosY(below);
}

void map_choices(Session& session, Ui& ui, MapView& drawn) {
  ImGui::BeginChild("choices", {map_choices_width * ui.scale, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * ui.scale, 3 * ui.scale});
  const std::string problem = map_problem(session);
  if (!session.mistakes.empty())
    paragraph("There is nothing to solve until what is missing is mended.", colors_of(ui).warn);
  if (!session.study.map.choice.shown.empty() && session.mistakes.empty()) {
    map_progress_line(session, ui);
    if (!problem.empty()) paragraph(problem, colors_of(ui).bad);
    axis_choice(session, ui, drawn, 0);
    axis_choice(session, ui, drawn, 1);
    point_counts(session, ui);
    quantity_choice(session, ui);
    curve_choices(session, ui);
  } else if (!problem.empty()) {
    paragraph(problem, colors_of(ui).bad);
  }
  map_words(session, ui);
  ImGui::PopStyleVar();
  ImGui::EndChild();
}

} // namespace

void map_panel(Session& session, Ui& ui, MapView& drawn) {
  const float s = ui.scale;
  MapState& map = session.study.map;
  map_choices(session, ui, drawn);
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("plot", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (map.cells.found) {
    draw_map(session, drawn);
    const PlotEvents events = plot_view(
        session, ui, "map", drawn.view, drawn.plot,
        {std::max(ImGui::GetContentRegionAvail().x, 40.f), std::max(ImGui::GetContentRegionAvail().y, 40.f)});
    // What is shown may be of other numbers than are chosen by now.
    const std::array<MapAxis, 2>& axes = map.cells.found->of.choice.axes;
    const bool same =
        axes[0].address == map.choice.axes[0].address && axes[1].address == map.choice.axes[1].address;
    if (const auto place = events.dragged_at ? events.dragged_at : events.clicked_at; place && same)
      later(ui, [&session,
                 place = std::array{(*place)[0] / drawn.plot.x.factor, (*place)[1] / drawn.plot.y.factor}] {
        go_to_place(session, place);
      });
  }
  ImGui::EndChild();
}

} // namespace flyball
