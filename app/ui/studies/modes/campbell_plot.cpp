#include "app/ui/studies/modes/campbell_plot.hpp"

#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// Eigenvalues less than this are zero (1/s).
double rounding(const std::vector<std::vector<std::complex<double>>>& lines) {
  double largest = 0;
  for (const auto& point : lines)
    for (const std::complex<double>& s : point)
      if (std::isfinite(s.imag())) largest = std::max(largest, std::abs(s));
  return 1e-6 * largest;
}

struct Segment {
  std::vector<std::array<double, 2>> stable, unstable;
};

void add(Segment& segment, bool stable, const std::array<double, 2>& at) {
  auto& mine = stable ? segment.stable : segment.unstable;
  auto& other = stable ? segment.unstable : segment.stable;
  // The two kinds meet.
  if (!other.empty() && std::isfinite(other.back()[1])) {
    mine.push_back({no_value, no_value});
    mine.push_back(other.back());
    other.push_back({no_value, no_value});
  }
  mine.push_back(at);
}

void break_line(Segment& segment) {
  for (auto* points : {&segment.stable, &segment.unstable})
    if (!points->empty()) points->push_back({no_value, no_value});
}

void add_lines(Plot& plot, const ResponseBranch& branch,
               const std::vector<std::vector<std::complex<double>>>& lines, double factor) {
  if (lines.empty()) return;
  const double zero = rounding(lines);
  int number = 0;
  for (std::size_t l = 0; l < lines.front().size(); ++l) {
    const auto swings = [&](std::size_t i) { return l < lines[i].size() && lines[i][l].imag() > zero; };
    Segment segment;
    bool any = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!swings(i)) continue;
      any = true;
      const bool stable = branch.points[i].stable != false;
      // Down to zero the square of the frequency goes evenly, from there on that of the growth.
      const auto foot = [&](std::size_t k) {
        const std::complex<double> here = lines[i][l], there = lines[k][l];
        const double down = here.imag() * here.imag(), up = std::norm(there.real() - here.real());
        const double from = branch.points[i].parameter, to = branch.points[k].parameter;
        return std::array<double, 2>{from + down / (down + up) * (to - from), 0};
      };
      const auto stands = [&](std::size_t k) {
        return k < lines.size() && l < lines[k].size() && std::abs(lines[k][l].imag()) <= zero;
      };
      if (i > 0 && !swings(i - 1)) break_line(segment);
      if (i > 0 && stands(i - 1)) add(segment, stable, foot(i - 1));
      add(segment, stable, {branch.points[i].parameter, lines[i][l].imag() * factor});
      if (stands(i + 1)) add(segment, stable, foot(i + 1));
    }
    if (!any) continue;
    const std::string name = "mode " + std::to_string(number + 1);
    if (!segment.stable.empty())
      plot.curves.push_back({.name = name, .points = std::move(segment.stable), .color = number});
    if (!segment.unstable.empty())
      plot.curves.push_back(
          {.name = name, .points = std::move(segment.unstable), .line = PlotLine::dashed, .color = number});
    ++number;
  }
  if (std::ranges::any_of(plot.curves, [](const PlotCurve& c) { return c.line == PlotLine::dashed; }))
    plot.curves.push_back({.name = "unstable",
                           .points = {{no_value, no_value}},
                           .line = PlotLine::dashed,
                           .color = plot_color::neutral});
}

// Lines of one and two oscillations a turn, where unbalance and the like would excite.
void add_orders(Plot& plot, double from, double to, double factor, double highest) {
  for (const int order : {1, 2}) {
    PlotCurve line{.name = std::to_string(order) + "× speed",
                   .points = {},
                   .line = PlotLine::dotted,
                   .color = plot_color::neutral,
                   .width = 1.2};
    for (int i = 0; i <= 200; ++i) {
      const double speed = from + (to - from) * i / 200, y = order * std::abs(speed) * factor;
      line.points.push_back({speed, y <= highest ? y : no_value});
    }
    // Told at its end, for the two look alike.
    const auto last =
        std::ranges::find_if(line.points.rbegin(), line.points.rend(),
                             [](const std::array<double, 2>& p) { return std::isfinite(p[1]) && p[1] > 0; });
    if (last != line.points.rend())
      plot.marks.push_back({.at = *last, .label = std::to_string(order) + "×", .shape = PlotShape::none});
    plot.curves.push_back(std::move(line));
  }
}

