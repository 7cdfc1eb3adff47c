#include "engine/study/friction_branches.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/friction_ways.hpp"
#include "engine/report/solve_with_parts.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>

namespace flyball {
namespace {

constexpr int friction_intervals = 60; // of the range, of which each may be halved
constexpr int most_friction_halvings = 7;
constexpr int full_tries =
    6; // where nothing is beside: at every so many values all that solving knows is tried
constexpr double newton_near =
    0.02; // of the gap in which an end is looked for: then Newton-Raphson is enough
constexpr double friction_bend = 2e-3;    // of a value: how far from the straight line a point may lie
constexpr double friction_border = 1e-13; // of the range: how closely ends are located
constexpr int most_edge_steps = 120;

// A state with given parts at a value of the number, whether it goes with them or not.
struct FrictionPlace {
  double number = 0;
  ResponsePoint point;
  std::vector<double> margins;
  bool goes = false;
};

// How far from the middle between two states the third lies in what is followed of a coordinate, where it
// stands or how fast it goes on: a part of the larger of the two, or of a thousandth of what it is measured
// by.
double bend(const CoordinateSolution& from, const CoordinateSolution& middle, const CoordinateSolution& to,
            const CoordinateSolution& here) {
  constexpr double least = 1e-3;
  if (middle.speed && here.speed)
    return std::abs(*here.speed - *middle.speed) /
           std::max({least * middle.speed_scale, std::abs(from.speed.value_or(0)),
                     std::abs(to.speed.value_or(0))});
  return std::abs(value_difference(middle, here)) /
         std::max({least, std::abs(from.value) / from.scale, std::abs(to.value) / to.scale});
}

class FrictionFollower {
 public:
  FrictionFollower(const Mechanism& mechanism, const std::string& address, double from, double to,
                   const BranchOptions& options, ResponseDiagram& diagram)
      : mechanism_(mechanism), address_(address), from_(from), to_(to), options_(options), out_(diagram) {
    for (const ResponseBranch& branch : diagram.branches) {
      const auto [low, high] = std::ranges::minmax(branch.points, {}, &ResponsePoint::parameter);
      covered_.emplace_back(low.parameter, high.parameter);
    }
  }

  void follow() {
    std::vector<Run> runs;
    const std::vector<FrictionParts> all = friction_parts(mechanism_, options_.cancel);
    std::vector<std::pair<FrictionParts, std::pair<double, double>>> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
      held_.clear();
      for (const auto& [parts, range] : found)
        if (holds_more(parts, all[i])) held_.push_back(range);
      const std::size_t before = runs.size();
      follow(all[i], runs, [&](double part) {
        report_progress(options_.progress, "following what rests on friction",
                        (static_cast<double>(i) + part) / static_cast<double>(all.size()));
      });
      for (std::size_t k = before; k < runs.size(); ++k)
        found.emplace_back(all[i], std::minmax(runs[k].places.front().number, runs[k].places.back().number));
    }
    std::ranges::stable_sort(
        runs, {}, [&](const Run& run) { return (run.places.front().number - from_) / (to_ - from_); });
    for (Run& run : runs)
      add(std::move(run));
    if (runs.empty()) return;
    const std::string count =
        std::to_string(runs.size()) + (runs.size() == 1 ? " branch rests" : " branches rest");
    out_.message = out_.status == Status::converged ? out_.message + " " + count + " on friction."
                                                    : count + " on friction; no others were found.";
    out_.status = Status::converged;
  }

 private:
  struct Edge {
    FrictionPlace last; // that goes
    std::string why;    // it goes no farther
    bool slips = false; // a joint begins to slip, or sticks
  };
  struct Run {
    std::vector<FrictionPlace> places;
    std::string begin, end;
    bool slips_at_begin = false, slips_at_end = false;
  };

  double number(int i) const {
    return i == friction_intervals ? to_ : from_ + (to_ - from_) * i / friction_intervals;
  }
  double range() const { return std::abs(to_ - from_); }

  static bool covered(std::span<const std::pair<double, double>> ranges, double number) {
    return std::ranges::any_of(
        ranges, [&](const auto& part) { return part.first <= number && number <= part.second; });
  }
  bool covered(double number) const { return covered(covered_, number) || covered(held_, number); }

  // `beside`: a place from which to begin; null: none. Where there is no state Newton-Raphson alone says so
  // in a fraction of the time.
  std::optional<FrictionPlace> at(const FrictionParts& parts, double number, const FrictionPlace* beside,
                                  bool newton_only = false) const try {
    interruption_point();
    SolveOptions solve;
    solve.cancel = options_.cancel;
    solve.nearest = beside != nullptr;
    solve.search = 0;
    solve.newton_only = newton_only;
    if (beside) solve.start = start_values(beside->point.coordinates);
    auto state = solve_with_parts(with_parameter(mechanism_, address_, number), parts, solve);
    if (!state) return std::nullopt;
    return FrictionPlace{number, response_point(state->solution, number), std::move(state->margins),
                         state->goes};
  } catch (const SceneError&) { // of numbers of which no mechanism can be made
    return std::nullopt;
  }

