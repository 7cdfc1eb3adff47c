#include "app/plot/resonance_plot.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

enum class Piece { motion_stable, motion_unstable, motion_undecided, steady_stable, steady_other };

Piece piece_of(const ResonancePoint& point) {
  if (point.steady) return point.stable == true ? Piece::steady_stable : Piece::steady_other;
  if (!point.stable) return Piece::motion_undecided;
  return *point.stable ? Piece::motion_stable : Piece::motion_unstable;
}

// What is nothing but rounding is told as zero.
double mean_of(const PeriodicRange& range) {
  constexpr double rounding = 1e-12; // of what it goes through
  const double error = std::isfinite(range.error) ? range.error : 0;
  return std::abs(range.mean) <= std::max(error, rounding * (range.most - range.least)) ? 0 : range.mean;
}

PlotCurve empty_curve(Piece piece, bool band) {
  PlotCurve curve{.name = band ? "mean, " : "", .points = {}};
  switch (piece) {
  case Piece::motion_stable: curve.name += "stable"; return curve;
  case Piece::motion_unstable:
    curve.name += "unstable";
    curve.line = PlotLine::dashed;
    curve.color = plot_color::vermillion;
    return curve;
  case Piece::motion_undecided:
    curve.name += "undecided";
    curve.line = PlotLine::dotted;
    curve.color = plot_color::neutral;
    return curve;
  case Piece::steady_stable:
    curve.name = "steady state";
    curve.color = plot_color::green;
    return curve;
  case Piece::steady_other: break;
  }
  curve.name = "steady state, not stable";
  curve.line = PlotLine::dashed;
  curve.color = plot_color::orange;
  return curve;
}

} // namespace

void add_resonance(Plot& plot, const ResonanceCurve& curve, OutputKind kind, const std::string& name) {
  const bool banded = kind != OutputKind::motion;
  const ResonancePoint* before = nullptr; // told there, and the next goes on from it
  Piece piece{};
  PlotBand* band = nullptr;
  for (const auto& each : curve.points) {
    const ResonancePoint& point = *each;
    const PeriodicRange* range = point.found() ? point.range_of(kind, name) : nullptr;
    if (!range || !std::isfinite(range->mean)) {
      before = nullptr;
      band = nullptr;
      continue;
    }
    // A motion does not go over into what stands: its range may be the same at any speed but none.
    if (before && before->steady != point.steady) {
      before = nullptr;
      band = nullptr;
    }
    if (!before || piece != piece_of(point)) {
      piece = piece_of(point);
      plot.curves.push_back(empty_curve(piece, banded));
      // Up to the point where it changes, so that no gap is left that is none.
      if (before)
        plot.curves.back().points.push_back({before->number, mean_of(*before->range_of(kind, name))});
    }
    plot.curves.back().points.push_back({point.number, mean_of(*range)});
    if (banded && !point.steady) {
      if (!band) band = &plot.bands.emplace_back(PlotBand{"least to most", {}, plot_color::sky_blue});
      band->points.push_back({point.number, range->least, range->most});
    }
    before = &point;
  }
}

} // namespace flyball
