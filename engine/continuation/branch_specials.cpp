// The special points of a branch: where on a step it folds, where another branch crosses it, and where a pair
// of eigenvalues crosses the axis.
#include "engine/continuation/branch_follower.hpp"

#include "engine/linear/root_bracket.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

// The parabola nearest to values at -2 to 2.
struct Parabola {
  double value = 0, slope = 0, bend = 0; // value + slope x + bend x^2
  double spread = 0;                     // of the values beside it
  explicit Parabola(const std::array<double, 5>& y)
      : value((-3 * y[0] + 12 * y[1] + 17 * y[2] + 12 * y[3] - 3 * y[4]) / 35),
        slope((-2 * y[0] - y[1] + y[3] + 2 * y[4]) / 10),
        bend((2 * y[0] - y[1] - 2 * y[2] - y[3] + 2 * y[4]) / 14) {
    for (int i = 0; i < 5; ++i) {
      const double x = i - 2;
      spread =
          std::max(spread, std::abs(y[static_cast<std::size_t>(i)] - (value + slope * x + bend * x * x)));
    }
  }
};

} // namespace

Spectrum BranchFollower::spectrum(const BranchState& state) {
  const FactoredState at = factor_at(problem_at(state), state.z, w_);
  return find_stability(at, true).eigenvalues.value_or(Spectrum{});
}

// Where `value` (of a state and its distance along the branch, a step function maybe) changes its sign, and
// how far along that is.
template <class Value>
std::pair<BranchState, double> BranchFollower::locate(const BranchState& from, double low, double at_low,
                                                      double high, double at_high, const BranchState& beyond,
                                                      Value value) {
  BranchState at = beyond, probe;
  double found = high, previous = low;
  RootBracket bracket(low, at_low, high, at_high);
  for (int i = 0; i < 80 && bracket.width() > tolerance::special_point; ++i) {
    double middle = bracket.next();
    // Right beside a crossing the corrector may fail; closer in from either end it need not.
    bool stepped = false;
    for (const double there : {middle, (bracket.low() + middle) / 2, (middle + bracket.high()) / 2}) {
      int iterations = 0;
      middle = there;
      stepped = continuation_.step(from, middle, probe, iterations);
      if (stepped) break;
    }
    if (!stepped) break;
    const double now = value(probe, middle);
    at = probe;
    found = middle;
    if (now == 0 || (std::abs(middle - previous) < 0.1 * tolerance::special_point && i > 3)) break;
    previous = middle;
    bracket.take(middle, now);
  }
  return {std::move(at), found};
}

// What rounding, and steps that end before they are exact, do to the state and to what was made zero is seen
// in how these scatter beside it; the rest follows from slopes there.
template <class Value>
std::optional<double> BranchFollower::parameter_error(const BranchState& from, const BranchState& at,
                                                      double along, Value value) {
  constexpr double beside = 1e-5; // scaled: what bends more than a parabola there is told as an error
  constexpr double safety = 4;    // of five that scatter
  std::array<double, 5> parameters{}, values{};
  for (int i = -2; i <= 2; ++i) {
    BranchState probe = at;
    int iterations = 0;
    const double there = along + i * beside;
    if (i != 0 && !continuation_.step(from, there, probe, iterations)) return {};
    const auto entry = static_cast<std::size_t>(i + 2);
    parameters[entry] = probe.parameter - at.parameter;
    values[entry] = value(probe, there);
  }
  const Parabola parameter(parameters), test(values);
  const double unknown = std::abs(test.value) + safety * test.spread;
  if (!(std::abs(test.slope) > unknown)) return {};
  const double away = unknown / std::abs(test.slope); // in steps of `beside`
  return std::abs(parameter.value) + safety * parameter.spread +
         (std::abs(parameter.slope) + std::abs(parameter.bend) * away) * away +
         2 * std::numeric_limits<double>::epsilon() * std::abs(at.parameter);
}

ResponsePoint BranchFollower::special_point(const BranchState& at, std::optional<double> parameter_error) {
  ResponsePoint out = point(at);
  out.parameter_error = parameter_error;
  return out;
}

std::optional<BranchFollower::Crossing>
BranchFollower::find_crossing(const BranchState& state, const BranchState& next, double length) {
  if (!comparable(state, next) || !(state.determinant * next.determinant < 0)) return {};
  const auto determinant = [](const BranchState& s, double) { return s.determinant; };
  auto [at, along] = locate(state, 0, state.determinant, length, next.determinant, next, determinant);
  constexpr double at_once = 0.05; // of the larger at the ends
  const bool jumps =
      std::abs(at.determinant) > at_once * std::max(std::abs(state.determinant), std::abs(next.determinant));
  const bool leaps = jumps && jumps_aside(state, along);
  const auto error = jumps ? std::nullopt : parameter_error(state, at, along, determinant);
  return Crossing{std::move(at), along, leaps, error};
}

