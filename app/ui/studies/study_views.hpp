// How a person looks at the studies' plots, and the plots as they were last drawn.
#pragma once

#include "app/session/motion.hpp"
#include "app/session/studies.hpp"
#include "app/session/units.hpp"
#include "app/ui/plots/plot_view.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Error against run time.
struct CompareView {
  PlotView view;
  Plot plot;
  std::shared_ptr<const void> of; // the measurements that the plot is of
  std::string shown;              // and the measure
};

// Which points of a line a plot's curve goes through.
struct ResponsePiece {
  std::size_t line = 0, first = 0;
};

struct ResponseView {
  PlotView view;
  Plot plot;                         // of the result, with the answer's marker
  std::vector<ResponsePiece> pieces; // by curve of the plot
  struct Of {
    std::shared_ptr<const void> curve, design, band, ribbon; // what was found
    std::string quantity;
    DisplayUnits units;
    bool pulled = false; // the marker, in this moment
    bool operator==(const Of&) const = default;
  } of;
  ResponseChoice fitted;             // what was chosen when all of the plot was last in view
  std::uint64_t gesture = 0;         // of the hand, when the plot's range of y was last fitted
  double waiting_since = -1;         // s, ImGui's clock; negative: nothing runs
  const void* answer_seen = nullptr; // the last of *Find*'s that was brought into sight
};

struct MapView {
  PlotView view;
  Plot plot;
  struct Of {
    std::shared_ptr<const void> cells, curves; // what was found
    DisplayUnits units;
    bool operator==(const Of&) const = default;
  } of;
  std::uint64_t marked = 0; // ticket of the answer that the marker shows
};

struct SpreadView {
  PlotView view;
  Plot plot;
  struct Of {
    std::shared_ptr<const void> samples; // what was found
    std::string output;
    DisplayUnits units;
    bool operator==(const Of&) const = default;
  } of;
};

struct TransferView {
  bool hertz = true; // or rad/s
  PlotView magnitude_view, phase_view, roots_view;
  Plot magnitude, phase, roots;
  struct Of {
    std::shared_ptr<const void> model; // what was found
    bool hertz = true;
    bool operator==(const Of&) const = default;
  } of;
  TransferChoice fitted; // what was chosen when all of the plots was last in view
};

// A critical speed as it is written into the table.
struct CriticalRow {
  std::string order, mode, whirl, speed;
  bool unbalance = false; // it excites it
  double at = 0;          // of the number along the axis
  std::string help;
};

struct CampbellView {
  bool hertz = true;               // or rad/s
  bool critical_for_modes = false; // where there is room for one table: that of the critical speeds
  PlotView view;
  Plot plot;
  std::optional<std::vector<CriticalRow>> critical; // none: the axis sets no speed of turning
  ShownUnit unit;                                   // of the drive's speed
  std::string without_modes;                        // where the branch that is shown has none; empty: nowhere
  struct Of {
    std::shared_ptr<const void> diagram, modes; // what was found
    std::uint64_t answer = 0;                   // its ticket
    std::optional<std::size_t> chosen;          // of the modes
    bool hertz = true;
    DisplayUnits units;
    bool operator==(const Of&) const = default;
  } of;
  float head = 0; // pixels that choices and remarks took above the diagram when it was last drawn; 0: never
};

// A plot over time.
struct MotionPlot {
  std::string quantity; // see motion_quantities(); empty: not shown
  PlotView view;
  Plot plot;
  struct Of {
    std::array<std::shared_ptr<const Run>, 2> runs; // null: not shown
    std::string quantity;
    std::uint64_t answer = 0; // ticket of that whose steady value it shows
    DisplayUnits units;
    bool operator==(const Of&) const = default;
  } of;
};

struct StudyViews {
  CompareView compare;
  ResponseView response;
  MapView map;
  SpreadView spread;
  TransferView transfer;
  CampbellView campbell;
  std::array<MotionPlot, 2> motion;
};

} // namespace flyball
