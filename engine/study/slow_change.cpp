#include "engine/study/slow_change.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/holding.hpp"
#include "engine/study/steady_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t most_joints_slow = 6; // all ways in which they may begin to slip are looked at
constexpr int most_slow_rounds = 40;        // forth and back, until they are the same
constexpr int most_slow_steps = 2000;       // between two places
constexpr int most_slow_corrections = 12;
constexpr double same_round = 1e-10;                         // scaled
constexpr double stands_still = 1e-12, stands_nearly = 1e-9; // scaled: how exactly a joint is held
constexpr double longest_share_step = 0.25;
constexpr double other_rate = 1e-6;   // of the largest of its kind: two ways that differ by more are two
constexpr double no_slow_rate = 1e-9; // of the largest of its kind
constexpr double rounding_of_share = 1e-12; // of the limit

// Where no slow way goes on, with the reason.
struct NoWay {
  std::string why;
};

class SlowWay {
 public:
  // `names`: of the coordinates with friction first.
  SlowWay(const Mechanism& mechanism, std::span<const FreeNumber> free, const std::vector<std::string>& names,
          const std::atomic<bool>* cancel)
      : map_(mechanism, free, names, cancel), joints_(map_.count() - 1) {}

  void begin(const std::vector<std::pair<std::string, double>>& start) {
    Solution first;
    std::optional<SteadyMap::State> state = map_.begin(start, first);
    if (!state) throw NoWay{first.message};
    now_ = std::move(*state);
    for (Index i = 0; i < joints_; ++i)
      scale_.push_back(map_.scale(static_cast<std::size_t>(i)).value_or(1));
    slips_.assign(static_cast<std::size_t>(joints_), false);
    kept_ = now_.values.head(joints_);
  }

  const VectorXd& values() const { return now_.values; }
  double scale(std::size_t i) const { return map_.scale(i).value_or(1); }

  void go_to(double number) {
    const double sense = number > now_.p[0] ? 1 : -1;
    if (now_.p[0] == number) return;
    choose(sense, -1);
    double part = 1;
    for (int step = 0; now_.p[0] != number; ++step) {
      interruption_point();
      if (step == most_slow_steps || part < 1e-9) throw NoWay{jumps()};
      part = advance(number, sense, part) ? std::min(1., 2 * part) : part / 2;
    }
  }

 private:
  enum class Outcome { found, beyond, lost };

  std::string jumps() const {
    return "Near " + rounded_text(now_.p[0], 6) + " the state jumps, or is not found: no slow way goes on.";
  }
  bool slips(Index i) const { return slips_[static_cast<std::size_t>(i)]; }
  double share(Index i) const { return now_.p[1 + i]; }
  bool is_at_limit(Index i) const { return 1 - std::abs(share(i)) <= rounding_of_share; }

  std::vector<Index> standing() const {
    std::vector<Index> out;
    for (Index i = 0; i < joints_; ++i)
      if (!slips(i)) out.push_back(i);
    return out;
  }
  static std::vector<Index> share_columns(const std::vector<Index>& joints) {
    std::vector<Index> out;
    for (const Index i : joints)
      out.push_back(1 + i);
    return out;
  }

  // Rates with the number, of the shares of those that stand; by joint.
  std::optional<VectorXd> share_rates(const std::vector<Index>& stand) const {
    VectorXd out = VectorXd::Zero(joints_);
    if (stand.empty()) return out;
    const MatrixXd a = map_.rates()(stand, share_columns(stand));
    const Eigen::FullPivLU<MatrixXd> lu(a);
    if (!lu.isInvertible()) return std::nullopt;
    const VectorXd rates = lu.solve(-VectorXd(map_.rates()(stand, 0)));
    for (std::size_t k = 0; k < stand.size(); ++k)
      out[stand[k]] = rates[static_cast<Index>(k)];
    return out;
  }

  // Those of the joints' coordinates, where shares have these.
  VectorXd joint_rates(const VectorXd& shares) const {
    return map_.rates().col(0).head(joints_) + map_.rates().block(0, 1, joints_, joints_) * shares;
  }

  // How fast the joints would go with the number if none stood.
  double free_rate() const { return map_.rates().col(0).head(joints_).norm(); }

