#include "app/plot/hunting_plot.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/stability/modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr double broken = std::numeric_limits<double>::quiet_NaN();

// What a part of a curve is called and looks like.
PlotCurve part_like(const HopfPoint& point) {
  if (point.growing > 0)
    return {.name = "hunts already",
            .points = {},
            .line = PlotLine::dotted,
            .color = plot_color::neutral,
            .width = 2.2};
  switch (point.loss()) {
  case HopfLoss::soft:
    return {.name = "hunting begins, soft", .points = {}, .color = plot_color::green, .width = 2.8};
  case HopfLoss::hard:
    return {.name = "hunting begins, hard", .points = {}, .color = plot_color::purple, .width = 2.8};
  case HopfLoss::undecided: break;
  }
  return {.name = "hunting begins", .points = {}, .color = plot_color::neutral, .width = 2.2};
}

} // namespace

std::string frequency_text(const HopfPoint& point) {
  return fmt::format("{:.6g} rad/s ({:.6g} Hz)", point.frequency, hertz(point.frequency));
}

std::string loss_text(const HopfPoint& point) {
  return point.growing > 0 ? "other motions grow already" : std::string(word(point.loss()));
}

void add_hunting_curves(Plot& plot, const PlaneCurves& curves) {
  std::vector<PlotCurve> parts;
  for (const PlaneCurve& curve : curves.curves) {
    PlotCurve* before = nullptr;
    std::array<double, 2> last{};
    double last_frequency = 0;
    for (const PlanePoint& p : curve.points) {
      if (!p.hopf) continue;
      PlotCurve like = part_like(*p.hopf);
      // Where the frequency is zero there is no pair to tell of: it belongs to its neighbour.
      if (p.hopf->frequency == 0 && before) like.name = before->name;
      auto mine = std::ranges::find(parts, like.name, &PlotCurve::name);
      if (mine == parts.end()) {
        const auto index = before ? before - parts.data() : 0;
        like.along = PlotAlong{"hunts at", "Hz", {}};
        parts.push_back(std::move(like));
        mine = parts.end() - 1;
        if (before) before = parts.data() + index;
      }
      if (before != &*mine) {
        if (!mine->points.empty()) {
          mine->points.push_back({broken, broken});
          mine->along->values.push_back(broken);
        }
        if (before) { // the two kinds of pieces meet
          mine->points.push_back(last);
          mine->along->values.push_back(last_frequency);
        }
      }
      mine->points.push_back(last = {p.x, p.y});
      mine->along->values.push_back(last_frequency = hertz(p.hopf->frequency));
      before = &*mine;
    }
    for (const PlanePoint& p : curve.bautin)
      plot.marks.push_back({.at = {p.x, p.y}, .label = "soft to hard (Bautin)", .shape = PlotShape::diamond});
    for (const PlanePoint& p : curve.takens)
      plot.marks.push_back(
          {.at = {p.x, p.y}, .label = "frequency 0 (Bogdanov\u2013Takens)", .shape = PlotShape::square});
  }
  for (PlotCurve& part : parts)
    plot.curves.push_back(std::move(part));
}

Plot hunting_plot(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                  const PlaneCurves& curves) {
  const auto axis = [&](const PlaneAxis& of) {
    return PlotAxis{.label = of.address,
                    .unit = parameter_unit(mechanism, of.address),
                    .range = PlotRange{of.from, of.to},
                    .room = 0};
  };
  Plot plot;
  plot.x = axis(x);
  plot.y = axis(y);
  add_hunting_curves(plot, curves);
  return plot;
}

} // namespace flyball
