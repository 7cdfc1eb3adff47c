#include "app/plot/campbell_plot.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/study/drive_speed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace flyball {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// Eigenvalues less than this are zero (1/s).
double rounding(const CampbellBranch& branch) {
  double most = 0;
  for (const CampbellPoint& point : branch.points)
    for (const VibrationMode& mode : point.modes)
      most = std::max(most, std::abs(mode.eigenvalue));
  return 1e-6 * most;
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

void add_lines(Plot& plot, const ResponseBranch& followed, const CampbellBranch& branch,
               std::span<const std::string> names, double factor) {
  const double zero = rounding(branch);
  int number = 0;
  for (std::size_t l = 0; l < names.size(); ++l) {
    if (names[l].empty()) continue;
    const auto mode = [&](std::size_t i) { return branch.points[i].on(l); };
    const auto swings = [&](std::size_t i) { return mode(i) && mode(i)->eigenvalue.imag() > zero; };
    Segment segment;
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      if (!swings(i)) continue;
      const bool stable = followed.points[i].stable != false;
      // Down to zero the square of the frequency goes evenly, from there on that of the growth.
      const auto foot = [&](std::size_t k) {
        const std::complex<double> here = mode(i)->eigenvalue, there = mode(k)->eigenvalue;
        const double down = here.imag() * here.imag(), up = std::norm(there.real() - here.real());
        const double from = followed.points[i].parameter, to = followed.points[k].parameter;
        return std::array<double, 2>{from + down / (down + up) * (to - from), 0};
      };
      const auto stands = [&](std::size_t k) {
        return k < branch.points.size() && mode(k) && mode(k)->eigenvalue.imag() <= zero;
      };
      if (i > 0 && !swings(i - 1)) break_line(segment);
      if (i > 0 && stands(i - 1)) add(segment, stable, foot(i - 1));
      add(segment, stable, {followed.points[i].parameter, mode(i)->eigenvalue.imag() * factor});
      if (stands(i + 1)) add(segment, stable, foot(i + 1));
    }
    if (!segment.stable.empty())
      plot.curves.push_back({.name = names[l], .points = std::move(segment.stable), .color = number});
    if (!segment.unstable.empty())
      plot.curves.push_back({.name = names[l],
                             .points = std::move(segment.unstable),
                             .line = PlotLine::dashed,
                             .color = number});
    ++number;
  }
  if (std::ranges::any_of(plot.curves, [](const PlotCurve& c) { return c.line == PlotLine::dashed; }))
    plot.curves.push_back({.name = "unstable",
                           .points = {{no_value, no_value}},
                           .line = PlotLine::dashed,
                           .color = plot_color::neutral});
}

// Lines of so many oscillations a turn, where unbalance and the like would excite.
void add_orders(Plot& plot, DriveSpeed& drive, PlotRange values, std::span<const double> orders,
                double factor, double highest) {
  std::vector<std::array<double, 2>> speeds; // value of the number, rad/s
  for (int i = 0; i <= 200; ++i) {
    const double value = values[0] + (values[1] - values[0]) * i / 200;
    speeds.push_back({value, std::abs(drive.at(value))});
  }
  double width = 1.2; // points; each next one wider, to tell them apart
  for (const double order : orders) {
    PlotCurve line{.name = order_text(order) + " speed",
                   .points = {},
                   .line = PlotLine::dotted,
                   .color = plot_color::neutral,
                   .width = std::exchange(width, std::min(width + 1, 4.))};
    for (const auto& [value, speed] : speeds) {
      const double y = order * speed * factor;
      line.points.push_back({value, y <= highest ? y : no_value});
    }
    // Told at its end, too: the legend's samples are short.
    const auto last =
        std::ranges::find_if(line.points.rbegin(), line.points.rend(),
                             [](const std::array<double, 2>& p) { return std::isfinite(p[1]) && p[1] > 0; });
    if (last != line.points.rend())
      plot.marks.push_back({.at = *last, .label = order_text(order), .shape = PlotShape::none});
    plot.curves.push_back(std::move(line));
  }
}

// Without labels: what they are is read off the lines that cross there, and listed.
void add_critical(Plot& plot, const CampbellDiagram& diagram, std::size_t branch, double factor) {
  for (const CriticalSpeed& at : diagram.critical)
    if (at.branch == static_cast<int>(branch) && !at.until)
      plot.marks.push_back({.at = {at.value, at.frequency * factor},
                            .label = {},
                            .shape = PlotShape::circle,
                            .color = plot_color::neutral});
}

void add_special(Plot& plot, const ResponseDiagram& diagram, std::size_t branch, double factor) {
  for (const SpecialPoint& point : diagram.special) {
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
    if (point.type == SpecialPointType::hopf) label = "Hopf";
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

std::string order_text(double order) {
  return fmt::format("{:.6g}×", order);
}

Plot campbell_plot(const Mechanism& mechanism, const std::string& address, const CampbellDiagram& diagram,
                   std::size_t branch, std::span<const std::string> names, PlotRange values,
                   std::span<const double> orders, bool hertz) {
  Plot plot;
  const double factor = hertz ? 1 / (2 * std::numbers::pi) : 1;
  plot.x = {.label = address, .unit = parameter_unit(mechanism, address), .range = values, .room = 0};
  plot.y = {.label = "frequency", .unit = hertz ? "Hz" : "rad/s"};
  add_lines(plot, diagram.response.branches[branch], diagram.branches[branch], names, factor);
  const double highest = highest_of(plot);
  plot.y.range = PlotRange{0, highest > 0 ? 1.1 * highest : 1};
  DriveSpeed drive(mechanism, address);
  if (highest > 0 && !drive.joint().empty()) add_orders(plot, drive, values, orders, factor, 1.1 * highest);
  add_critical(plot, diagram, branch, factor);
  add_special(plot, diagram.response, branch, factor);
  return plot;
}

} // namespace flyball
