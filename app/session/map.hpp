// A coordinate or measure over the plane of two parameters, with the curves of folds in it. Nothing of it is
// made before a person asks.
#pragma once

#include "app/session/study.hpp"
#include "app/session/varied_mechanism.hpp"
#include "engine/solve/solution.hpp"
#include "engine/study/fold_curve.hpp"
#include "engine/study/hopf_curve.hpp"

#include <array>
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
  std::string shown; // name of the quantity
  bool folds = true;
  bool hunting = false;          // where a pair of eigenvalues crosses the axis (Hopf)
  std::optional<double> level{}; // SI: the curve on which the quantity keeps this value
  bool operator==(const MapChoice&) const = default;
};

// What of it the cells depend on, or the curves.
struct MapRequest {
  MapChoice choice;
  SharedMechanism mechanism; // with the two numbers 0
  bool operator==(const MapRequest&) const = default;
};

struct MapCell {
  double value = 0; // SI; not a number where there is no steady state, or it is undefined
  std::optional<bool> stable;
};
using MapCells = std::vector<MapCell>; // the first axis fastest

struct MapCurves {
  std::optional<PlaneCurves> folds, hunting, level;
};

struct MapState {
  MapChoice choice;
  std::string refusal; // why there can be no map
  Study<MapRequest, MapCells> cells;
  Study<MapRequest, MapCurves> curves;
  VariedMechanism varied;
  bool stale = false; // computed before the last changes
};

// Takes what was computed; computes what was chosen, and anew after changes where that takes no time to speak
// of.
void update_map(Session& session);
void compute_map(Session& session); // all of it
void cancel_map(Session& session);
// Everything goes but what was chosen.
void close_map(Session& session);
bool computing_map(const Session& session);
// Why there is none, or not of what is chosen; "" where there is.
std::string map_problem(const Session& session);
Progress map_progress(const Session& session);
double map_seconds(const Session& session); // since it was begun

// Addresses of the numbers that may be varied, dampers where the boundary of hunting is asked for.
std::vector<std::string> map_addresses(const Session& session);
// An axis over the number, with the range of its slider or of one that suits it.
MapAxis map_axis(const Session& session, const std::string& address);
// What can be shown: free coordinates, speeds that are found, measures.
struct MapQuantity {
  std::string name;            // as `design` wants it
  std::string title;           // in words
  std::string unit;            // SI
  std::optional<double> value; // now
  bool followed = false;       // there is a curve on which it keeps a value
};
std::vector<MapQuantity> map_quantities(const Session& session);
// That which is; nothing where there is none.
std::optional<MapQuantity> map_quantity(const Session& session);
// Both parameters, as one step of the history.
void go_to_place(Session& session, const std::array<double, 2>& place);

} // namespace flyball
