// How a person looks at the studies' plots, and the plots as they were last drawn.
#pragma once

#include "app/session/studies.hpp"
#include "app/ui/plots/plot_view.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Error against run time.
struct CompareView {
  PlotView view;
  Plot plot;
  std::uint64_t made_result = 0; // CompareState::results, of which the plot is
};

// Which points of a line a plot's curve goes through.
struct ResponsePiece {
  std::size_t line = 0, first = 0;
};

struct ResponseView {
  PlotView view;
  Plot plot;                         // of the result, with the answer's marker
  std::vector<ResponsePiece> pieces; // by curve of the plot
  std::uint64_t plotted = 0;         // ResponseState::version that the plot shows
  std::uint64_t chosen = 0;          // ResponseState::chosen that it was fitted to
  std::uint64_t plots_made = 0;
  std::uint64_t gesture = 0; // of the hand, when the plot's range of y was last fitted
  double waiting_since = -1; // s, ImGui's clock; negative: nothing runs
};

struct MapView {
  PlotView view;
  Plot plot;
  std::uint64_t made_version = 0; // MapState::version that the plot shows
  std::uint64_t made_ticket = 0;  // of the answer that the marker shows
  std::uint64_t plots_made = 0;
};

struct CampbellView {
  bool hertz = true; // or rad/s
  PlotView view;
  Plot plot;
  std::uint64_t plots_made = 0;
  // What the plot was drawn of: result, answer, modes, units, chosen mode.
  std::uint64_t made_result = 0, made_ticket = 0, made_modes = 0;
  bool made_hertz = true;
  std::optional<std::size_t> made_chosen;
};

// A plot over time.
struct MotionPlot {
  std::string quantity; // see motion_quantities(); empty: not shown
  PlotView view;
  Plot plot;                // drawn from `made`
  std::uint64_t made = 0;   // MotionState::version
  std::string made_for;     // quantity
  std::uint64_t ticket = 0; // of the answer whose steady value it shows
};

struct StudyViews {
  CompareView compare;
  ResponseView response;
  MapView map;
  CampbellView campbell;
  std::array<MotionPlot, 2> motion;
  std::uint64_t motion_plots_made = 0; // so far, for their versions
};

} // namespace flyball
