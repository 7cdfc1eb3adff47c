// A coordinate over the plane of two parameters, with the curves of folds in it. Nothing of it is made before
// a person asks.
#pragma once

#include "app/live/background.hpp"
#include "engine/solve/solution.hpp"
#include "engine/study/fold_curve.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

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
  std::uint64_t version = 1; // of what was found
};

// Takes what was computed; computes what was chosen, and anew after changes where that takes no time to speak
// of.
void update_map(Session& session);
void compute_map(Session& session); // all of it
void cancel_map(Session& session);
// Everything goes but what was chosen.
void close_map(Session& session);
bool computing_map(const Session& session);
Progress map_progress(const Session& session);
double map_seconds(const Session& session); // since it was begun

// Addresses of the numbers that may be varied: those with a slider first, then every other unless they are
// very many.
std::vector<std::string> map_addresses(const Session& session);
// An axis over the number, with the range of its slider or of one that suits it.
MapAxis map_axis(const Session& session, const std::string& address);
// The coordinate that is shown, with its present value; null where there is none.
const CoordinateSolution* map_coordinate(const Session& session);
// Both parameters, as one step of the history.
void go_to_place(Session& session, const std::array<double, 2>& place);

} // namespace flyball
