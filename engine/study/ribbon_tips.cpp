#include "engine/study/ribbon_tips.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Beside the fold on its branch, where the branch turns back nearest to it, but not the fold itself; null
// where it does not.
const ResponsePoint* beside_fold(const ResponseBranch& branch, double fold) {
  const std::vector<ResponsePoint>& points = branch.points;
  const ResponsePoint* out = nullptr;
  double nearest = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double before = points[i].parameter - points[i - 1].parameter,
                 after = points[i + 1].parameter - points[i].parameter,
                 away = std::abs(points[i].parameter - fold);
    if (before * after >= 0 || (out && away >= nearest)) continue;
    constexpr double singular = 1e-3; // of the way to the point before
    out = &points[away > singular * std::abs(points[i - 1].parameter - fold) ? i : i - 1];
    nearest = away;
  }
  return out;
}

// The limit at which both edges of the band about a state are, as they are beside a fold; nothing where they
// are at different ones. The state at one of the edges.
std::optional<std::pair<double, ResponsePoint>> edge_beside_fold(const Mechanism& at,
                                                                 const std::string& share,
                                                                 const ResponsePoint& state,
                                                                 const BranchOptions& options) {
  ResponsePoint begin = state;
  begin.parameter = get_parameter(at, share);
  const auto found = follow_branches_through(at, share, -1, 1, begin, options);
  if (!found || found->branches.empty()) return std::nullopt;
  const std::vector<ResponsePoint>& points = found->branches.front().points;
  const double first = points.front().parameter, last = points.back().parameter;
  constexpr double rounding = 1e-9; // of a share
  if (points.size() < 2 || std::abs(first - last) > rounding || std::abs(std::abs(first) - 1) > rounding)
    return std::nullopt;
  return std::pair(std::copysign(1., first), points.front());
}

double distance(const ResponsePoint& a, const ResponsePoint& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    sum += std::abs(value_difference(a.coordinates[i], b.coordinates[i]));
  return sum;
}

// A state at an edge, and those along that from it in the sense in which the fold looks, outwards: to where
// the edge turns back, or the range ends.
std::vector<RibbonPlace> places_beyond(const ResponsePoint& begin, const std::vector<ResponsePoint>& edge,
                                       double sense) {
  const auto count = static_cast<std::ptrdiff_t>(edge.size());
  const std::ptrdiff_t nearest =
      std::ranges::min_element(edge, {}, [&](const ResponsePoint& point) { return distance(point, begin); }) -
      edge.begin();
  const auto outwards = [&](std::ptrdiff_t i) {
    return sense * edge[static_cast<std::size_t>(std::clamp(i, std::ptrdiff_t{0}, count - 1))].parameter;
  };
  const std::ptrdiff_t step = outwards(nearest + 1) > outwards(nearest - 1) ? 1 : -1;
  std::vector<RibbonPlace> places{{begin.parameter, start_values(begin.coordinates)}};
  for (std::ptrdiff_t i = nearest; i >= 0 && i < count; i += step) {
    const ResponsePoint& point = edge[static_cast<std::size_t>(i)];
    if (sense * (point.parameter - places.back().number) > 0)
      places.push_back({point.parameter, start_values(point.coordinates)});
    else if (i != nearest)
      break;
  }
  return places;
}

} // namespace

std::vector<std::vector<RibbonPoint>> ribbon_tips(const Mechanism& mechanism, const std::string& address,
                                                  double from, double to, const ResponseDiagram& diagram,
                                                  const std::atomic<bool>* cancel) {
  std::vector<std::vector<RibbonPoint>> tips;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  if (frictions.size() != 1) return tips;
  const std::string share = share_address(mechanism, frictions.front());
  BranchOptions options;
  options.eigenvalues = options.switch_branches = false;
  options.cancel = cancel;
  try {
    for (const SpecialPoint& fold : diagram.special) {
      if (fold.type != SpecialPointType::fold) continue;
      const ResponseBranch& branch = diagram.branches[static_cast<std::size_t>(fold.branch)];
      const ResponsePoint* beside = beside_fold(branch, fold.at.parameter);
      if (!beside || !beside->frictions.empty()) continue;
      const auto edge =
          edge_beside_fold(with_parameter(mechanism, address, beside->parameter), share, *beside, options);
      if (!edge) continue;
      const Mechanism at_limit = with_parameter(mechanism, share, edge->first);
      ResponsePoint begin = edge->second;
      begin.parameter = beside->parameter;
      const auto found = follow_branches_through(at_limit, address, from, to, begin, options);
      if (!found || found->branches.empty()) continue;
      const double sense = fold.at.parameter > beside->parameter ? 1 : -1;
      std::vector<RibbonPoint> tip = friction_ribbon(
          at_limit, address, places_beyond(begin, found->branches.front().points, sense), cancel);
      if (tip.size() > 1) tips.push_back(std::move(tip));
    }
  } catch (const Interrupted&) { // what was found stays
  }
  return tips;
}

} // namespace flyball
