#include "engine/study/design.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/extended_balance.hpp"
#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/report/report.hpp"
#include "engine/report/turned_measures.hpp"
#include "engine/search/all_equilibria.hpp"
#include "engine/search/turned_rates.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/sensitivity.hpp"
#include "engine/study/wanted.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace flyball {
namespace {

class Designer {
 public:
  Designer(const Mechanism& mechanism, const std::string& address, double from, double to,
           const std::string& coordinate, double value, const DesignOptions& options)
      : mechanism_(mechanism), address_(address), from_(from), to_(to), name_(coordinate), value_(value),
        options_(options),
        system_(compile_for_drives(inside_ranges(mechanism, std::array{NumberRange{address, from, to}})
                                       .value_or(with_parameter(mechanism, address, from)))),
        wanted_(find_wanted(mechanism, system_, coordinate)) {}

  DesignAnswer run() {
    const auto begin = std::chrono::steady_clock::now();
    out_.wanted = name_;
    out_.value = value_;
    if (const CoordinateInfo* c = wanted_.coordinate) {
      const TreeJoint& joint = system_.tree_joints[static_cast<std::size_t>(c->tree_joint)];
      out_.coordinate = {joint.name, c->index, coordinate_count(joint.type), c->angle, false, value_, 0};
    }
    out_.unit = unit_of(mechanism_, system_, wanted_);
    BranchOptions follow;
    follow.largest_step = options_.largest_step;
    follow.eigenvalues = false;
    follow.dense_up_to = 0;
    follow.all = options_.all;
    follow.cancel = options_.cancel;
    follow.progress = options_.progress;
    diagram_ = follow_branches(mechanism_, address_, from_, to_, follow);
    out_.status = diagram_.status;
    out_.message = diagram_.message;
    if (diagram_.branches.empty()) {
      if (std::string why = asked_of_friction(with_parameter(mechanism_, address_, from_),
                                              "Numbers are solved for", options_.cancel);
          !why.empty())
        out_.message = std::move(why);
    } else {
      find_range();
      prepare(diagram_.turned);
      solve_along();
      conclude();
    }
    out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(out_);
  }

 private:
  static constexpr double slack = 1e-9;          // of unit(): what differs by less is the same
  static constexpr double same_parameter = 1e-8; // of the range

  // For branches of states that stand turned against the drawn pose, or of others.
  void prepare(bool turned) {
    scale_ = scale_of_measure(value_, out_.lowest, out_.highest);
    balance_.emplace(system_, with_parameter(mechanism_, address_, from_), std::vector{address_},
                     Eigen::VectorXd::Constant(1, std::abs(to_ - from_)),
                     std::vector{wanted_is(wanted_, value_, out_.lowest, out_.highest)}, false,
                     turned ? ties() : std::nullopt);
  }

  std::optional<AngleTies> ties() const {
    Parameters parameters;
    Scaling scaling;
    Eigen::VectorXd drawn;
    Workspace w;
    bind(system_, with_parameter(mechanism_, address_, from_), parameters);
    set_scaling(system_, parameters, scaling);
    drawn_configuration(system_, parameters, drawn);
    return find_angle_ties({system_, parameters, scaling, options_.cancel}, drawn, w);
  }

  void solve_along() {
    const Interruptible scope(options_.cancel);
    try {
      for (std::size_t b = 0; b < diagram_.branches.size() && !cancelled(); ++b) {
        report_progress(options_.progress, "solving for the value",
                        static_cast<double>(b) / static_cast<double>(diagram_.branches.size()));
        along(b);
      }
    } catch (const Interrupted&) { // what was found until then stays
    }
  }

