#include "engine/study/share_box.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/root_bracket.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int way_parts = 4;         // of a way, looked at on the way
constexpr int most_sweeps = 40;      // of all shares, one after the other
constexpr double no_gain = 1e-16;    // of an output's size, in a sweep
constexpr double other_state = 1e-5; // rad or reaches
constexpr int most_crest_steps = 60;
constexpr Index most_shares_around = 6; // of which all corners are looked at

double size_of(Index output, const ShareBox::Place& at) {
  return std::abs(at.state.values[output]) + at.rates.row(output).lpNorm<Eigen::Infinity>();
}

} // namespace

ShareBox::ShareBox(const Mechanism& mechanism, std::span<const FreeNumber> shares,
                   std::vector<std::string> outputs, const std::atomic<bool>* cancel)
    : outputs_(static_cast<Index>(outputs.size())), map_(mechanism, shares, std::move(outputs), cancel) {
  map_.keep_to_branch();
}

bool ShareBox::begin(const std::vector<std::pair<std::string, double>>& start) {
  Solution first;
  std::optional<SteadyMap::State> state = map_.begin(start, first);
  if (!state || !map_.find_rates(*state)) return false;
  add({std::move(*state), map_.rates()});
  return true;
}

double ShareBox::reach() const {
  for (Index i = 0; i < outputs_; ++i)
    if (const auto scale = map_.scale(static_cast<std::size_t>(i)); scale && unit(i) == "m") return *scale;
  return 1;
}

VectorXd ShareBox::errors(const Place& place) {
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

void ShareBox::go_to_corner(Index output, double sense) {
  const Place from = places_.front();
  VectorXd p = from.state.p;
  for (Index j = 0; j < p.size(); ++j)
    if (const double rate = sense * from.rates(output, j); rate != 0 || p.size() == 1)
      p[j] = (rate != 0 ? rate : sense) > 0 ? 1 : -1;
  go(from, p);
}

bool ShareBox::go_to(double share) {
  return go(places_.front(), VectorXd::Constant(1, share)).there;
}

void ShareBox::look_around() {
  const Place from = places_.front();
  const Index n = from.state.p.size();
  if (n > most_shares_around) return;
  std::vector<std::optional<Place>> corners;
  for (unsigned corner = 0; corner < 1U << n; ++corner) {
    VectorXd p(n);
    for (Index j = 0; j < n; ++j)
      p[j] = (corner >> j) & 1U ? 1 : -1;
    const Way& way = go(from, p);
    corners.push_back(way.there ? std::optional(way.places.back()) : std::nullopt);
    if (way.there) climb_starts_.push_back(way.places.back());
  }
  for (Index j = 0; j < n; ++j)
    for (const double side : {-1., 1.})
      if (const Way& way = go(from, side * VectorXd::Unit(n, j)); way.there)
        climb_starts_.push_back(way.places.back());
  for (unsigned corner = 0; corner < 1U << n; ++corner)
    for (Index j = 0; j < n && !lost_; ++j)
      if (const unsigned other = corner | (1U << j); other != corner && corners[corner] && corners[other])
        go(*corners[corner], corners[other]->state.p);
}

ShareBox::Place ShareBox::climb(Index output, double sense, double& left) {
  left = 0;
  if (first().state.p.size() == 1) return highest_along(output, sense);
  Place at = best_known(output, sense);
  // What rises to one corner may be higher beside another, so that one sweep is made from each from which
  // rates lead higher.
  for (Place other : std::vector<Place>(climb_starts_)) {
    double led = sense * other.state.values[output];
    for (Index j = 0; j < other.state.p.size(); ++j)
      if (const double rate = sense * other.rates(output, j); rate != 0)
        led += std::abs(rate) * ((rate > 0 ? 1 : -1) - other.state.p[j]) * (rate > 0 ? 1 : -1);
    if (!(led > sense * at.state.values[output])) continue;
    sweep(output, sense, other);
    if (sense * (other.state.values[output] - at.state.values[output]) > 0) at = std::move(other);
  }
  double before = 0;
  for (int i = 0; i < most_sweeps; ++i) {
    const double from = at.state.values[output];
    const bool moved = sweep(output, sense, at);
    const double gain = std::abs(at.state.values[output] - from), ratio = before > 0 ? gain / before : 0;
    left = ratio < 1 ? gain * ratio / (1 - ratio) : gain;
    if (!moved || gain <= no_gain * size_of(output, at)) break;
    before = gain;
  }
  return at;
}

// The way to the shares p, and all places on it that are not known.
const ShareBox::Way& ShareBox::go(const Place& from, const VectorXd& p) {
  for (const Way& way : ways_)
    if (way.to == p && way.from == from.state.p) return way;
  Way way{from.state.p, p, {from}, true};
  SteadyMap::State state = from.state;
  for (int part = 1; part <= way_parts && way.there; ++part) {
    const VectorXd to = part == way_parts ? p : VectorXd(way.from + part * (p - way.from) / way_parts);
    way.there = map_.walk_to(state, to);
    if (!map_.find_rates(state)) continue;
    way.places.push_back({state, map_.rates()});
    add(way.places.back());
  }
  if (!way.there) lost_ = true;
  way.there = way.there && way.places.back().state.p == p;
  ways_.push_back(std::move(way));
  return ways_.back();
}

// Ways that lead to other states of the same shares have a fold between them.
void ShareBox::add(const Place& place) {
  const auto known =
      std::ranges::find_if(places_, [&](const Place& at) { return at.state.p == place.state.p; });
  if (known == places_.end())
    places_.push_back(place);
  else if (differ(*known, place))
    lost_ = true;
}

bool ShareBox::differ(const Place& a, const Place& b) const {
  for (Index i = 0; i < outputs_; ++i)
    if (const auto scale = map_.scale(static_cast<std::size_t>(i));
        scale && std::abs(a.state.values[i] - b.state.values[i]) > other_state * *scale)
      return true;
  return false;
}

ShareBox::Place ShareBox::best_known(Index output, double sense) const {
  return *std::ranges::max_element(places_, {},
                                   [&](const Place& place) { return sense * place.state.values[output]; });
}

ShareBox::Place ShareBox::highest_along(Index output, double sense) {
  std::vector<Place> line = places_;
  std::ranges::sort(line, {}, [](const Place& place) { return place.state.p[0]; });
  Place best = best_known(output, sense);
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (!(sense * line[i - 1].rates(output, 0) > 0) || !(sense * line[i].rates(output, 0) < 0)) continue;
    const Place top = crest(output, 0, line[i - 1], line[i]);
    if (sense * (top.state.values[output] - best.state.values[output]) > 0) best = top;
  }
  return best;
}

