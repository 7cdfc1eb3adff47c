// All that a report tells, as values: what was solved, and what is drawn beside it.
#pragma once

#include "app/plot/plot.hpp"
#include "app/report/spring_loads.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/periodic/periodic_state.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/friction_report.hpp"

#include <memory>

namespace flyball {

// The response to one slider, or to a drive's speed where there are no sliders.
struct ReportCurve {
  Slider over;
  double present = 0;      // the parameter's value in the report
  std::vector<Plot> plots; // one a coordinate; none where nothing could be followed
  std::string message;     // sentences: what was followed, or why nothing
};

// The mechanism in its steady state, as PNG files on light and on dark ground.
struct ReportPicture {
  std::string light, dark;
  int width = 0, height = 0; // pixels
  std::string problem;       // why there is none; then the rest is empty
};

// A number that was tried beside the file when the report was made.
struct ExploredNumber {
  std::string address;
  double in_file = 0;
};

struct ReportContents {
  std::shared_ptr<const Mechanism> mechanism;
  std::string scene; // name of its file; may be empty
  std::string date;  // of the report, in words
  std::vector<ExploredNumber> explored;
  ReportPicture picture;
  std::vector<SceneError> warnings;
  SystemSummary system;
  Solution solution;
  std::optional<PeriodicState> periodic; // where the balance turns with the drives
  std::optional<PeriodicState> cycle;    // beside a steady state that hunts: the limit cycle, or why none
  std::vector<VibrationMode> modes;
  std::optional<StabilityEvidence> evidence;
  std::optional<FrictionReport> friction; // of a scene that has some
  std::vector<SpringLoad> springs;
  std::vector<ReportCurve> curves;
  bool cut_short = false; // by ReportOptions::cancel: curves may be missing
};

// Whether a periodic motion takes the steady state's place; curves are of such motions then.
bool moves(const ReportContents& contents);

struct ReportOptions {
  // See SolveOptions.
  std::vector<std::pair<std::string, double>> start{};
  bool nearest = false;
  // The coordinates that curves show ("joint", or "joint.index"); empty: the first angle and the first
  // length.
  std::vector<std::string> plotted{};
  const std::atomic<bool>* cancel = nullptr; // what was found until then is told
  ReportProgress progress{};
};

// Solves, and follows the curves. Picture, scene, date and what is explored are whoever asks' to fill in.
// Throws SceneError for a mechanism that cannot be compiled, and for coordinates and starts that are none.
ReportContents report_contents(std::shared_ptr<const Mechanism> mechanism, const ReportOptions& options);

// Now, in the computer's time zone: "2026-11-24 23:05".
std::string report_date();

} // namespace flyball
