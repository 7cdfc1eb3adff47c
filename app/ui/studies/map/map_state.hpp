// A coordinate over the plane of two parameters, with the curves of folds in it. Nothing of it is made before
// a person asks.
#pragma once

#include "app/live/background.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "engine/study/fold_curve.hpp"

#include <array>
#include <memory>

namespace flyball {

struct MapAxis {
  std::string address;
  double from = 0, to = 1; // from < to
  int count = 41;          // values, ends included
  bool operator==(const MapAxis&) const = default;
};

// What is wanted of a map.
struct MapChoice {
  std::array<MapAxis, 2> axes;
  std::string coordinate; // label of the coordinate that is shown
  bool folds = true;
  std::optional<double> level{}; // rad or m: the curve on which the coordinate keeps this value
  bool operator==(const MapChoice&) const = default;
};

struct MapCell {
  double value = 0; // rad or m; not a number where there is no steady state
  std::optional<bool> stable;
};

struct FoundCells {
  MapChoice choice;
  std::vector<MapCell> cells; // the first axis fastest
  bool cancelled = false;
  double run_time_s = 0;
};

struct FoundCurves {
  std::optional<PlaneCurves> folds, level;
  bool cancelled = false;
  double run_time_s = 0;
};

struct MapState {
  MapChoice choice;
  std::unique_ptr<Background<FoundCells>> cells_task;
  std::unique_ptr<Background<FoundCurves>> curves_task;
  std::optional<FoundCells> cells;
  std::optional<FoundCurves> curves;
  MapChoice asked_cells, asked_curves; // what of the choice they depend on, as last computed
  Mechanism cells_of, curves_of;       // with the two parameters 0
  std::uint64_t revision = 0;          // of the document when `stale` was found
  bool stale = false;                  // computed before the last changes
  std::string problem;
  PlotView view;
  Plot plot;
  std::uint64_t made_ticket = 0; // of the answer that the marker shows
  bool made = false;             // the plot is of what there is
  std::uint64_t plots_made = 0;
};

} // namespace flyball