  // The state with the numbers `p` but for those in `unknown` (columns), at which joints that stand do so
  // where they are kept. `beyond`: the joint whose share would pass its limit.
  Outcome hold(VectorXd p, const std::vector<Index>& unknown, const std::vector<Index>& stand,
               SteadyMap::State& to, Index& beyond) {
    double before = std::numeric_limits<double>::infinity();
    to = now_;
    for (int i = 0; i < most_slow_corrections; ++i) {
      if (!map_.walk_to(to, p) || !map_.find_rates(to)) return Outcome::lost;
      VectorXd away(static_cast<Index>(stand.size()));
      double size = 0;
      for (std::size_t k = 0; k < stand.size(); ++k) {
        const auto j = static_cast<std::size_t>(stand[k]);
        away[static_cast<Index>(k)] = map_.away(j, to.values[stand[k]], kept_[stand[k]]);
        size = std::max(size, std::abs(away[static_cast<Index>(k)]) / scale_[j]);
      }
      if (size <= stands_still || (size >= 0.5 * before && size <= stands_nearly)) return Outcome::found;
      before = size;
      const MatrixXd rates = map_.rates()(stand, unknown);
      const Eigen::FullPivLU<MatrixXd> lu(rates);
      if (!lu.isInvertible()) return Outcome::lost;
      const VectorXd step = lu.solve(-away);
      double worst = 1;
      for (std::size_t k = 0; k < unknown.size(); ++k) {
        double& x = p[unknown[k]];
        x += step[static_cast<Index>(k)];
        if (unknown[k] == 0) {
          if (x < map_.lower()[0] || x > map_.upper()[0]) return Outcome::lost;
          continue;
        }
        if (std::abs(x) > std::max(worst, 1 + rounding_of_share)) {
          worst = std::abs(x);
          beyond = unknown[k] - 1;
        }
        x = std::clamp(x, -1., 1.);
      }
      if (worst > 1) return Outcome::beyond;
    }
    return Outcome::lost;
  }

  // A step towards a number, at most a part of the way; false where a smaller one is to be tried.
  bool advance(double number, double sense, double part) {
    if (!map_.find_rates(now_)) throw NoWay{jumps()};
    const std::vector<Index> stand = standing();
    const std::optional<VectorXd> rates = share_rates(stand);
    if (!rates) throw NoWay{tied()};
    double step = part * (number - now_.p[0]);
    const double most = (step * *rates).lpNorm<Eigen::Infinity>();
    if (most > longest_share_step) step *= longest_share_step / most;
    VectorXd p = now_.p;
    p[0] = std::abs(step) < std::abs(number - now_.p[0]) ? now_.p[0] + step : number;
    for (const Index i : stand) {
      p[1 + i] += step * (*rates)[i];
      if (std::abs(p[1 + i]) > 1 + rounding_of_share) return begin_to_slip(i, p[0], stand, *rates, sense);
      p[1 + i] = std::clamp(p[1 + i], -1., 1.);
    }
    SteadyMap::State next;
    Index beyond = -1;
    switch (hold(p, share_columns(stand), stand, next, beyond)) {
    case Outcome::lost: return false;
    case Outcome::beyond: return begin_to_slip(beyond, p[0], stand, *rates, sense);
    case Outcome::found: break;
    }
    // What slips may come to rest on the way.
    const std::optional<VectorXd> then = share_rates(stand);
    if (!then) throw NoWay{tied()};
    const VectorXd moves = joint_rates(*then);
    const Index turned = first_to_turn(moves, sense);
    if (turned >= 0) return come_to_rest(turned, next, stand, sense);
    now_ = std::move(next);
    return true;
  }

  // Of those that slip, whose rate is against its share no longer; -1: none.
  Index first_to_turn(const VectorXd& moves, double sense) const {
    Index worst = -1;
    double most = no_slow_rate * std::max(moves.norm(), free_rate());
    for (Index i = 0; i < joints_; ++i)
      if (slips(i) && sense * moves[i] * share(i) > most) {
        most = sense * moves[i] * share(i);
        worst = i;
      }
    return worst;
  }