  bool cancelled() const { return options_.cancel && options_.cancel->load(std::memory_order_relaxed); }
  // What differences of values are measured by.
  double unit() const { return scale_of(system_, balance_->problem().parameters, wanted_).value_or(scale_); }
  double away(double value) const {
    return away_from(system_, balance_->problem().parameters, wanted_, value, value_);
  }
  // Not a number where the measure is undefined.
  double value_of(const ResponsePoint& p) const {
    if (!wanted_.coordinate)
      return p.measures[wanted_.measure].value.value_or(std::numeric_limits<double>::quiet_NaN());
    const auto& joint = out_.coordinate.joint;
    const auto found = std::ranges::find_if(p.coordinates, [&](const CoordinateSolution& c) {
      return c.joint == joint && c.index == wanted_.coordinate->index;
    });
    return found->speed.value_or(found->value);
  }

  void find_range() {
    out_.lowest = std::numeric_limits<double>::infinity();
    out_.highest = -out_.lowest;
    for (const ResponseBranch& b : diagram_.branches)
      for (const ResponsePoint& p : b.points) {
        if (!std::isfinite(value_of(p))) continue;
        out_.lowest = std::min(out_.lowest, value_of(p));
        out_.highest = std::max(out_.highest, value_of(p));
      }
  }

  // Brackets every crossing of the wanted value on a branch, and where it turns close by.
  void along(std::size_t branch) {
    if (const bool turned = diagram_.turned && diagram_.branches[branch].connected;
        turned != balance_->ties().has_value())
      prepare(turned);
    const std::vector<ResponsePoint>& points = diagram_.branches[branch].points;
    std::vector<double> d;
    for (const ResponsePoint& p : points)
      d.push_back(away(value_of(p)) / unit());
    for (std::size_t i = 0; i < d.size() && !cancelled(); ++i) {
      const bool last = i + 1 == d.size();
      if (!last && std::abs(d[i]) < 1e-9 && std::abs(d[i + 1]) < 1e-9) {
        constant_ = true; // nothing singles out one of these parameters
        continue;
      }
      if (last && i > 0 && std::abs(d[i]) < 1e-9 && std::abs(d[i - 1]) < 1e-9) continue;
      if (d[i] == 0 || ((last || i == 0) && std::abs(d[i]) < 1e-9)) {
        solve(branch, points[i], points[i], 0); // an end of the range may be short of it by rounding
      } else if (!last && d[i] * d[i + 1] < 0 && std::abs(d[i] - d[i + 1]) < 1) {
        solve(branch, points[i], points[i + 1], d[i] / (d[i] - d[i + 1]));
      } else if (i > 0 && !last && std::abs(d[i]) <= std::abs(d[i - 1]) &&
                 std::abs(d[i]) <= std::abs(d[i + 1]) && d[i] * d[i - 1] > 0) {
        // A turn of the coordinate here may reach the value between the points: where the parabola does.
        const double slope = (d[i + 1] - d[i - 1]) / 2, bend = d[i + 1] - 2 * d[i] + d[i - 1];
        const double discriminant = slope * slope - 2 * bend * d[i];
        if (bend == 0 || discriminant < -0.1 * bend * bend) continue;
        std::array<std::optional<std::size_t>, 2> found;
        for (std::size_t k = 0; k < 2; ++k) {
          const double at = (-slope + (k == 0 ? -1 : 1) * std::sqrt(std::max(0., discriminant))) / bend;
          if (std::abs(at) <= 1)
            found[k] = solve(branch, points[i], points[at < 0 ? i - 1 : i + 1], std::abs(at));
        }
        if (const auto one = found[0] ? found[0] : found[1]; one && (!found[1] || found[1] == one))
          solve_beyond_turn(branch, out_.solutions[*one], points[i - 1], points[i], points[i + 1],
                            {d[i - 1] * unit(), d[i + 1] * unit()});
      }
    }
  }

