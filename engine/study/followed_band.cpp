#include "engine/study/followed_band.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/counted_values.hpp"
#include "engine/study/share_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr std::size_t few_points = 5;
constexpr double least_step = 1e-5; // as BranchOptions::largest_step

// The largest value, times `sense`, along a branch between the points beside `i`, where its share goes one
// way from one to the other; nothing where it turns back or the states there are singular.
std::optional<double> crest_beside(const Mechanism& mechanism, const FreeNumber& share,
                                   const std::vector<ResponsePoint>& points, std::size_t i,
                                   const std::string& name, double sense, const std::atomic<bool>* cancel) {
  const ResponsePoint &before = points[i - 1], &after = points[i + 1];
  if ((points[i].parameter - before.parameter) * (after.parameter - points[i].parameter) <= 0) return {};
  Mechanism at = mechanism;
  set_parameter(at, share.address, before.parameter);
  ShareBox box(at, std::span(&share, 1), {name}, cancel);
  if (!box.begin(start_values(before.coordinates)) || !box.first().rates.allFinite()) return {};
  if (!box.go_to(after.parameter)) return {};
  double left = 0;
  return box.climb(0, sense, left).state.values[0];
}

// Takes into an extent what a branch reaches between its points, whose values are given.
void take_crests(const Mechanism& mechanism, const FreeNumber& share,
                 const std::vector<ResponsePoint>& points, const std::vector<double>& values,
                 const std::atomic<bool>* cancel, BandExtent& extent) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    for (const double sense : {1., -1.}) {
      double& end = sense > 0 ? extent.high : extent.low;
      const double before = sense * (values[i] - values[i - 1]), after = sense * (values[i] - values[i + 1]);
      const double beyond = std::max(before, after); // less than this between them
      if (!(before > 0) || !(after > 0) || !(sense * (values[i] - end) + beyond > 0)) continue;
      const auto crest = crest_beside(mechanism, share, points, i, extent.name, sense, cancel);
      if (!crest) continue;
      // Turns are counted from where its way begins.
      const double top = *crest + values[i - 1] - told_value(points[i - 1], extent.name);
      if (sense * (top - end) > 0) end = top;
    }
}

// Whether values along a branch change between two points by far more than before and after.
bool jumps_along(const std::vector<double>& values) {
  constexpr double far_more = 4;
  const auto change = [&](std::size_t i) { return std::abs(values[i + 1] - values[i]); };
  for (std::size_t i = 1; i + 2 < values.size(); ++i)
    if (change(i) > far_more * (change(i - 1) + change(i + 1)) + 1e-9 * std::abs(values[i])) return true;
  return false;
}

} // namespace

std::optional<std::vector<std::string>> follow_band(const Mechanism& mechanism, const FreeNumber& share,
                                                    const Solution& state, const std::atomic<bool>* cancel,
                                                    FrictionBand& band) {
  BranchOptions options;
  options.eigenvalues = false;
  options.cancel = cancel;
  ResponsePoint point;
  point.parameter = get_parameter(mechanism, share.address);
  point.coordinates = state.coordinates;
  std::optional<ResponseDiagram> diagram;
  do { // a band of a few steps, as beside the end of a tip, would go out of the range within one of them
    auto found = follow_branches_through(mechanism, share.address, share.from, share.to, point, options);
    if (!found || found->branches.empty()) break;
    diagram = std::move(found);
    options.largest_step /= 4;
  } while (diagram->branches.front().points.size() < few_points && options.largest_step > least_step);
  if (!diagram) return std::nullopt;
  // An end that is none of the share's: it goes on, as a pendulum does that friction holds at any angle.
  struct End {
    std::size_t branch, point;
  };
  std::vector<End> open;
  std::string why;
  for (std::size_t b = 0; b < diagram->branches.size(); ++b)
    for (const bool last : {false, true}) {
      const ResponseBranch& branch = diagram->branches[b];
      const ResponsePoint& end = last ? branch.points.back() : branch.points.front();
      // One that was followed off a crossing begins on what is known.
      const std::string& reason = last ? branch.end : branch.begin;
      if (!branch.connected || reason.empty() || reason == closed_branch) continue;
      if (end.parameter == share.from || end.parameter == share.to) continue;
      open.push_back({b, last ? branch.points.size() - 1 : 0});
      why = reason;
    }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<std::string_view> round, farther;
  std::vector<std::string> jumping;
  for (BandExtent& extent : band.extents) {
    extent.low = extent.high = extent.value;
    extent.stable_low = extent.stable_high = state.stable;
    extent.error.reset();
    extent.shares_low.clear();
    extent.shares_high.clear();
    const auto take = [&](double value, const ResponsePoint& at) {
      if (value < extent.low) {
        extent.low = value;
        extent.stable_low = at.stable;
      }
      if (value > extent.high) {
        extent.high = value;
        extent.stable_high = at.stable;
      }
    };
    const CountedValues values = counted_values(mechanism, *diagram, point, extent.name, extent.value);
    if (measure_index(mechanism, extent.name) >= 0 && std::ranges::any_of(values.branches, jumps_along)) {
      jumping.push_back(extent.name);
      continue;
    }
    for (std::size_t b = 0; b < values.branches.size(); ++b)
      for (std::size_t i = 0; i < values.branches[b].size(); ++i)
        take(values.branches[b][i], diagram->branches[b].points[i]);
    for (std::size_t s = 0; s < values.special.size(); ++s)
      take(values.special[s], diagram->special[s].at);
    for (std::size_t b = 0; b < values.branches.size(); ++b)
      if (!values.branches[b].empty())
        take_crests(mechanism, share, diagram->branches[b].points, values.branches[b], cancel, extent);
    const double width = extent.high - extent.low;
    bool unbounded = values.goes_round;
    if (values.goes_round) {
      extent.low = -infinity;
      extent.high = infinity;
    }
    for (const End& end : open) {
      const double value = values.branches[end.branch][end.point];
      if (value == extent.low && width > 0) extent.low = -infinity;
      if (value == extent.high && width > 0) extent.high = infinity;
      unbounded = unbounded || !std::isfinite(extent.low) || !std::isfinite(extent.high);
    }
    const bool turns = extent.unit == "rad" && (values.goes_round || width > 2 * std::numbers::pi);
    if (unbounded) (turns ? round : farther).push_back(extent.name);
  }
  if (!round.empty())
    band.message = "Friction holds it at any angle: " + word_list(round, "and") + " can go round.";
  if (!farther.empty())
    band.message += (band.message.empty() ? "" : " ") + ("Friction holds " + word_list(farther)) +
                    " farther than the band was followed, so that no bound is told: " + why + ".";
  if (band.message.empty()) band.message = "The band passes a fold, beyond which friction alone holds.";
  return jumping;
}

} // namespace flyball
