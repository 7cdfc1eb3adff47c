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

struct TimedError {
  double time = 0, error = 0;
  std::string note;
};

// The runs of each integrator: joined are those than which none is both sooner and nearer, the others are
// small. To join all of one duration shows mostly how uneven run times are.
template <typename ErrorOf>
void add_motions(Plot& plot, const Comparison& comparison, const ErrorOf& error_of) {
  std::vector<Integrator> methods;
  for (const MotionCurve& motion : comparison.motion)
    if (std::ranges::find(methods, motion.method) == methods.end()) methods.push_back(motion.method);
  for (const Integrator method : methods) {
    std::vector<TimedError> runs;
    for (const MotionCurve& motion : comparison.motion) {
      if (motion.method != method) continue;
      for (const MotionMark& p : motion.points)
        if (const double error = error_of(p); std::isfinite(error) && p.run_time_s > 0)
          runs.push_back({p.run_time_s, std::max(error, least_error),
                          fmt::format("{:.3g} s simulated, tolerance {:.0e}", motion.duration, p.tolerance)});
    }
    if (runs.empty()) continue;
    std::ranges::sort(runs, [](const TimedError& a, const TimedError& b) {
      return a.time != b.time ? a.time < b.time : a.error < b.error;
    });
    PlotCurve best, others;
    best.name = others.name = title_of(method);
    best.color = others.color = color_of(method);
    best.shape = others.shape = shape_of(method);
    best.width = 1.4;
    others.line = PlotLine::none;
    others.shape_size = 3;
    double nearest = std::numeric_limits<double>::infinity();
    for (TimedError& run : runs) {
      PlotCurve& curve = run.error < nearest ? best : others;
      nearest = std::min(nearest, run.error);
      curve.points.push_back({run.time, run.error});
      curve.notes.push_back(std::move(run.note));
    }
    plot.curves.push_back(std::move(best));
    if (!others.points.empty()) plot.curves.push_back(std::move(others));
  }
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
  add_motions(plot, comparison, error_of);
  PlotCurve direct;
  direct.name = "direct solution, by iteration";
  direct.color = plot_color::blue;
  direct.shape = PlotShape::circle;
  direct.width = 2;
  for (const DirectMark& m : comparison.direct)
    if (const double error = error_of(m); std::isfinite(error) && m.run_time_s > 0) {
      direct.points.push_back({m.run_time_s, std::max(error, least_error)});
      direct.notes.push_back(fmt::format("{} iteration{}", m.iterations, m.iterations == 1 ? "" : "s"));
    }
  plot.curves.push_back(std::move(direct));
  if (const double error = error_of(comparison.answer);
      std::isfinite(error) && comparison.answer.run_time_s > 0)
    plot.marks.push_back({.at = {comparison.answer.run_time_s, std::max(error, least_error)},
                          .label = "with all checks",
                          .color = plot_color::blue});
  if (const auto& best = comparison.best; best && !measure && best->motion_s > 0)
    plot.marks.push_back({.at = {best->motion_s, std::max(best->error, least_error)},
                          .label = "nearest motion",
                          .color = color_of(best->method)});
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