  // Three points of a branch stand on one side of the value, by `off` the outer two, and one solution between
  // them is known, where it crosses the value: there is another one where it comes back. It is sought along
  // the parabola through that solution, with its slope, and the outer point towards which it comes back.
  void solve_beyond_turn(std::size_t branch, const DesignSolution& known, const ResponsePoint& before,
                         const ResponsePoint& turn, const ResponsePoint& after,
                         const std::array<double, 2>& off) {
    if (!known.rate || *known.rate == 0 || !(off[0] * off[1] > 0)) return;
    const double first = known.parameter, rate = *known.rate;
    const bool upwards = (rate < 0) == (off[0] > 0), forth = (after.parameter > before.parameter) == upwards;
    const ResponsePoint& end = forth ? after : before;
    const double width = end.parameter - first;
    if ((first > before.parameter) == (first > after.parameter)) return; // not one of these
    if ((width > 0) != upwards ||
        (turn.parameter - before.parameter > 0) != (after.parameter > turn.parameter))
      return; // it folds
    const double bend = (off[forth ? 1 : 0] - rate * width) / (width * width);
    if (bend == 0) return;
    const double second = first - rate / bend;
    if (std::abs(second - first) < same_parameter * std::abs(to_ - from_)) return; // a double root
    const std::size_t solutions = out_.solutions.size();
    for (double part : {0., 0.25, 0.5, 0.75}) { // of the way on to the outer point
      const double there = second + part * (end.parameter - second);
      const bool beside_end = (there > turn.parameter) == (end.parameter > turn.parameter);
      const ResponsePoint& b = beside_end ? end : forth ? before : after;
      solve(branch, turn, b, (there - turn.parameter) / (b.parameter - turn.parameter));
      if (out_.solutions.size() > solutions) return;
    }
  }