  void follow(const FrictionParts& parts, std::vector<Run>& runs, const auto& progress) const {
    Run run;
    std::optional<FrictionPlace> before;
    const auto close = [&](std::string why, bool slips) {
      run.end = std::move(why);
      run.slips_at_end = slips;
      if (!run.places.empty()) runs.push_back(std::move(run));
      run = {};
    };
    int none = 0; // the last value at which there is none by all that solving knows
    for (int i = 0; i <= friction_intervals; ++i) {
      progress(static_cast<double>(i) / friction_intervals);
      std::optional<FrictionPlace> now;
      if (!covered(number(i))) {
        if (before) now = at(parts, number(i), &*before);
        const bool newton_only = !before && i % full_tries != 0;
        if (!now) now = at(parts, number(i), nullptr, newton_only);
        if (!now && !newton_only) none = i;
      } else {
        none = i;
      }
      const bool went = before && before->goes, goes = now && now->goes;
      if (went && !goes) {
        Edge edge = find_edge(parts, *before, number(i), now ? &*now : nullptr);
        if (edge.last.number != before->number) append(parts, run, std::move(edge.last));
        close(std::move(edge.why), edge.slips);
      } else if (goes && !went) {
        if (i == 0)
          run.places.push_back(*now);
        else if (before)
          begin(parts, run, {*now}, number(i - 1), &*before);
        else
          begin_back(parts, run, *now, i, none);
      } else if (goes) {
        if (!append(parts, run, *now)) {
          close("solving leads to no state beside it, as at a fold", false);
          run.places.push_back(*now);
          run.begin = "solving leads to no state beside it, as at a fold";
        }
      }
      before = std::move(now);
    }
    close("the end of the range", false);
  }

  // A run that goes at the i-th value, and does not at an earlier one, `none`: as far back as it goes.
  void begin_back(const FrictionParts& parts, Run& run, const FrictionPlace& now, int i, int none) const {
    std::vector<FrictionPlace> good{now}; // backwards
    for (int k = i - 1; k > none; --k) {
      std::optional<FrictionPlace> there = at(parts, number(k), &good.back());
      if (!there || !there->goes) return begin(parts, run, good, number(k), there ? &*there : nullptr);
      good.push_back(std::move(*there));
    }
    begin(parts, run, good, number(none), nullptr);
  }

  // With places that go, backwards, and a value at which there is none, or `bad`, which does not go.
  void begin(const FrictionParts& parts, Run& run, const std::vector<FrictionPlace>& good, double bad_number,
             const FrictionPlace* bad) const {
    Edge edge = find_edge(parts, good.back(), bad_number, bad);
    run.begin = std::move(edge.why);
    run.slips_at_begin = edge.slips;
    run.places.push_back(std::move(edge.last));
    for (auto place = good.rbegin(); place != good.rend(); ++place)
      if (place->number != run.places.front().number) append(parts, run, *place);
  }

  // The next place of a run, with those between that it takes. False where they do not hang together.
  bool append(const FrictionParts& parts, Run& run, FrictionPlace next) const {
    std::vector<FrictionPlace> between;
    const bool whole = refine(parts, run.places.back(), next, most_friction_halvings, between);
    if (!whole) return false;
    std::ranges::move(between, std::back_inserter(run.places));
    run.places.push_back(std::move(next));
    return true;
  }

  // Places between two of which no three that follow one another bend by more than is drawn.
  bool refine(const FrictionParts& parts, const FrictionPlace& a, const FrictionPlace& b, int halvings,
              std::vector<FrictionPlace>& out) const {
    std::optional<FrictionPlace> middle = at(parts, a.number + (b.number - a.number) / 2, &a);
    if (!middle || !middle->goes) return false;
    const std::vector<CoordinateSolution>&from = a.point.coordinates, &to = b.point.coordinates,
          &here = middle->point.coordinates, straight = coordinates_between(from, to, 0.5);
    double most = 0;
    for (std::size_t i = 0; i < here.size(); ++i)
      most = std::max(most, bend(from[i], straight[i], to[i], here[i]));
    if (most <= friction_bend) return true; // it is on the line that is drawn
    if (halvings == 0) return most <= 0.05;
    std::vector<FrictionPlace> before, after;
    if (!refine(parts, a, *middle, halvings - 1, before) || !refine(parts, *middle, b, halvings - 1, after))
      return false;
    std::ranges::move(before, std::back_inserter(out));
    out.push_back(std::move(*middle));
    std::ranges::move(after, std::back_inserter(out));
    return true;
  }

