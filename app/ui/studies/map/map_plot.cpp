#include "app/ui/studies/map/map_plot.hpp"

#include "app/plot/hunting_plot.hpp"
#include "app/session/number_text.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

constexpr double no_value_here = std::numeric_limits<double>::quiet_NaN();

std::vector<double> values_of(const MapAxis& axis) {
  std::vector<double> values;
  for (int i = 0; i < axis.count; ++i)
    values.push_back(axis.count < 2 ? axis.from : axis.from + (axis.to - axis.from) * i / (axis.count - 1));
  return values;
}

// Which unstable cells are hatched: those on every so many diagonals, so that fine cells do not become one
// colour, and those that no such line crosses in their row or column.
std::vector<bool> hatched_cells(const MapCells& cells, std::size_t across, std::size_t up) {
  constexpr double most = 16; // slanting lines one above the other
  const auto every = static_cast<std::size_t>(std::max(1., std::round(static_cast<double>(up) / most)));
  const auto unstable = [&](std::size_t i, std::size_t j) {
    return i < across && j < up && cells[j * across + i].stable == false;
  };
  const auto on_line = [&](std::size_t i, std::size_t j) { return (i + up * every - j) % every == 0; };
  // Indices below zero wrap around to large ones, which no cell has.
  const auto crossed = [&](std::size_t i, std::size_t j) {
    for (const std::array<std::size_t, 2> way : {std::array<std::size_t, 2>{1, 0}, {0, 1}})
      for (const bool back : {false, true})
        for (std::size_t k = 0; k < every; ++k) {
          const std::size_t x = back ? i - k * way[0] : i + k * way[0],
                            y = back ? j - k * way[1] : j + k * way[1];
          if (!unstable(x, y)) break;
          if (on_line(x, y)) return true;
        }
    return false;
  };
  std::vector<bool> hatched(cells.size());
  for (std::size_t j = 0; j < up; ++j)
    for (std::size_t i = 0; i < across; ++i)
      hatched[j * across + i] = unstable(i, j) && (on_line(i, j) || !crossed(i, j));
  return hatched;
}

// A slanting line through each of them; those of neighbours meet.
PlotCurve hatching(const MapCells& cells, const std::vector<double>& x, const std::vector<double>& y) {
  PlotCurve hatch{
      .name = "unstable", .points = {}, .color = plot_color::vermillion, .width = 1, .hatching = true};
  if (x.size() < 2 || y.size() < 2) return hatch;
  const std::vector<bool> hatched = hatched_cells(cells, x.size(), y.size());
  const double half_x = (x[1] - x[0]) / 2, half_y = (y[1] - y[0]) / 2;
  for (std::size_t j = 0; j < y.size(); ++j)
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!hatched[j * x.size() + i]) continue;
      hatch.points.push_back({x[i] - half_x, y[j] - half_y});
      hatch.points.push_back({x[i] + half_x, y[j] + half_y});
      hatch.points.push_back({no_value_here, no_value_here});
    }
  return hatch;
}

// As the map's own mechanism has it: the number may be gone since, by an undo.
std::string axis_unit(const MapState& map, const MapAxis& axis) {
  return parameter_unit(*map.cells.found->of.mechanism, axis.address);
}