  // From a part of the way between two points of a branch, else from either. Which of the solutions it is.
  std::optional<std::size_t> solve(std::size_t branch, const ResponsePoint& a, const ResponsePoint& b,
                                   double part) {
    const double near =
        std::abs(b.parameter - a.parameter) + 2 * options_.largest_step * std::abs(to_ - from_);
    for (double t : {part, 0., 1., 0.5}) {
      ExtendedState state;
      state.parameters = Eigen::VectorXd::Constant(1, a.parameter + t * (b.parameter - a.parameter));
      state.starts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system_.links.size()));
      balance_->set(state);
      const Problem problem = balance_->problem();
      if (const auto& ties = balance_->ties()) {
        state.starts = starts_of(problem, a.coordinates);
        turn_along(*ties, t * angles_between(problem, *ties, state.starts, starts_of(problem, b.coordinates)),
                   state.starts);
        balance_->set(state);
      }
      state.z.q = configuration_of(problem, a.coordinates);
      const Eigen::VectorXd other = configuration_of(problem, b.coordinates);
      const Eigen::VectorXd step =
          t * scaled_difference(problem, state.z.q, other).cwiseProduct(problem.scaling.column);
      retract<double>(system_, step, state.z.q);
      const ExtendedOutcome outcome = balance_->correct(state, {});
      const double p = state.parameters[0];
      if (!outcome.converged || std::abs(p - a.parameter) > near) continue;
      const double edge = 1e-12 * std::abs(to_ - from_);
      if (p < std::min(from_, to_) - edge || p > std::max(from_, to_) + edge) return {};
      return keep(branch, state, outcome);
    }
    return {};
  }

  std::size_t keep(std::size_t branch, const ExtendedState& state, const ExtendedOutcome& outcome) {
    const Problem problem = balance_->problem();
    for (std::size_t i = 0; i < states_.size(); ++i)
      if (std::abs(states_[i].parameters[0] - state.parameters[0]) < same_parameter * std::abs(to_ - from_) &&
          same_pose(problem, states_[i].z.q, state.z.q, 1e-6) && same_angles(problem, states_[i], state))
        return i;
    states_.push_back(state);
    DesignSolution s;
    s.parameter = state.parameters[0];
    const double epsilon = std::numeric_limits<double>::epsilon();
    const Eigen::VectorXd last = outcome.step.cwiseAbs();
    s.parameter_error = last[last.size() - 1] * balance_->scales()[0] + 2 * epsilon * std::abs(s.parameter);
    const Eigen::VectorXd error =
        last.head(system_.nv).cwiseProduct(problem.scaling.column) + 4 * epsilon * problem.scaling.column;
    s.residual = outcome.residual;
    s.iterations = outcome.iterations;
    s.branch = static_cast<int>(branch);
    s.connected = diagram_.branches[branch].connected;
    Workspace& w = balance_->workspace();
    s.at = response_point(balance_->mechanism(), balance_->judged(), state.z, error, {true, true, &measures_},
                          w);
    s.at.parameter = s.parameter;
    if (balance_->ties()) {
      s.rate = rate_of_turned(problem, state);
      out_.solutions.push_back(std::move(s));
      return out_.solutions.size() - 1;
    }
    const auto rates = sensitivities(factor_at(problem, state.z, w), balance_->mechanism(), {&address_, 1});
    if (!rates.empty() && rates[0].size() == system_.nv) {
      if (wanted_.coordinate)
        s.rate = found_gradient(system_, problem.parameters, state.z.q, *wanted_.coordinate).dot(rates[0]);
      else if (const double rate =
                   measures_.rates_along(problem, balance_->mechanism(), {&address_, 1}, state.z.q, rates,
                                         w)(static_cast<Eigen::Index>(wanted_.measure), 0);
               std::isfinite(rate))
        s.rate = rate;
    }
    out_.solutions.push_back(std::move(s));
    return out_.solutions.size() - 1;
  }

  bool same_angles(const Problem& problem, const ExtendedState& a, const ExtendedState& b) const {
    const auto& ties = balance_->ties();
    return !ties || largest_size(angles_between(problem, *ties, a.starts, b.starts)) < 1e-6;
  }

  // Of what is wanted, by the number; nothing where it is not finite.
  std::optional<double> rate_of_turned(const Problem& problem, const ExtendedState& state) {
    Mechanism there = balance_->mechanism();
    VariedNumbers number(there, {&address_, 1});
    Workspace& w = balance_->workspace();
    const auto rates = turned_rates(problem, state.z, *balance_->ties(), there, number, w);
    if (rates.empty() || rates[0].q.size() == 0) return {};
    double rate = 0;
    if (wanted_.coordinate)
      rate = found_gradient(system_, problem.parameters, state.z.q, *wanted_.coordinate).dot(rates[0].q);
    else
      rate = turned_measure_rates(problem, state.z.q, rates[0], measures_, there, number, 0,
                                  w)[static_cast<Eigen::Index>(wanted_.measure)];
    if (!std::isfinite(rate)) return {};
    return rate;
  }

  void conclude() {
    std::ranges::stable_sort(out_.solutions, [](const DesignSolution& a, const DesignSolution& b) {
      const bool x = a.at.stable == true, y = b.at.stable == true;
      if (x != y) return x;
      return a.connected != b.connected ? a.connected : a.parameter < b.parameter;
    });
    out_.status = out_.solutions.empty() ? Status::not_converged : Status::converged;
    out_.end = !out_.solutions.empty() ? DesignEnd::found
               : cancelled()           ? DesignEnd::cancelled
               : constant_             ? DesignEnd::constant
                                       : DesignEnd::never;
    find_covered();
    out_.message = design_message(out_, from_, to_, options_.all,
                                  {.wanted = name_,
                                   .wanted_unit = out_.unit,
                                   .varied = address_,
                                   .varied_unit = parameter_unit(mechanism_, address_),
                                   .shown = {},
                                   .shown_varied = {}});
  }

  // -1.4 to 1.4 and 3.14159: what the branches cover, together where they overlap.
  void find_covered() {
    std::vector<std::array<double, 2>> parts;
    for (const ResponseBranch& b : diagram_.branches) {
      double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
      for (const ResponsePoint& p : b.points) {
        if (!std::isfinite(value_of(p))) continue;
        lowest = std::min(lowest, value_of(p));
        highest = std::max(highest, value_of(p));
      }
      if (lowest <= highest) parts.push_back({lowest, highest});
    }
    std::ranges::sort(parts);
    for (const auto& part : parts) {
      if (!out_.covered.empty() && part[0] <= out_.covered.back()[1] + slack * unit())
        out_.covered.back()[1] = std::max(out_.covered.back()[1], part[1]);
      else
        out_.covered.push_back(part);
    }
    for (auto& [lowest, highest] : out_.covered) // what differs by rounding is one
      if (highest <= lowest + slack * unit()) highest = lowest;
  }

  const Mechanism& mechanism_;
  const std::string& address_;
  double from_, to_;
  const std::string& name_;
  double value_; // in SI units
  const DesignOptions& options_;
  System system_;
  Wanted wanted_;
  double scale_ = 1; // of the measure wanted
  MeasureSet measures_;
  std::optional<ExtendedBalance> balance_; // once the branches are known
  ResponseDiagram diagram_;
  std::vector<ExtendedState> states_;
  bool constant_ = false;
  DesignAnswer out_;
};

