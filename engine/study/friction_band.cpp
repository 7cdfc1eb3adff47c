#include "engine/study/friction_band.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/holding.hpp"
#include "engine/study/counted_values.hpp"
#include "engine/study/placed_band.hpp"
#include "engine/study/steady_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t few_points = 5;
constexpr double least_step = 1e-5; // as BranchOptions::largest_step
constexpr int way_parts = 4;        // of a way to a corner, looked at on the way
constexpr int most_sweeps = 40;     // of all shares, one after the other
constexpr double no_gain = 1e-16;   // of an output's size, in a sweep
constexpr int most_crest_steps = 60;
constexpr std::size_t most_outputs = 128;
constexpr Index most_shares_around = 6;

std::vector<FreeNumber> all_shares(const Mechanism& mechanism) {
  std::vector<FreeNumber> free;
  for (const CoordinateReference& at : find_frictions(mechanism))
    free.push_back({share_address(mechanism, at), -1, 1});
  return free;
}

// Names of what is told of a solution: numbers that are found, then measures.
std::vector<std::string> told(const Mechanism& mechanism, const Solution& solution) {
  std::vector<std::string> names;
  for (const CoordinateSolution& c : solution.coordinates)
    if (const auto number = found_number(c); number && !c.dependent) names.push_back(number->name);
  for (const NamedMeasure& measure : mechanism.measures)
    names.push_back(measure.name);
  return names;
}

// States over the box of shares, by what was found on the ways there.
class Box {
 public:
  Box(const Mechanism& mechanism, std::span<const FreeNumber> free, std::vector<std::string> names,
      const std::atomic<bool>* cancel)
      : outputs_(static_cast<Index>(names.size())), map_(mechanism, free, std::move(names), cancel) {
    map_.count_turns();
  }

  struct Place {
    SteadyMap::State state;
    MatrixXd rates; // of the outputs with the shares
  };

  // False where there is no state to begin with, or nothing has a rate there.
  bool begin(const std::vector<std::pair<std::string, double>>& start) {
    Solution first;
    std::optional<SteadyMap::State> state = map_.begin(start, first);
    if (!state || !map_.find_rates(*state)) return false;
    add(*state);
    return true;
  }

  const Place& first() const { return places_.front(); }
  const std::vector<Place>& places() const { return places_; }
  bool lost() const { return lost_; }
  bool jumps(Index output) const { return map_.jumps(static_cast<std::size_t>(output)); }
  std::string unit(Index output) const { return map_.unit(static_cast<std::size_t>(output)); }

  // What lengths are measured by.
  double reach() const {
    for (Index i = 0; i < outputs_; ++i)
      if (const auto scale = map_.scale(static_cast<std::size_t>(i)); scale && unit(i) == "m") return *scale;
    return 1;
  }

  // Of all outputs at a place: as a solve estimates it, not numbers where it does not.
  VectorXd errors(const Place& place) {
    const Solution solution = map_.solution(place.state, true);
    VectorXd out = VectorXd::Constant(place.state.values.size(), std::numeric_limits<double>::quiet_NaN());
    Index i = 0;
    for (const CoordinateSolution& c : solution.coordinates)
      if (const auto number = found_number(c); number && !c.dependent && i < out.size())
        out[i++] = number->error;
    for (const MeasureSolution& measure : solution.measures)
      if (i < out.size()) out[i++] = measure.error.value_or(std::numeric_limits<double>::quiet_NaN());
    return out;
  }

  // The place at the shares p, or the last on the straight way there. Whether it is there.
  std::pair<Place, bool> go(Place from, const VectorXd& p) { // a copy: add() may move all places
    const auto known = std::ranges::find_if(places_, [&](const Place& place) { return place.state.p == p; });
    if (known != places_.end()) return {*known, true};
    SteadyMap::State state = from.state;
    Place last = from;
    bool there = true;
    for (int part = 1; part <= way_parts && there; ++part) {
      const VectorXd to =
          part == way_parts ? p : VectorXd(from.state.p + part * (p - from.state.p) / way_parts);
      there = map_.walk_to(state, to);
      if (!map_.find_rates(state)) continue;
      add(state);
      last = places_.back();
    }
    if (!there) lost_ = true;
    return {last, there && last.state.p == p};
  }