void add_curves(Plot& plot, const PlaneCurves& curves, const std::string& level) {
  for (const PlaneCurve& curve : curves.curves) {
    PlotCurve line;
    switch (curve.type) {
    case PlaneCurveType::fold:
      line.name = "folds";
      line.color = plot_color::vermillion;
      break;
    case PlaneCurveType::branch_point:
      line.name = "crossings";
      line.color = plot_color::purple;
      break;
    case PlaneCurveType::value:
      line.name = level;
      line.color = plot_color::orange;
      break;
    case PlaneCurveType::hopf: continue; // see add_hunting_curves
    }
    line.width = 2.2;
    PlotCurve unstable = line;
    unstable.line = PlotLine::dashed;
    // The two kinds of pieces meet.
    const std::array<double, 2>* before = nullptr;
    bool before_unstable = false;
    std::array<double, 2> last{};
    for (const PlanePoint& p : curve.points) {
      const bool dashed = curve.type == PlaneCurveType::value && p.stable == false;
      PlotCurve& mine = dashed ? unstable : line;
      if (before && dashed != before_unstable) {
        mine.points.push_back({no_value_here, no_value_here});
        mine.points.push_back(*before);
      }
      mine.points.push_back({p.x, p.y});
      last = {p.x, p.y};
      before = &last;
      before_unstable = dashed;
    }
    if (!line.points.empty()) plot.curves.push_back(std::move(line));
    if (!unstable.points.empty()) plot.curves.push_back(std::move(unstable));
    for (const PlanePoint& cusp : curve.cusps)
      plot.marks.push_back({.at = {cusp.x, cusp.y}, .label = "cusp", .shape = PlotShape::diamond});
  }
}

} // namespace

void draw_map(const Session& session, MapView& drawn) {
  const MapState& map = session.study.map;

  if (!map.cells.found) return;
  const MapView::Of of{map.cells.found, map.curves.found, session.units};
  const bool made = drawn.of == of;
  if (made && drawn.marked == session.answer.ticket) return;
  const MapChoice& choice = map.cells.found->of.choice;
  const MapCells& cells = map.cells.found->result;
  const std::array<MapAxis, 2>& axes = choice.axes;
  drawn.of = of;
  drawn.marked = session.answer.ticket;
  drawn.plot.marker.reset();
  if (converged(session) && !solving(session)) {
    const double x = get_parameter(session.mechanism(), axes[0].address);
    const double y = get_parameter(session.mechanism(), axes[1].address);
    if (x >= axes[0].from && x <= axes[0].to && y >= axes[1].from && y <= axes[1].to)
      drawn.plot.marker = PlotMarker{x, y, ""};
  }
  const auto show_marker = [&] {
    if (!drawn.plot.marker) return;
    drawn.plot.marker->x *= drawn.plot.x.factor;
    drawn.plot.marker->y *= drawn.plot.y.factor;
  };
  if (made) return show_marker();
  Plot plot;
  const auto axis_for = [&](const MapAxis& axis) {
    return PlotAxis{.label = number_phrase(session.mechanism(), axis.address),
                    .unit = axis_unit(map, axis),
                    .range = PlotRange{axis.from, axis.to},
                    .room = 0};
  };
  plot.x = axis_for(axes[0]);
  plot.y = axis_for(axes[1]);
  const std::optional<MapQuantity> shown = map_quantity(session);
  const std::string si = shown ? shown->unit : "", title = shown ? shown->title : choice.shown;
  const ShownUnit unit = shown_unit(si, session.units);
  PlotHeat heat{.x = values_of(axes[0]), .y = values_of(axes[1]), .values = {}, .label = title, .unit = si};
  heat.values.reserve(cells.size());
  heat.notes_label = "stability";
  for (const MapCell& cell : cells) {
    heat.values.push_back(cell.value);
    heat.notes.emplace_back(!cell.stable ? "" : *cell.stable ? "stable" : "unstable");
  }
  if (PlotCurve hatch = hatching(cells, heat.x, heat.y); !hatch.points.empty())
    plot.curves.push_back(std::move(hatch));
  show_heat(heat, si, session.units);
  plot.heat = std::move(heat);
  const auto& curves = map.curves.found;
  if (curves && curves->result.folds) add_curves(plot, *curves->result.folds, "");
  if (curves && curves->result.hunting) add_hunting_curves(plot, *curves->result.hunting);
  if (curves && curves->result.level && map.choice.level)
    add_curves(plot, *curves->result.level,
               title + " = " + short_text(unit.shown(*map.choice.level), 5) + " " + unit.text);
  show_axis(plot, 0, axis_unit(map, axes[0]), session.units);
  show_axis(plot, 1, axis_unit(map, axes[1]), session.units);
  plot.marker = drawn.plot.marker;
  replace_plot(drawn.plot, std::move(plot));
  show_marker();
}

} // namespace flyball
