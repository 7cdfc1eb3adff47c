#include "engine/study/hopf_curve.hpp"

#include "engine/continuation/crossing_pair.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/study/plane_search.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// A step takes the eigenvalues of two states beside each coordinate.
constexpr int largest_for_pairs = 60;

// Tells of the points of one curve.
class HopfTeller {
 public:
  HopfTeller(ExtendedBalance& balance, const PlaneAxis& x, const PlaneAxis& y, const PlaneOptions& options)
      : balance_(balance), tracer_(balance, x, y, PlaneCurveType::hopf, options), cancel_(options.cancel) {}

  void tell(const TracedCurve& traced, PlaneCurve& curve) {
    for (std::size_t i = 0; i < traced.states.size(); ++i) {
      curve.points[i].hopf = at(traced.states[i]);
      if (!unit_ && curve.points[i].hopf->lyapunov) unit_ = curve.points[i].hopf->coordinate;
    }
    for (std::size_t i = 0; i < traced.takens.size(); ++i)
      curve.takens[i].hopf = at(traced.takens[i]);
    for (std::size_t i = 0; i + 1 < traced.states.size(); ++i)
      find_bautin(traced, i, curve);
  }

 private:
  HopfPoint at(const ExtendedState& state) {
    const double frequency = std::sqrt(std::max(0., state.pair));
    if (cancel_ && cancel_->load(std::memory_order_relaxed)) {
      HopfPoint out;
      out.frequency = frequency;
      out.reason = "cancelled";
      return out;
    }
    const ResponsePoint here = PlaneSearch::response(balance_, state, true);
    return describe_hopf(balance_.mechanism(), here, frequency, unit_);
  }

  // Where the coefficient goes through zero between two points.
  void find_bautin(const TracedCurve& traced, std::size_t i, PlaneCurve& curve) {
    const HopfPoint &first = *curve.points[i].hopf, &last = *curve.points[i + 1].hopf;
    const HopfLoss before = first.loss(), after = last.loss();
    if (before == HopfLoss::undecided || after == HopfLoss::undecided || before == after ||
        first.coordinate != last.coordinate)
      return;
    const double size = std::min(std::abs(*first.lyapunov), std::abs(*last.lyapunov));
    RootBracket bracket(0, *first.lyapunov,
                        traced.tangents[i].dot(tracer_.difference(traced.states[i], traced.states[i + 1])),
                        *last.lyapunov);
    for (int k = 0; k < 60; ++k) {
      const double middle = bracket.next();
      ExtendedState state;
      if (tracer_.step(traced.states[i], traced.tangents[i], middle, state) == 0) return;
      const HopfPoint here = at(state);
      if (!here.lyapunov || here.coordinate != first.coordinate) return;
      const double value = *here.lyapunov;
      if (std::abs(value) <= here.error || bracket.width() < 1e-11) {
        if (!(std::abs(value) < std::max(0.1 * size, here.error))) return; // it goes through infinity
        PlanePoint point = PlaneSearch::point(balance_, PlaneCurveType::hopf, state);
        point.hopf = here;
        curve.bautin.push_back(std::move(point));
        return;
      }
      bracket.take(middle, value);
    }
  }

  ExtendedBalance& balance_;
  PlaneTracer tracer_;
  const std::atomic<bool>* cancel_;
  std::optional<HopfPoint::Coordinate> unit_; // the same one all along, so that the coefficient is continuous
};

} // namespace

PlaneCurves hopf_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                        const PlaneOptions& options) {
  PlaneSearch plane(mechanism, x, y, options);
  std::optional<AngleTies> ties; // of states that stand turned
  plane.for_lines([&](const PlaneSearch::Line& line) {
    const ResponseDiagram diagram = plane.branches(line, true);
    if (diagram.turned && !ties) ties = plane.ties();
    if (diagram.turned && !ties) return plane.refuse_turned();
    for (const SpecialPoint& s : diagram.special) {
      if (s.type != SpecialPointType::hopf || s.at.floquet) continue;
      if (plane.system().nv > largest_for_pairs) {
        plane.leave_out();
        continue;
      }
      const double frequency = hopf_frequency(s.at.eigenvalues);
      if (!(frequency > 0)) continue;
      const bool turned = diagram.turned && diagram.branches[static_cast<std::size_t>(s.branch)].connected;
      if (turned && !ties) continue;
      ExtendedBalance balance = plane.balance({pair_crosses(frequency)}, false, turned ? ties : std::nullopt);
      if (const auto added = plane.add(balance, PlaneCurveType::hopf, line, s.at.parameter, s.at.coordinates,
                                       frequency * frequency))
        HopfTeller(balance, x, y, options).tell(added->traced, added->curve);
    }
  });
  return plane.finish("Hopf", "They are followed up to " + std::to_string(largest_for_pairs) +
                                  " coordinates; pairs cross the axis");
}

} // namespace flyball