bool BranchFollower::jumps_aside(const BranchState& state, double along) {
  constexpr double beside = 1e-8, apart = 1e-7; // scaled
  BranchState before, after;
  int iterations = 0;
  return !continuation_.step(state, along - beside, before, iterations) ||
         !continuation_.step(state, along + beside, after, iterations) ||
         !(before.determinant * after.determinant < 0) || // it was not located
         size_of(before, difference(before, after)) > apart;
}

void BranchFollower::find_specials(const BranchState& state, const BranchState& next, double length,
                                   const Described& now, const Described& then,
                                   std::optional<Crossing> crossing, FollowedBranch& out) {
  if (now.point.singular_loops && then.point.singular_loops) return; // of a balance that says nothing
  constexpr double rounding = 1e-9; // of a tangent, as along a family at one value of the parameter
  int explained = 0;                // eigenvalues that go through zero
  if (comparable(state, next) && state.turning * next.turning < 0 &&
      std::max(std::abs(state.turning), std::abs(next.turning)) > rounding) {
    // At a crossing the tangent can jump; a fold's own balance stays regular.
    const auto turning = [](const BranchState& s, double) { return s.turning; };
    const auto [at, along] = locate(state, 0, state.turning, length, next.turning, next, turning);
    out.special.emplace_back(SpecialPointType::fold,
                             special_point(at, parameter_error(state, at, along, turning)));
    ++explained;
  }
  if (!crossing) crossing = find_crossing(state, next, length);
  if (crossing) {
    // At the crossing itself the balance has two tangents; this is the branch's own.
    crossing->at.tangent = state.tangent;
    out.special.emplace_back(SpecialPointType::branch_point,
                             special_point(crossing->at, crossing->parameter_error));
    out.crossings.push_back(std::move(crossing->at));
    ++explained;
  }
  explained += find_even_crossings(state, next, length, explained, out);
  if (options_.eigenvalues && std::abs(then.right - now.right) > explained)
    find_pair_crossings(state, next, length, now.right, then.right, out);
}

int BranchFollower::find_even_crossings(const BranchState& state, const BranchState& next, double length,
                                        int explained, FollowedBranch& out) {
  if (!comparable(state, next) || std::abs(next.falling - state.falling) < explained + 2) return 0;
  constexpr double singular = 1e-4; // determinant, of the larger at the ends
  constexpr double past = 1e-6;     // of the step
  constexpr int most = 4;
  const double size = std::max(std::abs(state.determinant), std::abs(next.determinant));
  int found = 0, falling = state.falling;
  double low = 0;
  for (int i = 0; i < most && falling != next.falling; ++i) {
    auto located = locate(state, low, -1, length, 1, next,
                          [&](const BranchState& s, double) { return s.falling == falling ? -1. : 1.; });
    BranchState& at = located.first;
    const double along = located.second;
    low = located.second + past * length;
    BranchState beyond;
    int iterations = 0;
    if (low >= length || !continuation_.step(state, low, beyond, iterations)) break;
    const int more = std::abs(beyond.falling - falling), before = falling;
    falling = beyond.falling;
    // A fold's balance is regular, and so is one where a pair of K's eigenvalues turns over.
    if (!(std::abs(at.determinant) <= singular * size)) continue;
    found += more;
    if (std::ranges::any_of(out.crossings, [&](const BranchState& other) { return same(at, other); }))
      continue;
    at.tangent = state.tangent;
    at.twofold = more > 1;
    const auto error = parameter_error(state, at, along, [&](const BranchState& s, double) {
      return s.falling == before ? -std::abs(s.determinant) : std::abs(s.determinant);
    });
    out.special.emplace_back(SpecialPointType::branch_point, special_point(at, error));
    out.crossings.push_back(std::move(at));
  }
  return found;
}

// Of a step that leaves the range those within it.
void BranchFollower::find_specials_inside(const BranchState& state, const BranchState& beyond, double length,
                                          const Described& now, std::optional<Crossing> crossing,
                                          FollowedBranch& out) {
  FollowedBranch last;
  try {
    if (!holds_at_every_phase(beyond)) return;
    find_specials(state, beyond, length, now, describe(beyond), std::move(crossing), last);
  } catch (const SceneError&) { // no mechanism can be made a little beyond the range
    return;
  }
  std::size_t crossings = 0;
  for (auto& [type, point] : last.special) {
    const bool crosses = type == SpecialPointType::branch_point;
    const std::size_t at = crossings;
    crossings += crosses ? 1 : 0;
    if (const double p = position(point.parameter); p < 0 || p > 1) continue;
    if (crosses) out.crossings.push_back(std::move(last.crossings[at]));
    out.special.emplace_back(type, std::move(point));
  }
}

