#include "engine/study/fold_curve.hpp"

#include "engine/continuation/extended_balance.hpp"
#include "engine/study/design.hpp"
#include "engine/study/plane_search.hpp"
#include "engine/study/wanted.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Curves of crossings go by matrices, with four factorizations for each coordinate a step.
constexpr int largest_for_crossings = 100;

} // namespace

PlaneCurves fold_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                        const PlaneOptions& options) {
  PlaneSearch plane(mechanism, x, y, options);
  const std::optional<AngleTies> ties = plane.ties();
  ExtendedBalance folds = plane.balance({balance_is_singular()});
  plane.for_lines([&](const PlaneSearch::Line& line) {
    const PlaneAxis& along = plane.moving(line);
    const ResponseDiagram d = plane.branches(line, false);
    if (d.turned && !ties) return plane.refuse_turned();
    ExtendedBalance crossings =
        plane.balance({balance_is_singular(), branches_cross(static_cast<std::size_t>(line.varied))}, true);
    for (const SpecialPoint& s : d.special) {
      const bool turned = d.turned && d.branches[static_cast<std::size_t>(s.branch)].connected;
      // Where a branch turns back because another crosses it there is no fold.
      const bool at_crossing = std::ranges::any_of(d.special, [&](const SpecialPoint& other) {
        return other.type == SpecialPointType::branch_point &&
               std::abs(other.at.parameter - s.at.parameter) < 1e-6 * (along.to - along.from);
      });
      if (s.type == SpecialPointType::fold && !at_crossing && turned) {
        ExtendedBalance of_turned = plane.balance({balance_is_singular()}, false, ties);
        plane.add(of_turned, PlaneCurveType::fold, line, s.at.parameter, s.at.coordinates);
      } else if (s.type == SpecialPointType::fold && !at_crossing) {
        plane.add(folds, PlaneCurveType::fold, line, s.at.parameter, s.at.coordinates);
      } else if (s.type == SpecialPointType::branch_point && turned) {
        plane.give_up();
      } else if (s.type == SpecialPointType::branch_point && plane.system().nv > largest_for_crossings) {
        plane.leave_out();
      } else if (s.type == SpecialPointType::branch_point) {
        plane.add(crossings, PlaneCurveType::branch_point, line, s.at.parameter, s.at.coordinates);
      }
    }
  });
  return plane.finish("fold or crossing", "Curves of crossings are followed up to " +
                                              std::to_string(largest_for_crossings) +
                                              " coordinates; branches cross");
}

PlaneCurves value_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                         const std::string& name, double value, const PlaneOptions& options) {
  PlaneSearch plane(mechanism, x, y, options);
  const Wanted wanted = find_wanted(mechanism, plane.system(), name);
  const std::optional<AngleTies> ties = plane.ties();
  plane.for_lines([&](const PlaneSearch::Line& line) {
    const PlaneAxis& along = plane.moving(line);
    DesignOptions ask;
    ask.all = options.all;
    ask.largest_step = options.largest_step;
    ask.cancel = options.cancel;
    ask.progress = plane.along_line();
    const DesignAnswer answer = design(plane.on(line), along.address, along.from, along.to, name, value, ask);
    // Not reaching the value on one line is no failure.
    const bool solved = answer.lowest <= answer.highest && answer.highest != 0;
    plane.heard(solved ? Status::converged : answer.status, answer.message);
    for (const DesignSolution& s : answer.solutions) {
      const bool turned = plane.stands_turned(line, s.parameter, s.at.coordinates);
      if (turned && !ties) return plane.refuse_turned();
      ExtendedBalance balance = plane.balance({wanted_is(wanted, value, answer.lowest, answer.highest)},
                                              false, turned ? ties : std::nullopt);
      plane.add(balance, PlaneCurveType::value, line, s.parameter, s.at.coordinates);
    }
  });
  return plane.finish("such");
}

} // namespace flyball