void add_special(Plot& plot, const FoundCampbell& found, std::size_t branch, double factor) {
  for (const SpecialPoint& point : found.diagram.special) {
    if (point.branch != static_cast<int>(branch)) continue;
    double y = 0;
    // A pair at the axis, or the two that meet.
    if (point.type == SpecialPointType::hopf || point.type == SpecialPointType::flutter) {
      double best = std::numeric_limits<double>::infinity();
      const auto& all = point.at.eigenvalues;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (!(all[i].imag() > 0)) continue;
        double close = std::abs(all[i].real());
        if (point.type == SpecialPointType::flutter) {
          close = std::numeric_limits<double>::infinity();
          for (std::size_t k = 0; k < all.size(); ++k)
            if (k != i) close = std::min(close, std::abs(all[k] - all[i]));
        }
        if (close < best) {
          best = close;
          y = all[i].imag();
        }
      }
    }
    std::string label(word(point.type));
    std::ranges::replace(label, '_', ' ');
    plot.marks.push_back({.at = {point.at.parameter, y * factor},
                          .label = std::move(label),
                          .shape = PlotShape::diamond,
                          .color = plot_color::vermillion});
  }
}

double highest_of(const Plot& plot) {
  double highest = 0;
  for (const PlotCurve& curve : plot.curves)
    for (const auto& p : curve.points)
      if (std::isfinite(p[1])) highest = std::max(highest, p[1]);
  return highest;
}

} // namespace

void draw_campbell(App& app) {
  const CampbellState& campbell = app.study.modes.campbell;
  CampbellView& drawn = app.plots.campbell;
  const CampbellView::Of shown{campbell.diagram.found,
                               app.study.modes.list.found,
                               app.answer.ticket,
                               app.study.modes.chosen,
                               drawn.hertz,
                               app.units};
  if (drawn.of == shown) return;
  if (!campbell.diagram.found || solving(app)) return; // the answer belongs to other numbers
  drawn.of = shown;
  Plot plot;
  const double factor = drawn.hertz ? 1 / full_turn : 1;
  const CampbellRequest& of = campbell.diagram.found->of;
  const FoundCampbell& found = campbell.diagram.found->result;
  const std::string unit = parameter_unit(app.mechanism(), of.drive);
  plot.x = {.label = parameter_phrase(of.drive),
            .unit = unit,
            .range = PlotRange{std::min(of.from, of.to), std::max(of.from, of.to)},
            .room = 0};
  plot.y = {.label = "frequency", .unit = drawn.hertz ? "Hz" : "rad/s"};
  const std::optional<std::size_t> branch = campbell_branch(app);
  if (branch) {
    add_lines(plot, found.diagram.branches[*branch], found.lines[*branch], factor);
    const double highest = highest_of(plot);
    plot.y.range = PlotRange{0, highest > 0 ? 1.1 * highest : 1};
    if (unit == "rad/s" && highest > 0) add_orders(plot, of.from, of.to, factor, 1.1 * highest);
    add_special(plot, found, *branch, factor);
  }
  if (converged(app)) {
    const double speed = get_parameter(app.mechanism(), of.drive);
    plot.references.push_back({.axis = 0, .at = speed, .label = "now", .color = plot_color::blue});
    if (const VibrationMode* mode = moving_mode(app); mode && modes_are_current(app) && mode->oscillates())
      plot.marker = PlotMarker{speed * shown_unit(unit, app.units).factor, mode->frequency * factor, ""};
  }
  show_axis(plot, 0, unit, app.units);
  replace_plot(drawn.plot, std::move(plot));
}

} // namespace flyball
