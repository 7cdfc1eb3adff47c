#include "engine/study/ribbon_tips.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/study/counted_values.hpp"

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

// Where the band about a state begins and ends over the share of friction.
struct Edges {
  double limit = 0;         // the share at both ends, as beside a fold; else 0
  bool past_folds = false;  // otherwise: it goes on past folds, to what is beyond
  ResponsePoint state = {}; // at one end, where they are at the same share
};

Edges edges_about(const Mechanism& at, const std::string& share, ResponsePoint state,
                  const BranchOptions& options) {
  state.parameter = get_parameter(at, share);
  const auto found = follow_branches_through(at, share, -1, 1, state, options);
  if (!found || found->branches.empty()) return {};
  const std::vector<ResponsePoint>& points = found->branches.front().points;
  const double first = points.front().parameter, last = points.back().parameter;
  constexpr double rounding = 1e-9; // of a share
  if (points.size() < 2 || std::abs(std::abs(first) - 1) > rounding ||
      std::abs(std::abs(last) - 1) > rounding)
    return {.past_folds = true};
  if (std::abs(first - last) < rounding) return {std::copysign(1., first), false, points.front()};
  return {.past_folds = !found->special.empty()};
}

// A band that goes past a fold, at a number beside that.
struct TipBegin {
  double number = 0;
  Edges edges;
};

// From beside the fold on its branch ever closer to it, as thin friction passes it no earlier: along the
// parabola that the branch is there.
std::optional<TipBegin> begin_of_tip(const Mechanism& mechanism, const std::string& address,
                                     const std::string& share, const ResponsePoint& fold,
                                     const ResponsePoint& beside, const BranchOptions& options) {
  constexpr double closest = 1e-4; // of the way, and its square of that in the number
  ResponsePoint state = beside;
  for (double way = 1; way > closest; way /= 2) {
    state.parameter = std::lerp(fold.parameter, beside.parameter, way * way);
    state.coordinates = coordinates_between(fold.coordinates, beside.coordinates, way);
    const Edges edges =
        edges_about(with_parameter(mechanism, address, state.parameter), share, state, options);
    if (edges.limit != 0) return TipBegin{state.parameter, edges};
    if (edges.past_folds) break;
  }
  return std::nullopt;
}

// Along an edge from one of its states outwards, in the sense in which the fold looks, to where it turns back
// or the range ends.
struct EdgeOutwards {
  std::vector<ResponsePoint> states;
  const SpecialPoint* fold = nullptr; // where it turns back
};

EdgeOutwards follow_outwards(const ResponsePoint& begin, const ResponseDiagram& edge, double sense) {
  const std::vector<ResponsePoint>& points = edge.branches.front().points;
  const auto away = [&](const ResponsePoint& point) {
    return scaled_distance(point.coordinates, begin.coordinates);
  };
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  const std::ptrdiff_t nearest = std::ranges::min_element(points, {}, away) - points.begin();
  const auto outwards = [&](std::ptrdiff_t i) {
    return sense * points[static_cast<std::size_t>(std::clamp(i, std::ptrdiff_t{0}, count - 1))].parameter;
  };
  const std::ptrdiff_t step = outwards(nearest + 1) > outwards(nearest - 1) ? 1 : -1;
  EdgeOutwards out{{begin}};
  for (std::ptrdiff_t i = nearest; i >= 0 && i < count; i += step) {
    const ResponsePoint& point = points[static_cast<std::size_t>(i)];
    if (sense * (point.parameter - out.states.back().parameter) > 0) {
      out.states.push_back(point);
      continue;
    }
    if (i == nearest) continue;
    // Between two points about the turn lies its fold.
    const auto from_turn = [&](const SpecialPoint& fold) {
      return scaled_distance(fold.at.coordinates, out.states.back().coordinates) +
             scaled_distance(fold.at.coordinates, point.coordinates);
    };
    for (const SpecialPoint& special : edge.special)
      if (special.type == SpecialPointType::fold && special.branch == 0 &&
          (!out.fold || from_turn(special) < from_turn(*out.fold)))
        out.fold = &special;
    break;
  }
  return out;
}

// Those states, and where they lie far apart others between: with the square root of the way to the fold, as
// the edge goes there.
std::vector<RibbonPlace> places_along(const EdgeOutwards& edge) {
  constexpr double parts = 8; // of the whole way
  std::vector<RibbonPlace> places;
  const auto add = [&](double number, const std::vector<CoordinateSolution>& coordinates) {
    places.push_back({number, start_values(coordinates)});
  };
  add(edge.states.front().parameter, edge.states.front().coordinates);
  const auto to_fold = [&](const ResponsePoint& point) {
    return std::sqrt(std::abs(edge.fold->at.parameter - point.parameter));
  };
  for (std::size_t i = 1; i <= edge.states.size(); ++i) {
    const ResponsePoint& from = edge.states[i - 1];
    if (i == edge.states.size() && !edge.fold) break;
    const ResponsePoint& to = i < edge.states.size() ? edge.states[i] : edge.fold->at;
    if (edge.fold) {
      const double end = edge.fold->at.parameter, first = to_fold(from), last = to_fold(to);
      const double steps = std::ceil(parts * (first - last) / to_fold(edge.states.front()));
      for (double k = 1; k < steps; ++k) {
        const double left = std::lerp(first, last, k / steps);
        add(end + std::copysign(left * left, from.parameter - end),
            coordinates_between(from.coordinates, to.coordinates, k / steps));
      }
    }
    if (i < edge.states.size()) add(to.parameter, to.coordinates);
  }
  return places;
}

// Where both edges have come together.
RibbonPoint closed_end(const RibbonPoint& before, const ResponsePoint& fold) {
  RibbonPoint out = before;
  out.number = fold.parameter;
  for (BandExtent& extent : out.extents)
    extent.value = extent.low = extent.high = told_value(fold, extent.name);
  return out;
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
      const auto begins = begin_of_tip(mechanism, address, share, fold.at, *beside, options);
      if (!begins) continue;
      const Mechanism at_limit = with_parameter(mechanism, share, begins->edges.limit);
      ResponsePoint begin = begins->edges.state;
      begin.parameter = begins->number;
      const auto found = follow_branches_through(at_limit, address, from, to, begin, options);
      if (!found || found->branches.empty()) continue;
      const EdgeOutwards edge =
          follow_outwards(begin, *found, fold.at.parameter > beside->parameter ? 1 : -1);
      std::vector<RibbonPoint> tip = friction_ribbon(at_limit, address, places_along(edge), cancel);
      if (edge.fold && !tip.empty() && !tip.back().extents.empty())
        tip.push_back(closed_end(tip.back(), edge.fold->at));
      if (tip.size() > 1) tips.push_back(std::move(tip));
    }
  } catch (const Interrupted&) { // what was found stays
  }
  return tips;
}

} // namespace flyball
