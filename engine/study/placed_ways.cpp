#include "engine/study/placed_ways.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/linear_program.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/report/analysis.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double longest_place_step = 0.2; // rad, reaches or shares
constexpr double same_answer = 1e-3;       // rad or reaches
constexpr int most_restorations = 8;
constexpr double within_limit = 1e-9; // of the limit: what still counts as held
constexpr double most_bulge = 1e-2;   // of the limit, between two places at one: the way is curved
// Where a climb ends.
struct ClimbEnd {
  double gain, step; // of an output's size in a step; rad, reaches or shares
  int steps;
};
constexpr ClimbEnd whole_climb{1e-13, 1e-7, 2000}, rough_climb{1e-5, 1e-3, 300};
constexpr double on_mark = 1e-9, same_after_turn = 1e-6; // rad; scaled
constexpr double another_after_turn = 1e-4;              // of a value: by far more than places differ
constexpr int most_turns = 8;
constexpr double farthest_way = 100; // reaches
constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<FreeNumber> numbers(const StandingJoints& standing) {
  std::vector<FreeNumber> out;
  for (const StandingJoint& joint : standing.joints)
    out.push_back(joint.number);
  return out;
}

std::vector<std::string> with_shares(const StandingJoints& standing, std::vector<std::string> names) {
  for (const StandingJoint& joint : standing.joints)
    if (!joint.measure.empty()) names.push_back(joint.measure);
  return names;
}

} // namespace

PlacedWays::PlacedWays(const StandingJoints& standing, const std::vector<std::string>& outputs,
                       const std::vector<std::string>& turning, double reach, const std::atomic<bool>* cancel)
    : standing_(standing), outputs_(static_cast<Index>(outputs.size())), reach_(reach), cancel_(cancel),
      map_(standing.mechanism, numbers(standing), with_shares(standing, outputs), cancel) {
  map_.keep_to_branch();
  for (const std::string& name : outputs)
    turns_freely_.push_back(std::ranges::find(turning, name) != turning.end());
  radius_ = VectorXd::Ones(map_.count());
  for (Index j = 0; j < map_.count(); ++j)
    if (is_length(j)) radius_[j] = reach;
}

bool PlacedWays::begin(const Solution& solution) {
  Solution first;
  std::optional<SteadyMap::State> state = map_.begin(start_values(solution.coordinates), first);
  if (!state || !map_.find_rates(*state)) return false;
  places_.push_back({std::move(*state), map_.rates()});
  return true;
}

bool PlacedWays::has_rates(Index output) const {
  return std::isfinite(value(output)) && places_.front().rates.row(output).allFinite();
}

double PlacedWays::best(Index output, double sense) const {
  return places_[best_place(output, sense)].state.values[output];
}

std::size_t PlacedWays::best_place(Index output, double sense) const {
  const auto better = [&](const Place& a, const Place& b) {
    return sense * a.state.values[output] < sense * b.state.values[output];
  };
  return static_cast<std::size_t>(std::ranges::max_element(places_, better) - places_.begin());
}

std::optional<bool> PlacedWays::stable_at(const Mechanism& mechanism, std::size_t place) {
  const Place& at = places_[place];
  const VectorXd share = shares(at);
  Mechanism pushed = mechanism;
  for (Index j = 0; j < share.size(); ++j)
    put_number(pushed, standing_.joints[static_cast<std::size_t>(j)].share, std::clamp(share[j], -1., 1.));
  const Solution stood = map_.solution(at.state, false);
  SolveOptions options;
  options.start = start_values(stood.coordinates);
  options.nearest = true;
  options.details = options.friction = false;
  options.cancel = cancel_;
  const Solution found = Analysis(pushed).solve(options);
  const bool same = found.status == Status::converged && found.frictions.empty() &&
                    scaled_distance(found.coordinates, stood.coordinates) < same_answer;
  return same ? found.stable : std::nullopt;
}

PlacedWays::Beside PlacedWays::compare_last(std::size_t other, double near) const {
  const Place &a = places_[other], &b = places_.back();
  if (largest_part(a.state.p - b.state.p) < near) return Beside::same;
  return comes_back(a, b) ? Beside::turned : Beside::elsewhere;
}

