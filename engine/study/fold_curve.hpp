// Curves in the plane of two parameters: where the equilibria fold, where branches cross, and where a
// coordinate or a measure keeps a value. Traced by pseudo-arclength continuation of the balance together with
// the condition, minimally augmented (Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria,
// 2000, chapters 3 and 4), within a box and both ways.
#pragma once

#include "engine/continuation/branches.hpp"

namespace flyball {

// One parameter of the plane and the range that is looked at (from < to).
struct PlaneAxis {
  std::string address;
  double from = 0, to = 1;
};

enum class PlaneCurveType { fold, branch_point, value };
std::string_view word(PlaneCurveType type);

struct PlanePoint {
  double x = 0, y = 0; // the two parameters
  std::vector<CoordinateSolution> coordinates;
  std::optional<bool> stable; // of curves of a value; a fold is on the edge
};

struct PlaneCurve {
  PlaneCurveType type = PlaneCurveType::fold;
  std::vector<PlanePoint> points;
  std::vector<PlanePoint> cusps; // fold curves: where two folds meet
  bool closed = false;
  std::string begin, end; // why it stops at either end, in words
};

struct PlaneCurves {
  Status status = Status::not_converged; // of the starts: converged even where there is no curve in the box
  std::string message;                   // a sentence
  std::vector<PlaneCurve> curves;
  double run_time_s = 0;
};

struct PlaneOptions {
  double largest_step = 0.02; // scaled: radians, reaches, and parts of the two ranges
  int max_points = 1000;      // a curve
  int max_curves = 32;
  bool all = false; // starts on disconnected branches, too
  // Values of the second parameter at which follow_branches looks for starts; empty: the present one, moved
  // into the range, and both ends.
  std::vector<double> at;
  const std::atomic<bool>* cancel = nullptr;
  ReportProgress progress; // of the lines on which starts are looked for
};

// Fold and branch-point curves through every fold and branch point found at the starting values. Points are
// accurate to rounding (the condition is exact). Throws SceneError for an address that does not exist.
PlaneCurves fold_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                        const PlaneOptions& options = {});

// Curves on which what is wanted (see find_wanted) is `value`, in its SI unit. Throws SceneError for an
// address or a coordinate that does not exist or is driven.
PlaneCurves value_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                         const std::string& name, double value, const PlaneOptions& options = {});

} // namespace flyball
