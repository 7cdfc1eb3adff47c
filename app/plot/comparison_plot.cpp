#include "app/plot/comparison_plot.hpp"

#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

// Below this an error is that of the last bit: a logarithm needs something.
constexpr double least_error = 1e-17;

const char* title_of(Integrator method) {
  switch (method) {
  case Integrator::automatic: return "automatic";
  case Integrator::bdf: return "BDF";
  case Integrator::adams: return "Adams";
  case Integrator::runge_kutta: return "Runge-Kutta";
  }
  return "";
}

PlotShape shape_of(Integrator method) {
  switch (method) {
  case Integrator::automatic:
  case Integrator::bdf: return PlotShape::square;
  case Integrator::adams: return PlotShape::triangle;
  case Integrator::runge_kutta: return PlotShape::diamond;
  }
  return PlotShape::none;
}

int color_of(Integrator method) {
  switch (method) {
  case Integrator::automatic:
  case Integrator::bdf: return plot_color::vermillion;
  case Integrator::adams: return plot_color::green;
  case Integrator::runge_kutta: return plot_color::purple;
  }
  return plot_color::neutral;
}

} // namespace

Plot comparison_plot(const std::string& title, const Comparison& comparison,
                     std::optional<std::size_t> measure) {
  const auto error_of = [&](const auto& of) {
    if (!measure) return of.error;
    const bool known = *measure < of.measure_errors.size();
    return known ? of.measure_errors[*measure] : std::numeric_limits<double>::quiet_NaN();
  };
  Plot plot;
  plot.title = title;
  plot.x = {.label = "run time", .unit = "s", .logarithmic = true};
  plot.y = {.label = "error |q - q*|", .unit = "", .logarithmic = true};
  if (measure) {
    const MeasureSolution& shown = comparison.measures[*measure];
    plot.y.label = "error of " + printable(shown.name);
    plot.y.unit = shown.unit;
  }
  for (const MotionCurve& motion : comparison.motion) {
    PlotCurve curve;
    curve.name = title_of(motion.method);
    curve.color = color_of(motion.method);
    curve.shape = shape_of(motion.method);
    curve.shape_size = 4;
    curve.width = 1;
    for (const MotionMark& p : motion.points)
      if (const double error = error_of(p); std::isfinite(error) && p.run_time_s > 0)
        curve.points.push_back({p.run_time_s, std::max(error, least_error)});
    if (curve.points.empty()) continue;
    // Which curve is of which duration shows at its cheap end.
    if (motion.method == Integrator::bdf)
      plot.marks.push_back({.at = curve.points.front(),
                            .label = fmt::format("{:.3g} s", motion.duration),
                            .shape = PlotShape::none});
    plot.curves.push_back(std::move(curve));
  }
  PlotCurve direct;
  direct.name = "direct, by iteration";
  direct.color = plot_color::blue;
  direct.shape = PlotShape::circle;
  direct.width = 2;
  for (const DirectMark& m : comparison.direct)
    if (const double error = error_of(m); std::isfinite(error) && m.run_time_s > 0)
      direct.points.push_back({m.run_time_s, std::max(error, least_error)});
  plot.curves.push_back(std::move(direct));
  if (const double error = error_of(comparison.answer);
      std::isfinite(error) && comparison.answer.run_time_s > 0)
    plot.marks.push_back({.at = {comparison.answer.run_time_s, std::max(error, least_error)},
                          .label = "with all checks",
                          .color = plot_color::blue});
  return plot;
}

std::string comparison_csv(const Comparison& c) {
  std::string out = "method,duration_s,tolerance,iterations,error,run_time_s,steps,evaluations,status";
  for (const MeasureSolution& measure : c.measures)
    out += "," + csv_field("error of " + measure.name);
  out += "\n";
  const auto measures = [&](const std::vector<double>& errors) {
    std::string cells;
    for (std::size_t i = 0; i < c.measures.size(); ++i)
      cells += "," + (i < errors.size() ? csv_number(errors[i]) : "");
    return cells + "\n";
  };
  for (const DirectMark& m : c.direct)
    out += fmt::format("direct,,,{},{},{},,,{}", m.iterations, csv_number(m.error), csv_number(m.run_time_s),
                       word(c.status)) +
           measures(m.measure_errors);
  out += fmt::format("direct_answer,,,{},{},{},,,{}", c.answer.iterations, csv_number(c.answer.error),
                     csv_number(c.answer.run_time_s), word(c.status)) +
         measures(c.answer.measure_errors);
  for (const MotionCurve& curve : c.motion)
    for (const MotionMark& p : curve.points)
      out += fmt::format("{},{},{},,{},{},{},{},{}", word(curve.method), csv_number(curve.duration),
                         csv_number(p.tolerance), csv_number(p.error), csv_number(p.run_time_s), p.steps,
                         p.evaluations, word(p.status)) +
             measures(p.measure_errors);
  return out;
}

} // namespace flyball