bool PlacedWays::changes_to_last(std::size_t other, Index output) const {
  const double a = places_[other].state.values[output], b = places_.back().state.values[output];
  return !(std::abs(b - a) <= another_after_turn * (1 + std::abs(a)));
}

PlacedWays::End PlacedWays::climb(Index output, double sense, std::size_t from, Care care) {
  const ClimbEnd& end = care == Care::whole ? whole_climb : rough_climb;
  Place at = places_[from];
  const Place begin = at;
  double step = longest_place_step, mark = sense * at.state.values[output];
  std::optional<Place> before; // at the last mark
  const bool turns = unit(output) == "rad";
  for (int i = 0; i < end.steps; ++i) {
    interruption_point();
    const double now = sense * at.state.values[output];
    if (turns && std::abs(now - mark) <= on_mark) {
      if (before && comes_back(*before, at)) return End::round;
      before = at;
      mark += 2 * std::numbers::pi;
    }
    if (went_far(begin, at))
      return (turns || is_coordinate(output)) && went_far(output, begin, at) ? End::far : End::left;
    const VectorXd gradient = sense * at.rates.row(output).transpose();
    if (!gradient.allFinite()) return End::left; // a measure has no value there
    const VectorXd d = best_step(at, gradient, step, turns ? mark - now : infinite);
    const double gain = gradient.dot(d);
    if (gain <= end.gain * (std::abs(now) + gradient.cwiseProduct(radius_).lpNorm<1>())) return End::extremum;
    std::optional<Place> to = go(at, at.state.p + d, output, sense, turns ? mark : infinite);
    if (to && sense * to->state.values[output] > now) {
      at = std::move(*to);
      places_.push_back(at);
      step = std::min(longest_place_step, 2 * step);
      continue;
    }
    step /= 4;
    if (step < end.step) return lost_ ? End::lost : End::extremum;
  }
  return End::left;
}

bool PlacedWays::is_length(Index j) const {
  return !standing_.joints[static_cast<std::size_t>(j)].measure.empty() &&
         parameter_unit(standing_.mechanism, standing_.joints[static_cast<std::size_t>(j)].number.address) ==
             "m";
}

// What friction gives, of each limit; and how that goes with the numbers.
VectorXd PlacedWays::shares(const Place& at) const {
  VectorXd out(map_.count());
  Index measured = outputs_;
  for (Index j = 0; j < out.size(); ++j)
    out[j] = is_told(j) ? at.state.values[measured++] : at.state.p[j];
  return out;
}

MatrixXd PlacedWays::share_rates(const Place& at) const {
  MatrixXd out = MatrixXd::Identity(map_.count(), map_.count());
  Index measured = outputs_;
  for (Index j = 0; j < out.rows(); ++j)
    if (is_told(j)) out.row(j) = at.rates.row(measured++);
  return out;
}

// Within the limits and as far as rates tell, by at most `most` of the output.
VectorXd PlacedWays::best_step(const Place& at, const VectorXd& gradient, double step, double most) const {
  const VectorXd scale = step * radius_, share = shares(at);
  const bool marked = std::isfinite(most);
  const Index n = map_.count();
  MatrixXd rows(n + (marked ? 1 : 0), n);
  VectorXd lower(rows.rows()), upper(rows.rows());
  rows.topRows(n) = share_rates(at) * scale.asDiagonal();
  lower.head(n) = (-1 - share.array()).min(0);
  upper.head(n) = (1 - share.array()).max(0);
  const VectorXd g = gradient.cwiseProduct(scale);
  if (marked) {
    rows.row(n) = g.transpose();
    lower[n] = -std::numeric_limits<double>::max();
    upper[n] = std::max(0., most);
  }
  return largest_within(g, rows, lower, upper).cwiseProduct(scale);
}