  // The place beyond which no rate of the output, times `sense`, leads up. Of one share the highest on the
  // ways to its ends, along which the output may go up and down; of several from the best that is known.
  // `left` is what further sweeps of these would add, estimated.
  Place climb(Index output, double sense, double& left) {
    left = 0;
    Place at = *std::ranges::max_element(
        places_, {}, [&](const Place& place) { return sense * place.state.values[output]; });
    if (at.state.p.size() == 1) return highest_along(output, sense, at);
    double before = 0;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      bool moved = false;
      const double from = at.state.values[output];
      for (Index j = 0; j < at.state.p.size(); ++j)
        moved = climb_along(output, sense, j, at) || moved;
      const double gain = std::abs(at.state.values[output] - from), ratio = before > 0 ? gain / before : 0;
      left = ratio < 1 ? gain * ratio / (1 - ratio) : gain;
      if (!moved || gain <= no_gain * size_of(output, at)) break;
      before = gain;
    }
    return at;
  }

  // To the corner to which the rates at the first place point; of one share to both ends.
  void go_to_corner(Index output, double sense) {
    const Place from = places_.front();
    VectorXd p = from.state.p;
    for (Index j = 0; j < p.size(); ++j)
      if (const double rate = sense * from.rates(output, j); rate != 0 || p.size() == 1)
        p[j] = (rate != 0 ? rate : sense) > 0 ? 1 : -1;
    go(from, p);
  }

  // To all corners and to the middles of all faces, of not too many shares: whether the balance folds
  // between.
  void look_around() {
    const Place from = places_.front();
    const Index n = from.state.p.size();
    if (n > most_shares_around) return;
    for (int corner = 0; corner < 1 << n; ++corner) {
      VectorXd p(n);
      for (Index j = 0; j < n; ++j)
        p[j] = (corner >> j) & 1 ? 1 : -1;
      go(from, p);
    }
    for (Index j = 0; j < n; ++j)
      for (const double side : {-1., 1.})
        go(from, side * VectorXd::Unit(n, j));
  }

 private:
  void add(const SteadyMap::State& state) { places_.push_back({state, map_.rates()}); }

  static double size_of(Index output, const Place& at) {
    return std::abs(at.state.values[output]) + at.rates.row(output).lpNorm<Eigen::Infinity>();
  }

  Place highest_along(Index output, double sense, const Place& known) {
    std::vector<Place> line = places_;
    std::ranges::sort(line, {}, [](const Place& place) { return place.state.p[0]; });
    Place best = known;
    for (std::size_t i = 1; i < line.size(); ++i) {
      if (!(sense * line[i - 1].rates(output, 0) > 0) || !(sense * line[i].rates(output, 0) < 0)) continue;
      const Place top = crest(output, 0, line[i - 1], line[i]);
      if (sense * (top.state.values[output] - best.state.values[output]) > 0) best = top;
    }
    return best;
  }

  // Along one share, as far as the output grows. Whether that is anywhere.
  bool climb_along(Index output, double sense, Index j, Place& at) {
    const double rate = sense * at.rates(output, j);
    VectorXd end = at.state.p;
    end[j] = rate > 0 ? 1 : -1;
    if (!(std::abs(rate) > 1e-9 * size_of(output, at)) || end == at.state.p) return false;
    const auto [beyond, there] = go(at, end);
    if (beyond.state.p == at.state.p) return false;
    if (sense * beyond.rates(output, j) * rate >= 0) {
      if (!(sense * (beyond.state.values[output] - at.state.values[output]) > 0)) {
        lost_ = true; // it led down between: past a fold, or a dip
        return false;
      }
      at = beyond;
      return there;
    }
    const Place top = crest(output, j, at, beyond);
    const bool moved = std::abs(top.state.p[j] - at.state.p[j]) > 1e-9;
    at = top;
    return moved;
  }

  // Where the rate with the share j has a root, between two places at which its signs differ. The output is
  // flat there, so that half its digits do.
  Place crest(Index output, Index j, const Place& low, const Place& high) {
    const double at_low = low.rates(output, j), at_high = high.rates(output, j);
    const double flat = 1e-12 * std::max(std::abs(at_low), std::abs(at_high));
    RootBracket bracket(low.state.p[j], at_low, high.state.p[j], at_high);
    Place middle = low;
    for (int i = 0; i < most_crest_steps && bracket.width() > 1e-8; ++i) {
      interruption_point();
      VectorXd p = middle.state.p;
      p[j] = bracket.next();
      if (!map_.walk_to(middle.state, p) || !map_.find_rates(middle.state)) break;
      middle.rates = map_.rates();
      const double rate = middle.rates(output, j);
      if (!(std::abs(rate) > flat)) break;
      bracket.take(p[j], rate);
    }
    return middle;
  }

  Index outputs_;
  SteadyMap map_;
  std::vector<Place> places_;
  bool lost_ = false;
};