// Along each share, as far as the output grows. Whether that is anywhere.
bool ShareBox::sweep(Index output, double sense, Place& at) {
  bool moved = false;
  for (Index j = 0; j < at.state.p.size(); ++j)
    moved = climb_along(output, sense, j, at) || moved;
  return moved;
}

// To the highest that is found along one share, in the direction in which it rises at first.
bool ShareBox::climb_along(Index output, double sense, Index j, Place& at) {
  const double rate = sense * at.rates(output, j);
  VectorXd end = at.state.p;
  end[j] = rate > 0 ? 1 : -1;
  if (!(std::abs(rate) > 1e-9 * size_of(output, at)) || end == at.state.p) return false;
  const double forwards = rate > 0 ? sense : -sense;
  const std::vector<Place>& line = go(at, end).places;
  if (line.size() == 1) return false;
  Place best = at;
  const auto take = [&](const Place& place) {
    if (sense * (place.state.values[output] - best.state.values[output]) > 0) best = place;
  };
  bool turns = false;
  for (std::size_t i = 1; i < line.size(); ++i) {
    take(line[i]);
    if (!(forwards * line[i - 1].rates(output, j) > 0) || !(forwards * line[i].rates(output, j) < 0))
      continue;
    turns = true;
    take(crest(output, j, line[i - 1], line[i]));
  }
  if (!turns && best.state.p == at.state.p) lost_ = true; // it led down between: past a fold, or a dip
  const bool moved = std::abs(best.state.p[j] - at.state.p[j]) > 1e-9;
  at = std::move(best);
  return moved;
}

// Where the rate with the share j has a root, between two places at which its signs differ. The output is
// flat there, so that half its digits do.
ShareBox::Place ShareBox::crest(Index output, Index j, const Place& low, const Place& high) {
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

} // namespace flyball