// To other numbers, and from there back to the limits where one is passed, and to the mark of the output.
// Nothing where no state follows, or between the two a joint would slip.
std::optional<PlacedWays::Place> PlacedWays::go(const Place& from, const VectorXd& p, Index output,
                                                double sense, double mark) {
  lost_ = false;
  SteadyMap::State state = from.state;
  const double way = largest_part(p - from.state.p);
  VectorXd to = p;
  for (int i = 0; i < most_restorations; ++i) {
    if (!map_.walk_to(state, to) || !map_.find_rates(state)) {
      lost_ = true;
      return std::nullopt;
    }
    const Place at{state, map_.rates()};
    const VectorXd share = shares(at);
    if (!share.allFinite() || !share_rates(at).allFinite()) return std::nullopt;
    const double beyond = share.cwiseAbs().maxCoeff() - 1;
    const double past = sense * state.values[output] - mark;
    std::optional<VectorXd> back;
    if (beyond > 0 || past > 0)
      back = way_back(at, share, past > 0 ? VectorXd(sense * at.rates.row(output)) : VectorXd(), past);
    // To rounding, which the next correction says it is.
    if (beyond <= within_limit && past <= on_mark &&
        (!back || largest_part(*back) <= 1e-14 || i + 1 == most_restorations))
      return slips_between(from, at) ? std::nullopt : std::optional(at);
    if (!back || largest_part(*back) > way) return std::nullopt;
    to = state.p + *back;
  }
  return std::nullopt;
}

double PlacedWays::largest_part(const VectorXd& step) const {
  return step.cwiseQuotient(radius_).lpNorm<Eigen::Infinity>();
}

// The shortest one to the limits that are passed, and where `rate` is given down by `past` along it.
std::optional<VectorXd> PlacedWays::way_back(const Place& at, const VectorXd& share, const VectorXd& rate,
                                             double past) const {
  const MatrixXd rates = share_rates(at);
  std::vector<Index> passed;
  for (Index j = 0; j < share.size(); ++j)
    if (std::abs(share[j]) > 1) passed.push_back(j);
  const auto count = static_cast<Index>(passed.size()), marked = Index(rate.size() > 0);
  MatrixXd rows(count + marked, map_.count());
  VectorXd missing(rows.rows());
  for (Index k = 0; k < count; ++k) {
    const Index j = passed[static_cast<std::size_t>(k)];
    rows.row(k) = rates.row(j);
    missing[k] = std::copysign(1, share[j]) - share[j];
  }
  if (marked) {
    rows.row(count) = rate.transpose();
    missing[count] = -past;
  }
  const auto found = least_squares(rows * radius_.asDiagonal(), missing);
  if (!found) return std::nullopt;
  return found->cwiseProduct(radius_);
}

// By the cubics through the shares and their rates at both ends.
bool PlacedWays::slips_between(const Place& from, const Place& to) const {
  const VectorXd a = shares(from), b = shares(to), step = to.state.p - from.state.p;
  const VectorXd rate_a = share_rates(from) * step, rate_b = share_rates(to) * step;
  for (Index j = 0; j < a.size(); ++j) {
    const double most =
        std::max(std::abs(a[j]), std::abs(b[j])) > 1 - within_limit ? most_bulge : within_limit;
    for (const double t : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
      const double u = 1 - t;
      const double between =
          u * u * ((1 + 2 * t) * a[j] + t * rate_a[j]) + t * t * ((1 + 2 * u) * b[j] - u * rate_b[j]);
      if (std::abs(between) > 1 + most) return true;
    }
  }
  return false;
}

// Whether two places differ by whole turns of angles alone, of which the balance knows nothing: the way
// from one to the other then goes on from there.
bool PlacedWays::comes_back(const Place& before, const Place& now) const {
  if ((shares(now) - shares(before)).lpNorm<Eigen::Infinity>() > same_after_turn) return false;
  for (Index i = 0; i < outputs_; ++i) {
    if (!is_coordinate(i)) continue;
    const double change = now.state.values[i] - before.state.values[i];
    const bool turns = turns_freely_[static_cast<std::size_t>(i)];
    const double left = turns ? std::remainder(change, 2 * std::numbers::pi) : change / scale_of(i);
    if (!(std::abs(left) <= same_after_turn)) return false;
  }
  return true;
}

// From the first place, and farther than where the way began.
bool PlacedWays::went_far(Index output, const Place& begin, const Place& now) const {
  const auto way = [&](const Place& place) {
    return std::abs(place.state.values[output] - places_.front().state.values[output]);
  };
  const double far = unit(output) == "rad" ? most_turns * 2 * std::numbers::pi : farthest_way * reach_;
  return way(now) > far && way(now) > way(begin);
}

bool PlacedWays::went_far(const Place& begin, const Place& now) const {
  for (Index i = 0; i < outputs_; ++i)
    if (is_coordinate(i) && went_far(i, begin, now)) return true;
  return false;
}

} // namespace flyball