// The largest value, times `sense`, along a branch between the points beside `i`, where its share goes one
// way from one to the other; nothing where it turns back or the states there are singular.
std::optional<double> crest_beside(const Mechanism& mechanism, const FreeNumber& share,
                                   const std::vector<ResponsePoint>& points, std::size_t i,
                                   const std::string& name, double sense, const std::atomic<bool>* cancel) {
  const ResponsePoint &before = points[i - 1], &after = points[i + 1];
  if ((points[i].parameter - before.parameter) * (after.parameter - points[i].parameter) <= 0) return {};
  Mechanism at = mechanism;
  set_parameter(at, share.address, before.parameter);
  Box box(at, std::span(&share, 1), {name}, cancel);
  if (!box.begin(start_values(before.coordinates)) || !box.first().rates.allFinite()) return {};
  const auto [last, there] = box.go(box.first(), VectorXd::Constant(1, after.parameter));
  if (!there) return {};
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

// Takes out what jumps: it has values between its extremes that no state has, or more than one.
void drop_jumping(const std::vector<std::string>& jumping, FrictionBand& band) {
  if (jumping.empty()) return;
  std::erase_if(band.extents, [&](const BandExtent& extent) {
    return std::ranges::find(jumping, extent.name) != jumping.end();
  });
  band.message += std::string(band.message.empty() ? "" : " ") + "No extent is told of " +
                  word_list(std::vector<std::string_view>(jumping.begin(), jumping.end()), "and") +
                  ", which jumps within the band.";
}

// Whether values along a branch change between two points by far more than before and after.
bool jumps_along(const std::vector<double>& values) {
  constexpr double far_more = 4;
  const auto change = [&](std::size_t i) { return std::abs(values[i + 1] - values[i]); };
  for (std::size_t i = 1; i + 2 < values.size(); ++i)
    if (change(i) > far_more * (change(i - 1) + change(i + 1)) + 1e-9 * std::abs(values[i])) return true;
  return false;
}

// The extents over all that hangs together along one share, folds included.
bool follow(const Mechanism& mechanism, const FreeNumber& share, const Solution& state,
            const std::atomic<bool>* cancel, FrictionBand& band) {
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
  if (!diagram) return false;
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
  drop_jumping(jumping, band);
  return true;
}

// That nothing resists, not even friction.
std::string loose_joints(const Mechanism& mechanism, const Solution& state) {
  std::vector<std::string_view> names;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  for (const std::string& name : state.neutral)
    if (std::ranges::none_of(frictions, [&](CoordinateReference at) {
          return joint_of(mechanism, at).name == name ||
                 coordinate_name(joint_of(mechanism, at), at.coordinate) == name;
        }))
      names.push_back(name);
  return word_list(names, "and");
}

} // namespace