// Both ends of a range, with as many digits as tell them apart, or the same text where only rounding does.
std::array<std::string, 2> told_apart(double lowest, double highest) {
  constexpr int enough = 6, most = 12;
  std::array<std::string, 2> texts;
  for (int digits = enough; digits <= most && texts[0] == texts[1]; ++digits)
    texts = {rounded_text(lowest, digits), rounded_text(highest, digits)};
  return texts[0] != texts[1] ? texts
                              : std::array{rounded_text(lowest, enough), rounded_text(lowest, enough)};
}

} // namespace

std::string design_message(const DesignAnswer& answer, double from, double to, bool all,
                           const DesignWords& words) {
  if (answer.end == DesignEnd::no_branch) return answer.message;
  if (answer.end == DesignEnd::cancelled) return "Cancelled.";
  const auto with = [](std::string number, const std::string& unit) {
    return unit.empty() ? number : number + " " + unit;
  };
  const auto shown = [&](double value) { return words.shown ? words.shown(value) : value; };
  const auto varied = [&](double value) {
    return number_text(words.shown_varied ? words.shown_varied(value) : value);
  };
  const std::string value = with(number_text(shown(answer.value)), words.wanted_unit);
  if (answer.end == DesignEnd::constant)
    return words.wanted + " is " + value + " all along a branch: no value of " + words.varied +
           " is singled out.";
  const std::string limits =
      words.varied + " from " + varied(from) + " to " + with(varied(to), words.varied_unit);
  const std::string open = all ? " The search for branches is bounded; there may be more."
                               : " Branches that nothing connects with the drawn pose's were not followed.";
  if (const std::size_t n = answer.solutions.size(); n > 0)
    return std::to_string(n) + (n == 1 ? " solution" : " solutions") + " with " + limits + "." + open;
  std::string covered;
  bool stays = false;
  for (std::size_t i = 0; i < answer.covered.size(); ++i) {
    const auto [from_text, to_text] = told_apart(shown(answer.covered[i][0]), shown(answer.covered[i][1]));
    if (i > 0) covered += i + 1 == answer.covered.size() ? " and " : ", ";
    covered += with(from_text, words.wanted_unit);
    stays = from_text == to_text;
    if (!stays) covered += " to " + with(to_text, words.wanted_unit);
  }
  stays = stays && answer.covered.size() == 1;
  return words.wanted + " never is " + value + " with " + limits +
         (covered.empty() ? ": it has no value there."
          : stays         ? ": it stays at " + covered + "."
                          : ": it covers " + covered + ".") +
         open;
}

DesignAnswer design(const Mechanism& mechanism, const std::string& address, double from, double to,
                    const std::string& coordinate, double value, const DesignOptions& options) {
  return Designer(mechanism, address, from, to, coordinate, value, options).run();
}

} // namespace flyball
