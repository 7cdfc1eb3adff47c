// Curves in the plane of two parameters: what is asked of them, and what is found.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/study/hopf_point.hpp"

namespace flyball {

// One parameter of the plane and the range that is looked at (from < to).
struct PlaneAxis {
  std::string address;
  double from = 0, to = 1;
};

enum class PlaneCurveType { fold, branch_point, value, hopf };
std::string_view word(PlaneCurveType type);

struct PlanePoint {
  double x = 0, y = 0; // the two parameters
  std::vector<CoordinateSolution> coordinates;
  std::optional<bool> stable;      // of curves of a value; a fold is on the edge
  std::optional<HopfPoint> hopf{}; // of Hopf curves
};

struct PlaneCurve {
  PlaneCurveType type = PlaneCurveType::fold;
  std::vector<PlanePoint> points;
  std::vector<PlanePoint> cusps; // fold curves: where two folds meet
  // Hopf curves: where soft turns into hard (Bautin), the Lyapunov coefficient being zero; where the
  // frequency goes to zero (Bogdanov and Takens) and the curve ends on a fold or a crossing.
  std::vector<PlanePoint> bautin{}, takens{};
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

} // namespace flyball