  // To where the share of a joint that stands reaches its limit, up to `number`.
  bool begin_to_slip(Index joint, double number, const std::vector<Index>& stand, const VectorXd& rates,
                     double sense) {
    for (std::size_t tries = 0; tries < stand.size(); ++tries) {
      const double limit = sense * rates[joint] > 0 ? 1 : -1;
      VectorXd p = now_.p;
      p[0] += std::clamp((limit - share(joint)) / rates[joint], std::min(0., number - p[0]),
                         std::max(0., number - p[0]));
      p[1 + joint] = limit;
      std::vector<Index> unknown{0};
      for (const Index i : stand)
        if (i != joint) {
          unknown.push_back(1 + i);
          p[1 + i] = std::clamp(share(i) + rates[i] * (p[0] - now_.p[0]), -1., 1.);
        }
      SteadyMap::State next;
      Index beyond = -1;
      const Outcome outcome = hold(p, unknown, stand, next, beyond);
      if (outcome == Outcome::beyond) {
        joint = beyond;
        continue;
      }
      const double rounding = 1e-12 * map_.range()[0];
      if (outcome == Outcome::lost || sense * (next.p[0] - now_.p[0]) < -rounding ||
          sense * (next.p[0] - number) > rounding)
        return false;
      now_ = std::move(next);
      choose(sense, -1);
      return true;
    }
    return false;
  }

  // To where the rate of a joint that slips is zero, before `next`.
  bool come_to_rest(Index joint, const SteadyMap::State& next, const std::vector<Index>& stand,
                    double sense) {
    const auto rate = [&](const SteadyMap::State& state) {
      if (!map_.find_rates(state)) throw NoWay{jumps()};
      const std::optional<VectorXd> shares = share_rates(stand);
      if (!shares) throw NoWay{tied()};
      return sense * joint_rates(*shares)[joint] * share(joint);
    };
    const double at_begin = rate(now_), at_end = rate(next);
    SteadyMap::State last = now_;
    if (at_begin < 0) {
      RootBracket bracket(now_.p[0], at_begin, next.p[0], at_end);
      for (int i = 0; i < 60 && bracket.width() > 1e-13 * map_.range()[0]; ++i) {
        VectorXd p = last.p;
        p[0] = bracket.next();
        SteadyMap::State there;
        Index beyond = -1;
        if (hold(p, share_columns(stand), stand, there, beyond) != Outcome::found) return false;
        const double value = rate(there);
        if (value <= 0) last = there;
        if (value == 0) break;
        bracket.take(p[0], value);
      }
    }
    now_ = std::move(last);
    slips_[static_cast<std::size_t>(joint)] = false;
    kept_[joint] = now_.values[joint];
    choose(sense, joint);
    return true;
  }

  static std::string tied() {
    return "Loops tie joints with friction to each other: how they share the load, and which slips first, is "
           "open.";
  }

  // Which of the joints at their limits go on to slip as the number goes on. `rests`: one that has come to
  // rest, which does not.
  void choose(double sense, Index rests) {
    if (!map_.find_rates(now_)) throw NoWay{jumps()};
    std::vector<Index> limits;
    for (Index i = 0; i < joints_; ++i)
      if (is_at_limit(i) && i != rests) limits.push_back(i);
    struct Choice {
      std::vector<bool> slips;
      VectorXd shares, moves;
    };
    std::vector<Choice> all, found;
    bool open = false;
    double share_size = 1 / map_.range()[0], move_size = free_rate(); // of rates
    for (unsigned bits = 0; bits < (1U << limits.size()); ++bits) {
      Choice choice{std::vector<bool>(static_cast<std::size_t>(joints_), false), {}, {}};
      for (std::size_t k = 0; k < limits.size(); ++k)
        choice.slips[static_cast<std::size_t>(limits[k])] = ((bits >> k) & 1U) != 0;
      std::vector<Index> stand;
      for (Index i = 0; i < joints_; ++i)
        if (!choice.slips[static_cast<std::size_t>(i)]) stand.push_back(i);
      const std::optional<VectorXd> shares = share_rates(stand);
      if (!shares) {
        open = true;
        continue;
      }
      choice.shares = sense * *shares;
      choice.moves = sense * joint_rates(*shares);
      share_size = std::max(share_size, choice.shares.norm());
      move_size = std::max(move_size, choice.moves.norm());
      all.push_back(std::move(choice));
    }
    for (Choice& choice : all) {
      const bool goes = std::ranges::all_of(limits, [&](Index i) {
        return choice.slips[static_cast<std::size_t>(i)]
                   ? share(i) * choice.moves[i] <= no_slow_rate * move_size
                   : share(i) * choice.shares[i] <= no_slow_rate * share_size;
      });
      if (goes) found.push_back(std::move(choice));
    }
    if (found.empty()) throw NoWay{open ? tied() : jumps()};
    for (const Choice& other : found)
      if ((other.moves - found.front().moves).norm() > other_rate * move_size ||
          (other.shares - found.front().shares).norm() > other_rate * share_size)
        throw NoWay{"At " + rounded_text(now_.p[0], 6) +
                    " several joints are at their limits, and can slip in more than one way."};
    // Of choices alike in their rates what stands most: it slips when its share comes to the limit.
    const auto chosen = std::ranges::min_element(
        found, {}, [](const Choice& choice) { return std::ranges::count(choice.slips, true); });
    for (Index i = 0; i < joints_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (slips_[k] && !chosen->slips[k]) kept_[i] = now_.values[i];
    }
    slips_ = chosen->slips;
  }