  // Where between a place that goes and a value at which there is none, or one that does not go, it ends.
  Edge find_edge(const FrictionParts& parts, const FrictionPlace& good, double bad_number,
                 const FrictionPlace* bad) const {
    constexpr double never = -std::numeric_limits<double>::infinity();
    const auto margin = [&](const FrictionPlace& place) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < place.margins.size(); ++i)
        if (std::isfinite(good.margins[i]))
          least = std::min(least, place.margins[i] / std::max(good.margins[i], 1e-300));
      return least;
    };
    Edge edge{good, {}, false};
    const double bad_margin = bad ? margin(*bad) : never;
    double low = margin(good), high = bad_margin;
    if (!(low > 0) || !(high < 0)) low = 1, high = never; // within the errors of a rate
    RootBracket bracket(good.number, low, bad_number, high);
    bool is_covered = covered(bad_number);
    edge.slips = std::isfinite(bad_margin); // also where the border is that very number
    for (int i = 0; i < most_edge_steps && bracket.width() > friction_border * range(); ++i) {
      const double here = bracket.next();
      if (here == bracket.low() || here == bracket.high()) break;
      const bool ends = covered(here);
      const std::optional<FrictionPlace> there =
          ends ? std::nullopt
               : at(parts, here, &edge.last,
                    bracket.width() < newton_near * std::abs(bad_number - good.number));
      const double value = there ? margin(*there) : never;
      if (!(value < 0)) {
        edge.last = *there;
      } else {
        edge.slips = std::isfinite(value);
        is_covered = ends;
      }
      if (value == 0) break;
      bracket.take(here, value);
    }
    constexpr double run_out = 1e-6;
    if (!is_covered && margin(edge.last) < run_out) edge.slips = true; // as where its drive stands
    const bool held = is_covered && !covered(covered_, bad_number);
    edge.why = edge.slips   ? "a joint with friction begins to slip, or sticks"
               : held       ? "friction holds what rests here in balance"
               : is_covered ? "a steady state without friction begins"
                            : "solving leads to no state beside it, as at a fold";
    return edge;
  }

  void add(Run run) {
    const int branch = static_cast<int>(out_.branches.size());
    const auto tell_slip = [&](const FrictionPlace& place) {
      const bool known = std::ranges::any_of(out_.special, [&](const SpecialPoint& s) {
        return s.type == SpecialPointType::slip && std::abs(s.at.parameter - place.number) < 1e-9 * range();
      });
      if (!known) out_.special.push_back({SpecialPointType::slip, place.point, branch});
    };
    if (run.slips_at_begin) tell_slip(run.places.front());
    if (run.slips_at_end) tell_slip(run.places.back());
    ResponseBranch& to = out_.branches.emplace_back();
    for (FrictionPlace& place : run.places)
      to.points.push_back(std::move(place.point));
    to.begin = std::move(run.begin);
    to.end = std::move(run.end);
  }

  const Mechanism& mechanism_;
  const std::string& address_;
  double from_, to_;
  const BranchOptions& options_;
  ResponseDiagram& out_;
  std::vector<std::pair<double, double>> covered_; // by branches without friction
  std::vector<std::pair<double, double>> held_;    // by states that hold more than what is followed
};

} // namespace

ResponsePoint response_point(const Solution& s, double parameter) {
  ResponsePoint out;
  out.parameter = parameter;
  out.coordinates = s.coordinates;
  out.stable = s.stable;
  out.stability_reason = s.stability_reason;
  if (s.eigenvalues) out.eigenvalues = *s.eigenvalues;
  out.floquet = s.floquet;
  out.reactions = s.reactions;
  out.drive_torques = s.drive_torques;
  out.measures = s.measures;
  out.singular_loops = s.singular_loops;
  out.frictions = s.frictions;
  return out;
}

void add_friction_branches(const Mechanism& mechanism, const std::string& address, double from, double to,
                           const BranchOptions& options, ResponseDiagram& diagram) {
  if (!has_friction(mechanism)) return;
  const auto begin = std::chrono::steady_clock::now();
  const Interruptible scope(options.cancel);
  try {
    FrictionFollower(mechanism, address, from, to, options, diagram).follow();
  } catch (const Interrupted&) { // what was found stays
  }
  diagram.run_time_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

ResponseDiagram follow_response(const Mechanism& mechanism, const std::string& address, double from,
                                double to, const BranchOptions& options) {
  ResponseDiagram out = follow_branches(mechanism, address, from, to, options);
  add_friction_branches(mechanism, address, from, to, options, out);
  return out;
}

} // namespace flyball
