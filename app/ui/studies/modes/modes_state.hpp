// The modes of the steady state that is shown, one of them moving in the view, and the Campbell diagram:
// their frequencies over a drive's speed. Nothing of it is made before a person asks.
#pragma once

#include "app/live/background.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "engine/continuation/branches.hpp"
#include "engine/report/analysis.hpp"

#include <complex>
#include <memory>

namespace flyball {

struct FoundModes {
  std::vector<VibrationMode> modes;
  std::optional<StabilityEvidence> evidence;
  std::unique_ptr<Analysis> analysis; // which stands in the state, for poses along a mode
  double run_time_s = 0;
};

struct FoundCampbell {
  std::string drive;       // address of the speed along the axis
  double from = 0, to = 0; // its range
  ResponseDiagram diagram;
  // By branch, point and line: see track_eigenvalues().
  std::vector<std::vector<std::vector<std::complex<double>>>> lines;
  bool cancelled = false;
  double run_time_s = 0;
};

struct CampbellState {
  std::unique_ptr<Background<FoundCampbell>> task;
  std::optional<FoundCampbell> result;
  // As chosen. An empty drive is the first; both ends 0: as the speed's slider.
  std::string drive;
  double from = 0, to = 0;
  bool hertz = true; // or rad/s
  // As last followed: also the mechanism with that speed 0, and that of the result.
  std::string asked_drive;
  double asked_from = 0, asked_to = 0;
  Mechanism asked, of;
  std::uint64_t revision = 0;     // of the document when `current` was found
  bool current = false;           // the result is of the mechanism as it is
  bool on_branch = true;          // it holds the branch of the state that is shown
  std::uint64_t asked_ticket = 0; // of the answer when it was asked for
  std::string problem;
  PlotView view;
  Plot plot;
  std::uint64_t results = 0, plots_made = 0;
  // What the plot was drawn of: result, answer, modes, units, chosen mode.
  std::uint64_t made_result = 0, made_ticket = 0, made_modes = 0;
  bool made_hertz = true;
  std::optional<std::size_t> made_chosen;
};

struct ModesState {
  std::unique_ptr<Background<FoundModes>> task;
  std::optional<FoundModes> result;
  std::uint64_t asked = 0, of = 0; // tickets of the answers: last asked for, and of the result
  std::string problem;

  std::optional<std::size_t> chosen; // of the modes
  double amplitude = 0.15;           // of the largest coordinate: rad, or parts of the mechanism's reach
  double phase = 0;                  // rad
  bool playing = false;
  std::vector<Pose> poses; // along the chosen mode; empty: none
  struct Posed {
    std::uint64_t of = 0;
    std::size_t mode = 0;
    double amplitude = 0, phase = 0, time = 0;
    bool operator==(const Posed&) const = default;
  } posed; // what they are of

  CampbellState campbell;
};

} // namespace flyball
