#include "app/plot/transfer_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

PlotAxis frequency_axis(bool hertz) {
  return {.label = "frequency", .unit = hertz ? "Hz" : "rad/s", .logarithmic = true, .room = 0};
}

double frequency(const BodePoint& point, bool hertz) {
  return point.frequency * (hertz ? 1 : 2 * std::numbers::pi);
}

} // namespace

Plot magnitude_plot(const std::vector<BodePoint>& response, bool hertz) {
  Plot plot;
  plot.x = frequency_axis(hertz);
  plot.y = {.label = "gain", .unit = "dB"}; // short, for a low plot
  PlotCurve curve{.name = "", .points = {}};
  for (const BodePoint& point : response) {
    const double level =
        point.magnitude > 0 ? 20 * std::log10(point.magnitude) : std::numeric_limits<double>::quiet_NaN();
    curve.points.push_back({frequency(point, hertz), level});
  }
  plot.curves.push_back(std::move(curve));
  return plot;
}

Plot phase_plot(const std::vector<BodePoint>& response, bool hertz) {
  Plot plot;
  plot.x = frequency_axis(hertz);
  plot.y = {.label = "phase", .unit = "°", .noise = 1e-9};
  PlotCurve curve{.name = "", .points = {}};
  for (const BodePoint& point : response)
    curve.points.push_back({frequency(point, hertz),
                            point.magnitude > 0 ? point.phase : std::numeric_limits<double>::quiet_NaN()});
  plot.curves.push_back(std::move(curve));
  return plot;
}

Plot pole_zero_plot(const std::vector<std::complex<double>>& poles,
                    const std::vector<std::complex<double>>& zeros) {
  Plot plot;
  plot.x = {.label = "real part", .unit = "1/s"};
  plot.y = {.label = "imaginary part", .unit = "rad/s"};
  const auto points = [](const std::vector<std::complex<double>>& all) {
    std::vector<std::array<double, 2>> out;
    for (const std::complex<double> s : all)
      out.push_back({s.real(), s.imag()});
    return out;
  };
  // Below the poles, so that both are seen where one cancels the other.
  if (!zeros.empty())
    plot.curves.push_back({.name = "zeros",
                           .points = points(zeros),
                           .line = PlotLine::none,
                           .color = plot_color::blue,
                           .shape = PlotShape::circle,
                           .shape_size = 8});
  plot.curves.push_back({.name = "poles",
                         .points = points(poles),
                         .line = PlotLine::none,
                         .color = plot_color::vermillion,
                         .shape = PlotShape::cross,
                         .shape_size = 8});
  // The axis of what neither grows nor decays belongs to the picture, and a range of nothing has no middle.
  double left = 0, right = 0, high = 0;
  for (const auto* all : {&poles, &zeros})
    for (const std::complex<double> s : *all) {
      left = std::min(left, s.real());
      right = std::max(right, s.real());
      high = std::max(high, std::abs(s.imag()));
    }
  const double wide = std::max({right - left, 0.02 * high, 1e-12});
  plot.x.range = PlotRange{left - 0.12 * wide, right + 0.12 * wide};
  high = high > 0 ? high : wide;
  plot.y.range = PlotRange{-1.15 * high, 1.15 * high};
  plot.references.push_back({.axis = 0, .at = 0, .label = "", .line = PlotLine::solid});
  return plot;
}

} // namespace flyball
