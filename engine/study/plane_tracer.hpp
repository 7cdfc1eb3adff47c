// Follows the solutions of one balance with its condition through the box of a plane of two parameters:
// pseudo-arclength steps, to the border or to where the curve closes or ends.
#pragma once

#include "engine/continuation/extended_balance.hpp"
#include "engine/study/plane_curves.hpp"

namespace flyball {

// One of the curves, as it is solved for.
struct TracedCurve {
  std::vector<ExtendedState> states;
  std::vector<Eigen::VectorXd> tangents;
  std::vector<ExtendedState> cusps, takens; // PlaneCurve::cusps, takens
  std::string end;
  bool closed = false;
};

class PlaneTracer {
 public:
  PlaneTracer(ExtendedBalance& balance, const PlaneAxis& x, const PlaneAxis& y, PlaneCurveType type,
              const PlaneOptions& options)
      : balance_(balance), low_(x.from, y.from), high_(x.to, y.to), type_(type), options_(options) {}

  // A point of the curve near `state` with parameter `fixed` as it is. False where there is none.
  bool start(ExtendedState& state, int fixed);

  // Both ways from a point of the curve, joined to one; `fixed` is the parameter to move off first. `begin`:
  // why it begins where it does.
  TracedCurve both_ways(const ExtendedState& state, int fixed, std::string& begin);

  bool lies_on(const ExtendedState& state, const TracedCurve& curve);

  // `length` (scaled) further along; the number of iterations, 0 where it fails.
  int step(const ExtendedState& from, const Eigen::VectorXd& tangent, double length, ExtendedState& to);

  // Scaled, from a to b: coordinates, then parameters.
  Eigen::VectorXd difference(const ExtendedState& a, const ExtendedState& b) const;

 private:
  Eigen::VectorXd unit(int parameter) const;
  void prepare(const ExtendedState& state);
  bool finish_step(const ExtendedState& from, ExtendedState& to);
  bool intact(const ExtendedState& s) const { return std::abs(s.unfolding) < 1e-7; }
  Eigen::Vector2d position(const ExtendedState& s) const;
  bool inside(const ExtendedState& s) const;
  TracedCurve follow(ExtendedState state, Eigen::VectorXd tangent);
  bool one_motion(const ExtendedState& s);
  ExtendedState cusp(const ExtendedState& state, const Eigen::VectorXd& tangent, double length);
  bool double_zero(const ExtendedState& state, const Eigen::VectorXd& tangent, double length,
                   ExtendedState& out);
  void land_on_border(const ExtendedState& state, const Eigen::VectorXd& tangent, double length,
                      const ExtendedState& next, TracedCurve& out);

  ExtendedBalance& balance_;
  Eigen::Vector2d low_, high_;
  PlaneCurveType type_;
  const PlaneOptions& options_;
  double pair_scale_ = 0; // 1/s^2: the largest product of the pair so far
};

} // namespace flyball