  SteadyMap map_;
  Index joints_;
  std::vector<double> scale_; // rad or m, by joint
  SteadyMap::State now_;
  std::vector<bool> slips_; // by joint; what does not stands where it is kept
  VectorXd kept_;           // rad or m
};

} // namespace

SlowChange find_slow_change(const Mechanism& mechanism, const std::string& address,
                            std::span<const RibbonPlace> places, const std::vector<std::string>& names,
                            const std::atomic<bool>* cancel) try {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  if (places.size() < 2) throw NoWay{"There are not two places."};
  for (std::size_t i = 1; i < places.size(); ++i)
    if ((places[i].number - places[i - 1].number) * (places[1].number - places[0].number) <= 0)
      throw NoWay{"The branch turns back, where the state jumps."};
  if (frictions.size() > most_joints_slow)
    throw NoWay{"More than " + std::to_string(most_joints_slow) + " joints with friction are not followed."};
  const Mechanism first = with_parameter(mechanism, address, places.front().number);
  if (find_holding(first, places.front().start, cancel).independent.size() < frictions.size())
    throw NoWay{
        "Loops tie joints with friction to each other: how they share the load, and which slips first, "
        "is open."};
  const auto [low, high] = std::minmax({places.front().number, places.back().number});
  std::vector<FreeNumber> free{{address, low, high}};
  std::vector<std::string> wanted;
  for (const CoordinateReference& at : frictions) {
    free.push_back({share_address(mechanism, at), -1, 1});
    wanted.push_back(coordinate_name(mechanism.joints[static_cast<std::size_t>(at.joint)], at.coordinate));
    if (std::ranges::find(names, wanted.back()) == names.end())
      throw NoWay{wanted.back() + " closes a loop, and has friction: such are not followed."};
  }
  for (const std::string& name : names)
    if (std::ranges::find(wanted, name) == wanted.end()) wanted.push_back(name);
  SlowWay way(first, free, wanted, cancel);
  way.begin(places.front().start);
  std::vector<VectorXd> forth(places.size()), back(places.size());
  bool settled = false;
  for (int round = 0; round < most_slow_rounds && !settled; ++round) {
    settled = round > 0;
    const auto take = [&](std::size_t i, std::vector<VectorXd>& to) {
      way.go_to(places[i].number);
      for (std::size_t k = 0; k < wanted.size() && settled; ++k) {
        const auto at = static_cast<Index>(k);
        settled = !(std::abs(to[i][at] - way.values()[at]) > same_round * way.scale(k));
      }
      to[i] = way.values();
    };
    for (std::size_t i = 0; i < places.size(); ++i)
      take(i, forth);
    for (std::size_t i = places.size(); i-- > 0;)
      take(i, back);
  }
  if (!settled)
    throw NoWay{"It does not come to the same way again in " + std::to_string(most_slow_rounds) + " rounds."};
  SlowChange out;
  for (const std::string& name : names) {
    const Index at = std::ranges::find(wanted, name) - wanted.begin();
    std::vector<HysteresisPoint>& points = out.way.emplace_back();
    for (std::size_t i = 0; i < places.size(); ++i)
      points.push_back({forth[i][at], back[i][at]});
  }
  return out;
} catch (const NoWay& none) {
  return {{}, none.why};
} catch (const SceneError& error) {
  return {{}, error.what()};
}

} // namespace flyball
