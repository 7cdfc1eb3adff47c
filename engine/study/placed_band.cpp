#include "engine/study/placed_band.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/linear_program.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/standing_joints.hpp"
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

constexpr double most_give = 1e-3, least_give = 1e-6; // of the springs: see stand_on_springs()
constexpr double longest_place_step = 0.2;            // rad, reaches or shares
constexpr double shortest_place_step = 1e-7;
constexpr int most_place_steps = 2000;
constexpr int most_place_rounds = 3; // of all outputs, each from the best place that another found
constexpr int most_restorations = 8;
constexpr double within_limit = 1e-9;    // of the limit: what still counts as held
constexpr double most_bulge = 1e-2;      // of the limit, between two places at one: the way is curved
constexpr double no_placed_gain = 1e-13; // of an output's size, in a step
constexpr double on_mark = 1e-9, same_after_turn = 1e-7; // rad; scaled
constexpr int most_turns = 20;
constexpr double farthest_way = 100; // reaches
constexpr double infinite = std::numeric_limits<double>::infinity();

class PlacedBand {
 public:
  PlacedBand(const StandingJoints& standing, const std::vector<std::string>& names, double reach,
             const std::atomic<bool>* cancel)
      : standing_(standing), outputs_(static_cast<Index>(names.size())), reach_(reach),
        map_(standing.mechanism, numbers(standing), wanted(standing, names), cancel) {
    map_.count_turns();
    radius_ = VectorXd::Ones(map_.count());
    for (Index j = 0; j < map_.count(); ++j)
      if (is_length(j)) radius_[j] = reach;
  }

  enum class End { extremum, round, far, lost };

  bool begin(const Solution& solution) {
    Solution first;
    std::optional<SteadyMap::State> state = map_.begin(start_values(solution.coordinates), first);
    if (!state || !map_.find_rates(*state)) return false;
    add(std::move(*state));
    return true;
  }

  std::string unit(Index output) const { return map_.unit(static_cast<std::size_t>(output)); }
  double value(Index output) const { return places_.front().state.values[output]; }
  bool has_rates(Index output) const {
    return std::isfinite(value(output)) && places_.front().rates.row(output).allFinite();
  }

  // The best value that is known.
  double best(Index output, double sense) const {
    return places_[best_place(output, sense)].state.values[output];
  }

  // From the best place that is known up to where the output, times `sense`, grows no more.
  End climb(Index output, double sense) {
    Place at = places_[best_place(output, sense)];
    const Place begin = at;
    double step = longest_place_step, mark = sense * at.state.values[output];
    std::optional<Place> before; // at the last mark
    const bool turns = unit(output) == "rad";
    for (int i = 0; i < most_place_steps; ++i) {
      interruption_point();
      const double now = sense * at.state.values[output];
      if (turns && std::abs(now - mark) <= on_mark) {
        if (before && comes_back(*before, at)) return End::round;
        before = at;
        mark += 2 * std::numbers::pi;
      }
      if (went_far(begin, at)) return End::far;
      const VectorXd gradient = sense * at.rates.row(output).transpose();
      if (!gradient.allFinite()) return End::lost;
      const VectorXd d = best_step(at, gradient, step, turns ? mark - now : infinite);
      const double gain = gradient.dot(d);
      if (gain <= no_placed_gain * (std::abs(now) + gradient.cwiseProduct(radius_).lpNorm<1>()))
        return End::extremum;
      std::optional<Place> to = go(at, at.state.p + d, output, sense, turns ? mark : infinite);
      if (to && sense * to->state.values[output] > now) {
        at = std::move(*to);
        places_.push_back(at);
        step = std::min(longest_place_step, 2 * step);
        lost_ = false;
        continue;
      }
      step /= 4;
      if (step < shortest_place_step) return lost_ ? End::lost : End::extremum;
    }
    return End::lost;
  }

 private:
  struct Place {
    SteadyMap::State state;
    MatrixXd rates; // of the outputs, then of the shares that measures tell, with the numbers
  };

  static std::vector<FreeNumber> numbers(const StandingJoints& standing) {
    std::vector<FreeNumber> out;
    for (const StandingJoint& joint : standing.joints)
      out.push_back(joint.number);
    return out;
  }

  static std::vector<std::string> wanted(const StandingJoints& standing, std::vector<std::string> names) {
    for (const StandingJoint& joint : standing.joints)
      if (!joint.measure.empty()) names.push_back(joint.measure);
    return names;
  }

  bool is_length(Index j) const {
    return !standing_.joints[static_cast<std::size_t>(j)].measure.empty() &&
           parameter_unit(standing_.mechanism,
                          standing_.joints[static_cast<std::size_t>(j)].number.address) == "m";
  }

  void add(SteadyMap::State state) { places_.push_back({std::move(state), map_.rates()}); }

  std::size_t best_place(Index output, double sense) const {
    const auto better = [&](const Place& a, const Place& b) {
      return sense * a.state.values[output] < sense * b.state.values[output];
    };
    return static_cast<std::size_t>(std::ranges::max_element(places_, better) - places_.begin());
  }

  // What friction gives, of each limit; and how that goes with the numbers.
  VectorXd shares(const Place& at) const {
    VectorXd out(map_.count());
    Index measured = outputs_;
    for (Index j = 0; j < out.size(); ++j)
      out[j] = is_told(j) ? at.state.values[measured++] : at.state.p[j];
    return out;
  }

