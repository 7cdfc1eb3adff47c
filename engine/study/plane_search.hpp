// Gathers curves in a plane of two parameters: lines across it on which starts are looked for, and the curve
// through each that is not known yet.
#pragma once

#include "engine/study/plane_tracer.hpp"

#include <chrono>
#include <functional>

namespace flyball {

class PlaneSearch {
 public:
  // Throws SceneError for an address that does not exist. What is passed must outlive this.
  PlaneSearch(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
              const PlaneOptions& options);

  // Lines across the plane on which starts are looked for.
  struct Line {
    int varied = 0; // 0: x moves and y stays
    double value = 0;
  };
  const System& system() const { return system_; }
  bool cancelled() const { return options_.cancel && options_.cancel->load(std::memory_order_relaxed); }
  const PlaneAxis& moving(const Line& line) const { return line.varied == 0 ? x_ : y_; }
  Mechanism on(const Line& line) const;
  // Until it is cancelled; what was found until then stays.
  void for_lines(const std::function<void(const Line&)>& search);
  // Of following the branches along the line that is searched: a part of the whole.
  ReportProgress along_line() const;
  // The branches along a line, of which the search has heard.
  ResponseDiagram branches(const Line& line, bool eigenvalues);

  ExtendedBalance balance(std::vector<Condition> conditions, bool unfolded = false,
                          std::optional<AngleTies> ties = {}) const;
  // Of states that stand turned, where they are the same all over the plane.
  std::optional<AngleTies> ties() const;
  // Whether a state on a line stands turned: what turns at found speeds otherwise than drawn.
  bool stands_turned(const Line& line, double varied,
                     const std::vector<CoordinateSolution>& coordinates) const;
  // Ends the search where such states are met and there are no ties of them.
  void refuse_turned();

  // The curve through a point on a line, if it is not known yet; `pair` as in ExtendedState. Nothing where
  // there is none, or it is.
  struct Added {
    const TracedCurve& traced;
    PlaneCurve& curve;
  };
  std::optional<Added> add(ExtendedBalance& balance, PlaneCurveType type, const Line& line, double varied,
                           const std::vector<CoordinateSolution>& coordinates, double pair = 0);
  // What there is to say of a state on a curve, with or without its eigenvalues.
  static ResponsePoint response(ExtendedBalance& balance, const ExtendedState& state, bool eigenvalues);
  static PlanePoint point(ExtendedBalance& balance, PlaneCurveType type, const ExtendedState& state);

  // Counts a start that is not followed for the size of the system, or as nothing follows from it.
  void leave_out() { ++left_out_; }
  void give_up() { ++not_followed_; }

  void heard(Status status, const std::string& message);
  // `what` there are curves of; `left_out`, what is said after how many starts were left out.
  PlaneCurves finish(const std::string& what, const std::string& left_out = "");

 private:
  double part_before() const { return static_cast<double>(line_) / static_cast<double>(lines_.size()); }
  Mechanism at_corner() const;
  void add_present(const Line& line, const BranchOptions& follow, ResponseDiagram& diagram) const;

  const Mechanism& mechanism_;
  const PlaneAxis &x_, &y_;
  const PlaneOptions& options_;
  std::chrono::steady_clock::time_point begin_;
  System system_;
  std::vector<Line> lines_;
  std::size_t line_ = 0;                // that is searched
  int left_out_ = 0, not_followed_ = 0; // starts
  std::vector<TracedCurve> traced_;
  PlaneCurves out_;
  std::string refusal_;
};

} // namespace flyball
