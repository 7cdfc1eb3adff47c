#include "app/plot/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace flyball {

namespace {

// The part of the way from one point of a line to the next at which it is drawn at `x`.
double part_of_way(const PlotLayout& layout, const std::array<double, 2>& a, const std::array<double, 2>& b,
                   double x) {
  const double xa = layout.x.pixel(a[0]), xb = layout.x.pixel(b[0]), at = layout.x.pixel(x);
  return xb == xa ? 0 : std::clamp((at - xa) / (xb - xa), 0., 1.);
}

// Where the value goes through `x` between two points of a line, as drawn.
double value_between(const PlotLayout& layout, const std::array<double, 2>& a, const std::array<double, 2>& b,
                     double x) {
  const double t = part_of_way(layout, a, b, x);
  if (t == 0) return a[1];
  if (t == 1) return b[1];
  return layout.y.logarithmic ? a[1] * std::pow(b[1] / a[1], t) : a[1] + t * (b[1] - a[1]);
}

// A line that says a value at every x, and is seen.
bool is_read(const PlotCurve& curve, const PlotLook& look) {
  return is_shown(curve, look) && curve.line != PlotLine::none && !curve.hatching;
}

} // namespace

std::optional<PlotNear> nearest_point(const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                                      double px, double py, double reach) {
  std::optional<PlotNear> best;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    if (!is_shown(plot.curves[c], look) || plot.curves[c].hatching) continue;
    const auto& points = plot.curves[c].points;
    // Values outside these are too far: no logarithm needed.
    const double x0 = layout.x.value(px - reach), x1 = layout.x.value(px + reach);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(points[i][0] >= x0 && points[i][0] <= x1)) continue;
      const double x = layout.x.pixel(points[i][0]), y = layout.y.pixel(points[i][1]);
      const double distance = std::hypot(x - px, y - py);
      if (distance <= (best ? best->distance : reach) && layout.area.grown(1).contains(x, y))
        best = PlotNear{c, static_cast<double>(i), points[i][0], points[i][1], distance};
    }
  }
  return best;
}

std::optional<PlotNear> nearest_along(const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                                      double px, double py) {
  std::optional<PlotNear> best;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    if (!is_shown(plot.curves[c], look) || plot.curves[c].hatching) continue;
    const auto& points = plot.curves[c].points;
    PixelPoint before{NAN, NAN};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PixelPoint here{layout.x.pixel(points[i][0]), layout.y.pixel(points[i][1])};
      if (!std::isfinite(here[0]) || !std::isfinite(here[1])) {
        before = {NAN, NAN};
        continue;
      }
      const bool joined = i > 0 && std::isfinite(before[0]);
      const PixelPoint a = joined ? before : here;
      const double dx = here[0] - a[0], dy = here[1] - a[1], square = dx * dx + dy * dy;
      const double t = square > 0 ? std::clamp(((px - a[0]) * dx + (py - a[1]) * dy) / square, 0., 1.) : 1;
      const double distance = std::hypot(a[0] + t * dx - px, a[1] + t * dy - py);
      if (!best || distance < best->distance) {
        const auto& p = points[joined ? i - 1 : i];
        const auto& q = points[i];
        const auto between = [&](double from, double to, bool logarithmic) {
          return t == 1 ? to : logarithmic ? from * std::pow(to / from, t) : from + t * (to - from);
        };
        best = PlotNear{c, static_cast<double>(i) - (1 - t), between(p[0], q[0], layout.x.logarithmic),
                        between(p[1], q[1], layout.y.logarithmic), distance};
      }
      before = here;
    }
  }
  return best;
}

std::vector<PlotReading> readings_at(const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                                     double x, double py) {
  std::vector<PlotReading> readings;
  std::set<std::string> read;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const std::string& name = plot.curves[c].name;
    if (!is_read(plot.curves[c], look) || !read.insert(name).second) continue;
    std::optional<PlotReading> best;
    double least = 0;
    for (const PlotCurve& curve : plot.curves) {
      if (curve.name != name || !is_read(curve, look)) continue;
      for (std::size_t i = 1; i < curve.points.size(); ++i) {
        const auto &a = curve.points[i - 1], &b = curve.points[i];
        if (!((a[0] <= x && x <= b[0]) || (b[0] <= x && x <= a[0]))) continue;
        const double y = value_between(layout, a, b, x), pixel = layout.y.pixel(y);
        if (!std::isfinite(pixel)) continue;
        const double distance = std::abs(pixel - py);
        if (best && distance >= least) continue;
        best = PlotReading{c, y};
        least = distance;
        if (const std::size_t near = std::abs(x - a[0]) < std::abs(x - b[0]) ? i - 1 : i;
            near < curve.notes.size())
          best->note = curve.notes[near];
        if (curve.along && i < curve.along->values.size()) {
          const double from = curve.along->values[i - 1], to = curve.along->values[i];
          const double value = from + part_of_way(layout, a, b, x) * (to - from);
          constexpr double finest = 1e-5; // of it: what hardly changes has no more digits than what does
          best->along = {value, std::max(std::abs(to - from), finest * std::abs(value))};
        }
      }
    }
    if (best) readings.push_back(std::move(*best));
  }
  return readings;
}

std::vector<BandReading> bands_at(const Plot& plot, const PlotLook& look, const PlotLayout& layout, double x,
                                  double py) {
  std::vector<BandReading> readings;
  std::set<std::string> read;
  for (const PlotBand& named : plot.bands) {
    if (!is_shown(named, look) || !read.insert(named.name).second) continue;
    std::optional<BandReading> best;
    double least = 0;
    for (std::size_t b = 0; b < plot.bands.size(); ++b) {
      const PlotBand& band = plot.bands[b];
      if (band.name != named.name) continue;
      for (std::size_t i = 1; i < band.points.size(); ++i) {
        const auto &p = band.points[i - 1], &q = band.points[i];
        if (!((p[0] <= x && x <= q[0]) || (q[0] <= x && x <= p[0])) || p[0] == q[0]) continue;
        const BandReading here{b, value_between(layout, {p[0], p[1]}, {q[0], q[1]}, x),
                               value_between(layout, {p[0], p[2]}, {q[0], q[2]}, x)};
        const double distance = std::abs(layout.y.pixel((here.lower + here.upper) / 2) - py);
        if (!std::isfinite(distance) || (best && distance >= least)) continue;
        best = here;
        least = distance;
      }
    }
    if (best) readings.push_back(*best);
  }
  return readings;
}

} // namespace flyball