  MatrixXd share_rates(const Place& at) const {
    MatrixXd out = MatrixXd::Identity(map_.count(), map_.count());
    Index measured = outputs_;
    for (Index j = 0; j < out.rows(); ++j)
      if (is_told(j)) out.row(j) = at.rates.row(measured++);
    return out;
  }

  bool is_told(Index j) const { return !standing_.joints[static_cast<std::size_t>(j)].measure.empty(); }

  // Within the limits and as far as rates tell, by at most `most` of the output.
  VectorXd best_step(const Place& at, const VectorXd& gradient, double step, double most) const {
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
  std::optional<Place> go(const Place& from, const VectorXd& p, Index output, double sense, double mark) {
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
      if (!share.allFinite() || !at.rates.allFinite()) return std::nullopt;
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

  double largest_part(const VectorXd& step) const {
    return step.cwiseQuotient(radius_).lpNorm<Eigen::Infinity>();
  }

  // The shortest one to the limits that are passed, and where `rate` is given down by `past` along it.
  std::optional<VectorXd> way_back(const Place& at, const VectorXd& share, const VectorXd& rate,
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
  bool slips_between(const Place& from, const Place& to) const {
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

  // Whether two places differ by whole turns of angles alone, so that the way from one to the other goes on
  // from there.
  bool comes_back(const Place& before, const Place& now) const {
    if ((shares(now) - shares(before)).lpNorm<Eigen::Infinity>() > same_after_turn) return false;
    for (Index i = 0; i < outputs_; ++i) {
      if (!map_.scale(static_cast<std::size_t>(i))) continue; // a measure
      const double change = now.state.values[i] - before.state.values[i];
      const bool angle = unit(i) == "rad";
      const double left = angle ? std::remainder(change, 2 * std::numbers::pi) : change / reach_;
      if (!(std::abs(left) <= same_after_turn)) return false;
    }
    return true;
  }

  bool went_far(const Place& begin, const Place& now) const {
    for (Index i = 0; i < outputs_; ++i) {
      if (!map_.scale(static_cast<std::size_t>(i))) continue;
      const double way = std::abs(now.state.values[i] - begin.state.values[i]);
      if (way > (unit(i) == "rad" ? most_turns * 2 * std::numbers::pi : farthest_way * reach_)) return true;
    }
    return false;
  }

  const StandingJoints& standing_;
  Index outputs_;
  double reach_;
  SteadyMap map_;
  VectorXd radius_; // of the numbers: a radian, the reach, all of a share
  std::vector<Place> places_;
  bool lost_ = false; // the last step: no state followed
};

} // namespace

FrictionBand find_placed_band(const Mechanism& mechanism, const Solution& state,
                              const std::vector<std::string>& names,
                              const std::vector<std::size_t>& independent, double reach,
                              const std::atomic<bool>* cancel) {
  FrictionBand none;
  // Springs that give too much fold with what they hold against.
  for (double give = most_give; give > 0.9 * least_give; give /= 30) {
    FrictionBand band;
    const auto standing = stand_on_springs(mechanism, state, independent, reach, give);
    if (!standing || standing->joints.empty()) return none;
    PlacedBand places(*standing, names, reach, cancel);
    if (!places.begin(state)) return none;
    const auto count = static_cast<Index>(names.size());
    std::vector<std::array<PlacedBand::End, 2>> ends(names.size());
    std::vector<std::array<double, 2>> reached(names.size());
    bool lost = false;
    for (int round = 0; round < most_place_rounds; ++round)
      for (Index i = 0; i < count; ++i)
        for (const std::size_t side : {0u, 1u}) {
          const auto k = static_cast<std::size_t>(i);
          const double sense = side == 0 ? -1 : 1;
          PlacedBand::End& end = ends[k][side];
          if (!places.has_rates(i)) continue;
          if (round > 0 && (end == PlacedBand::End::round || end == PlacedBand::End::far ||
                            places.best(i, sense) == reached[k][side]))
            continue;
          end = places.climb(i, sense);
          reached[k][side] = places.best(i, sense);
        }
    std::vector<std::string_view> round, farther;
    for (Index i = 0; i < count; ++i) {
      if (!places.has_rates(i)) continue;
      const auto k = static_cast<std::size_t>(i);
      const auto unbounded = [](PlacedBand::End end) {
        return end == PlacedBand::End::round || end == PlacedBand::End::far;
      };
      lost = lost || ends[k][0] == PlacedBand::End::lost || ends[k][1] == PlacedBand::End::lost;
      BandExtent extent;
      extent.name = names[k];
      extent.unit = places.unit(i);
      extent.value = places.value(i);
      extent.low = unbounded(ends[k][0]) ? -infinite : reached[k][0];
      extent.high = unbounded(ends[k][1]) ? infinite : reached[k][1];
      if (std::ranges::count(ends[k], PlacedBand::End::far) > 0)
        farther.push_back(names[k]);
      else if (std::ranges::count(ends[k], PlacedBand::End::round) > 0)
        round.push_back(names[k]);
      band.extents.push_back(std::move(extent));
    }
    if (lost) continue;
    band.found = true;
    band.whole = false;
    band.folds = true;
    band.message = "It is the band by where the joints with friction stand";
    band.message += independent.size() > 1 ? "; each extent is an extremum nearby." : ".";
    if (!round.empty())
      band.message += " Friction holds it at any angle: " + word_list(round, "and") + " can go round.";
    if (!farther.empty())
      band.message += " Friction holds " + word_list(farther, "and") +
                      " farther than the band was followed, so that no bound is told.";
    return band;
  }
  return none;
}

} // namespace flyball