// Every place on a step at which the number of eigenvalues to the right of the axis changes, in order.
void BranchFollower::find_pair_crossings(const BranchState& state, const BranchState& next, double length,
                                         int before, int after, FollowedBranch& out) {
  constexpr int most = 8;
  CrossingBracket at{0, length, before, after};
  for (int i = 0; i < most && at.right_low != after && !cancelled(); ++i) {
    at.high = length;
    at.right_high = after;
    // Their number is blurred by rounding where they meet: it brackets, and a smooth function locates.
    std::optional<PairPlace> found;
    const auto one = [&] { return std::abs(at.right_high - at.right_low) == 1; }; // no pair
    for (const double width : {1e-3 * length, 1e-7 * length}) {
      if (!narrow(state, width, at)) return;
      if (!one() && (found = locate_pair_crossing(state, next, length, at))) break;
    }
    if (!found && !one()) found = jumping_pair(state, at);
    // A pair that goes through zero counts a while later.
    const bool crosses = found && std::ranges::any_of(out.crossings, [&](const BranchState& other) {
                           return same(found->at, other);
                         });
    if (found && !crosses)
      out.special.emplace_back(found->type, special_point(found->at, found->parameter_error));
    at.low = at.high;
    at.right_low = at.right_high;
  }
}

bool BranchFollower::narrow(const BranchState& state, double width, CrossingBracket& at) {
  while (at.high - at.low > width && !cancelled()) {
    BranchState probe;
    int iterations = 0;
    const double middle = (at.low + at.high) / 2;
    if (!continuation_.step(state, middle, probe, iterations)) return false;
    const int right = right_of_axis(spectrum(probe), state.one_of_many());
    (right == at.right_low ? at.low : at.high) = middle;
    if (right != at.right_low) at.right_high = right;
  }
  return true;
}

std::optional<BranchFollower::PairPlace> BranchFollower::locate_pair_crossing(const BranchState& state,
                                                                              const BranchState& next,
                                                                              double length,
                                                                              const CrossingBracket& at) {
  const bool forth = at.right_high > at.right_low; // towards the unstable side
  const auto spectrum_at = [&](double along) {
    BranchState probe;
    int iterations = 0;
    return continuation_.step(state, along, probe, iterations) ? spectrum(probe) : Spectrum{};
  };
  const double unstable = forth ? at.high : at.low;
  const Spectrum there = spectrum_at(unstable);
  for (PairCrossing crossing :
       possible_crossings(there, std::abs(at.right_high - at.right_low), state.one_of_many())) {
    double stable = forth ? at.low : at.high;
    Spectrum here = spectrum_at(stable);
    std::complex<double> first = crossing.at, second = crossing.at; // on the stable and the unstable side
    if (!crossing.coalescence && !here.empty()) {
      first = nearest_eigenvalue(here, second);
      // A real part grows slowly: it was above zero for a while before it counted.
      for (double reach = stable - unstable; first.real() > 0; reach *= 2) {
        stable += reach;
        here = stable < -length || stable > 2 * length ? Spectrum{} : spectrum_at(stable);
        if (here.empty()) break;
        first = nearest_eigenvalue(here, first);
      }
    }
    const auto value = [&](const Spectrum& s, double along) {
      crossing.at = first + (second - first) * ((along - stable) / (unstable - stable));
      return crossing_value(s, crossing).value_or(0);
    };
    const double at_stable = value(here, stable), at_unstable = value(there, unstable);
    if (!(at_stable < 0 && at_unstable > 0)) continue;
    const double ends[] = {std::min(stable, unstable), std::max(stable, unstable)};
    double last = at_unstable;
    const auto of_state = [&](const BranchState& s, double along) {
      return last = value(spectrum(s), along);
    };
    const auto located = locate(state, ends[0], forth ? at_stable : at_unstable, ends[1],
                                forth ? at_unstable : at_stable, next, of_state);
    const double jump = std::max(1e-5, 10 * tolerance::special_point / (ends[1] - ends[0]));
    if (std::abs(last) > jump * std::max(-at_stable, at_unstable)) continue;
    return PairPlace{crossing.coalescence ? SpecialPointType::flutter : SpecialPointType::hopf, located.first,
                     parameter_error(state, located.first, located.second, of_state)};
  }
  return {};
}

// Where nothing goes through zero smoothly the number of eigenvalues itself is followed, as at a corner of
// the branch. Nothing where only real ones cross.
std::optional<BranchFollower::PairPlace> BranchFollower::jumping_pair(const BranchState& state,
                                                                      CrossingBracket at) {
  BranchState low, high;
  int iterations = 0;
  if (!narrow(state, tolerance::special_point, at) || !continuation_.step(state, at.low, low, iterations) ||
      !continuation_.step(state, at.high, high, iterations))
    return {};
  const bool forth = at.right_high > at.right_low;
  const auto crossings = possible_crossings(spectrum(forth ? high : low),
                                            std::abs(at.right_high - at.right_low), state.one_of_many());
  if (crossings.empty()) return {};
  return PairPlace{crossings[0].coalescence ? SpecialPointType::flutter : SpecialPointType::hopf, high, {}};
}

} // namespace flyball