FrictionBand find_friction_band(const Mechanism& mechanism, const FrictionBandOptions& options) {
  FrictionBand band;
  const std::vector<FreeNumber> free = all_shares(mechanism);
  const Interruptible scope(options.cancel);
  try {
    const Solution state = steady_state_near(mechanism, options.start, options.cancel);
    if (state.status != Status::converged || !state.frictions.empty()) {
      band.message = state.message;
      return band;
    }
    const std::vector<std::string> names = told(mechanism, state);
    if (names.empty() || names.size() > most_outputs) {
      band.message = names.empty() ? "There is nothing that could move."
                                   : "Bands of more than " + std::to_string(most_outputs) +
                                         " coordinates and measures are not looked for.";
      return band;
    }
    std::optional<Holding> holding;
    if (free.size() > 1 || state.stable == false)
      holding = find_holding(mechanism, start_values(state.coordinates), options.cancel);
    if (state.stable == false && holding->rest_stable == false) {
      band.message =
          "Friction does not hold it: it is unstable, and what is free beside the joints that have "
          "friction leaves it.";
      return band;
    }
    Box box(mechanism, free, names, options.cancel);
    const auto by_places = [&]() -> FrictionBand {
      if (!options.past_folds) return {};
      const std::vector<std::size_t> independent =
          holding ? holding->independent : std::vector<std::size_t>{0};
      return find_placed_band(mechanism, state, names, independent, box.reach(), options.cancel);
    };
    if (!box.begin(start_values(state.coordinates))) {
      if (FrictionBand placed = by_places(); placed.found) return placed;
      const std::string loose = loose_joints(mechanism, state);
      band.message =
          loose.empty()
              ? "The state is singular, so that nothing tells how far friction would let it be moved."
              : "No band is told: nothing resists " + loose + ", whatever friction does.";
      return band;
    }
    const auto count = static_cast<Index>(names.size());
    const auto measured = [&](Index i) {
      const auto& name = names[static_cast<std::size_t>(i)];
      const auto measure = std::ranges::find(state.measures, name, &MeasureSolution::name);
      if (measure != state.measures.end() && !measure->value) return false;
      return std::isfinite(box.first().state.values[i]) && box.first().rates.row(i).allFinite();
    };
    for (Index i = 0; i < count; ++i)
      for (const double sense : {1., -1.})
        if (measured(i)) box.go_to_corner(i, sense);
    const bool one_motion = free.size() == 1 || holding->independent.size() == 1;
    if (!one_motion) box.look_around();
    std::vector<std::string> frictional, jumping;
    for (const CoordinateReference& at : find_frictions(mechanism))
      frictional.push_back(
          coordinate_name(mechanism.joints[static_cast<std::size_t>(at.joint)], at.coordinate));
    const auto shares = [](const VectorXd& p) { return std::vector<double>(p.begin(), p.end()); };
    for (Index i = 0; i < count; ++i) {
      if (!measured(i)) continue;
      double below = 0, above = 0;
      const Box::Place low = box.climb(i, -1, below), high = box.climb(i, 1, above);
      const std::string& name = names[static_cast<std::size_t>(i)];
      if (box.jumps(i)) jumping.push_back(name);
      std::optional<double> error;
      if (options.errors)
        if (const double worst = std::max(box.errors(low)[i] + below, box.errors(high)[i] + above);
            std::isfinite(worst))
          error = worst;
      const bool stands = one_motion && std::ranges::find(frictional, name) != frictional.end();
      band.extents.push_back({name, box.unit(i), box.first().state.values[i], low.state.values[i],
                              high.state.values[i], error, shares(low.state.p), shares(high.state.p), stands,
                              state.stable, state.stable});
    }
    band.found = true;
    band.whole = !box.lost();
    // Folds about an unstable state may lie between all ways that were gone.
    if (!one_motion && state.stable == false)
      if (FrictionBand placed = by_places(); placed.found) return placed;
    if (!band.whole && free.size() == 1 && follow(mechanism, free.front(), state, options.cancel, band)) {
      band.folds = true;
      return band;
    }
    if (!band.whole)
      if (FrictionBand placed = by_places(); placed.found) return placed;
    if (band.whole) {
      band.message = free.size() > 1 ? "Each extent is an extremum nearby: rates tell of none beyond." : "";
    } else {
      band.message = "Within the limits of friction the balance folds: the band is told up to there, and a "
                     "push may make it jump.";
      if (free.size() > 1)
        band.message +=
            " Friction may hold it beyond: with several joints that have some that is not followed.";
    }
    drop_jumping(jumping, band);
  } catch (const Interrupted&) {
    band = {};
    band.message = "Cancelled.";
  }
  return band;
}

} // namespace flyball
