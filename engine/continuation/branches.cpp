#include "engine/continuation/branches.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/unknown_speeds.hpp"
#include "engine/kkt/configuration_difference.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "engine/report/messages.hpp"
#include "engine/search/all_equilibria.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/search/phase_search.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/solve/existence.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace flyball {
namespace {

constexpr double off_crossing = 0.01; // scaled: how far from a crossing a branch off it is looked for

} // namespace

void expect_no_found_speed(const Mechanism& mechanism, const std::string& address) {
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      const auto& drive = joint.coordinates[i].drive;
      if (drive && drive->torque && address == drive_speed_address(joint, i))
        throw SceneError(address,
                         "is found by the drive's torque, and this is where the search for it begins; "
                         "expected another number, such as its load");
    }
}

namespace {

// Gathers the branches of one diagram.
class Diagram {
 public:
  Diagram(const Mechanism& mechanism, const std::string& address, double from, double to,
          const BranchOptions& options)
      : mechanism_(mechanism), address_(address), from_(from), to_(to), options_(options),
        follower_(mechanism, address, from, to, options) {}

  ResponseDiagram from_drawn() {
    const auto begin = std::chrono::steady_clock::now();
    const Interruptible scope(options_.cancel);
    try {
      from_drawn_pose();
      off_crossings(true);
      beside_singular_loops();
      if (options_.all) from_all_equilibria();
    } catch (const Interrupted&) {
      if (out_.branches.empty()) out_.message = "Cancelled.";
    }
    drop_folds_at_crossings();
    if (out_.status == Status::converged && out_.message.empty()) out_.message = summary();
    for (const std::string& note :
         {begun_, bands(), kinks(), unknown_speeds(out_, address_), follower_.limits()})
      if (out_.status == Status::converged && !note.empty()) out_.message += " " + note;
    out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(out_);
  }

  std::optional<ResponseDiagram> through(const ResponsePoint& state) {
    const auto begin = std::chrono::steady_clock::now();
    const Interruptible scope(options_.cancel);
    try {
      if (!from_state(state)) return std::nullopt;
      off_crossings(true);
      beside_singular_loops();
    } catch (const Interrupted&) {
      if (out_.branches.empty()) throw;
    }
    drop_folds_at_crossings();
    out_.status = Status::converged;
    const auto through = std::ranges::count(out_.branches, true, &ResponseBranch::connected);
    out_.message = std::to_string(through) + (through == 1 ? " branch" : " branches") +
                   " through the present state" + (follower_.cancelled() ? "; cancelled." : ".");
    for (const std::string& note : {kinks(), unknown_speeds(out_, address_), follower_.limits()})
      if (!note.empty()) out_.message += " " + note;
    out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(out_);
  }

 private:
  // The first point that stands on one, and how many others do.
  std::string kinks() const {
    const ResponsePoint* first = nullptr;
    int count = 0;
    for (const ResponseBranch& branch : out_.branches)
      for (const ResponsePoint& point : branch.points)
        if (!point.kinks.empty() && count++ == 0) first = &point;
    if (!first) return "";
    return "At " + address_ + " = " + rounded_text(first->parameter, 6) +
           (count > 1 ? " and " + std::to_string(count - 1) + " more points: " : ": ") + first->kinks;
  }

  bool room() const { return static_cast<int>(followed_.size()) < room_; }
  bool going() const { return room() && !follower_.cancelled(); }

  // At every phase of the drives.
  bool holds(const Problem& problem, const Unknowns& z) {
    return check_existence(problem, z.q, sample_phases(problem.system, problem.parameters, z.q),
                           follower_.workspace())
        .holds;
  }

  // Where solving leads from a start: by Newton-Raphson to the nearest, or to the answer.
  std::optional<Unknowns> steady_state(const Problem& problem, const Eigen::VectorXd& start, bool nearest) {
    Found found;
    std::vector<double> history;
    find_equilibrium(problem, start, nearest, false, follower_.workspace(), history, found);
    if (found.status != Status::converged || !holds(problem, found.z)) return {};
    return std::move(found.z);
  }

  // Moves the beginning of the range to where a mechanism can be made first. Throws SceneError where none can
  // at any of many values.
  void begin_where_possible() {
    constexpr int samples = 64;
    constexpr double inside = 1e-6; // of the range
    const double range = to_ - from_;
    const auto possible = [&](double value) {
      try {
        follower_.problem_at(value);
        return true;
      } catch (const SceneError&) {
        return false;
      }
    };
    if (possible(from_)) return;
    int first = 1;
    while (first <= samples && !possible(from_ + range * first / samples))
      ++first;
    if (first > samples) follower_.problem_at(from_); // throws, saying why
    double none = from_ + range * (first - 1) / samples, some = from_ + range * first / samples;
    while (std::abs(some - none) > inside * std::abs(range)) {
      const double middle = (none + some) / 2;
      (possible(middle) ? some : none) = middle;
    }
    try {
      follower_.problem_at(none);
    } catch (const SceneError& error) {
      begun_ = std::string("Before its beginning no mechanism can be made: ") + error.what() + ".";
    }
    from_ = some;
  }

  void from_drawn_pose() {
    report_progress(options_.progress, "solving at the start");
    begin_where_possible();
    const Problem problem = follower_.problem_at(from_);
    Workspace& w = follower_.workspace();
    Eigen::VectorXd start;
    drawn_configuration(problem.system, problem.parameters, start);
    Found found;
    std::vector<double> history;
    find_equilibrium(problem, start, true, false, w, history, found);
    Existence existence;
    if (found.status == Status::converged)
      existence = check_existence(problem, found.z.q,
                                  sample_phases(problem.system, problem.parameters, found.z.q), w);
    std::optional<OtherStates> others;
    if ((found.status != Status::converged || !existence.holds) && !problem.cancelled()) {
      SteadyState other;
      other.find(problem, start, start, {.seconds = SolveOptions{}.search});
      others = other.others;
      if (other.holds) {
        begun_ +=
            (begun_.empty() ? "" : " ") +
            std::string("It begins at a steady state that a search found: the drawn pose leads to none.");
        found = std::move(other.found);
        existence = other.existence;
      }
    }
    if (found.status != Status::converged || !existence.holds) {
      const Stability none;
      const std::string unit = parameter_unit(mechanism_, address_);
      const std::optional<TurnedState> turned = find_turned(problem, start);
      out_.turned = turned && options_.turned;
      if (out_.turned && ties_stay(turned->ties, start)) return follow_turned(*turned);
      if (!turned) out_.status = found.status == Status::converged ? Status::no_steady_state : found.status;
      const std::string why =
          out_.turned
              ? "The steady state stands turned against the drawn pose, and what is varied changes which "
                "angles are tied to each other, as a gear's ratio does: it is not followed. A sweep "
                "solves at each value by itself."
          : turned
              ? "The steady state stands turned against the drawn pose, and at other values otherwise: it is "
                "not followed."
              : failure_message({follower_.mechanism(), problem, found, existence, none}, w).text +
                    (others ? " " + message(*others, found.status) : "");
      out_.message =
          "At " + address_ + " = " + rounded_text(from_, 6) + (unit.empty() ? "" : " " + unit) + ": " + why;
      return;
    }
    out_.status = Status::converged;
    const double border = from_;
    std::optional<BranchState> first;
    if (const Eigen::Index neutral = count_neutral(problem, found.z); neutral > 0)
      first = begin_beside(start, neutral);
    beside_ = first.has_value();
    if (!first) first = follower_.begin(found.z, from_, true);
    if (first) {
      FollowedBranch branch = follower_.follow(*first, true);
      if (first->parameter != border) // it could not begin there itself
        begin_at_border(border, *first, beside_ ? first->z : found.z, branch);
      add(std::move(branch), true);
    } else
      out_.message = "The start is a singular state; begin beside it.";
    from_answer(start, first_value());
  }

  // At which states are looked for at the beginning of the range: where branches begin beside it, so far
  // inside that they are told from each other.
  double first_value() const {
    constexpr double inside = 1e-3; // of the range
    return beside_ ? from_ + inside * (to_ - from_) : from_;
  }

  // In how many directions nothing resists; one for any number where pivots tell it.
  Eigen::Index count_neutral(const Problem& problem, const Unknowns& z) {
    const Stability at = find_stability(factor_at(problem, z, follower_.workspace()), false);
    return std::max<Eigen::Index>(at.neutral_directions.cols(), at.neutral.empty() ? 0 : 1);
  }

  // Where nothing resists some direction at the beginning of the range alone, as of a load that begins at
  // zero: from a state a little inside, where the range begins then. None where as many are so there, too.
  std::optional<BranchState> begin_beside(const Eigen::VectorXd& start, Eigen::Index neutral) {
    constexpr double inside = 1e-6; // of the range
    const double value = from_ + inside * (to_ - from_);
    std::optional<BranchState> out;
    try {
      const Problem problem = follower_.problem_at(value);
      const auto z = steady_state(problem, start, true);
      if (z && count_neutral(problem, *z) < neutral) out = follower_.begin(*z, value, true);
      if (out) follower_.begin_range_at(from_ = value);
    } catch (const SceneError&) { // no mechanism can be made there
    }
    follower_.problem_at(from_);
    return out;
  }

  // Puts the state at `value`, where the range begins, before the branch: `z` or what Newton-Raphson makes of
  // it there, where that is beside the first.
  void begin_at_border(double value, const BranchState& first, const Unknowns& z, FollowedBranch& branch) {
    constexpr double near = 1e-3; // scaled
    BranchState border = first;
    border.z = z;
    border.parameter = value;
    const Problem problem = follower_.problem_at(value);
    if (!newton(problem, border.z, follower_.workspace(), {}, nullptr).converged ||
        !same_pose(problem, border.z.q, first.z.q, near))
      return;
    branch.points.insert(branch.points.begin(), follower_.point(border));
    branch.states.insert(branch.states.begin(), std::move(border));
  }

  // With what turns at other angles than drawn, where drives give torques.
  std::optional<TurnedState> find_turned(const Problem& problem, const Eigen::VectorXd& start) {
    if (problem.system.torques.empty() || problem.cancelled()) return {};
    const Problem dense{problem.system, problem.parameters, problem.scaling, problem.cancel};
    return find_turned_state(dense, start, follower_.workspace());
  }

  void follow_turned(const TurnedState& state) {
    out_.status = Status::converged;
    begun_ = "The steady state stands turned against the drawn pose.";
    const auto first = follower_.begin(state, from_, true);
    if (!first) {
      out_.message = "The start is a singular state; begin beside it.";
      return;
    }
    add(follower_.follow(*first, true), true);
  }

  // Whether these are the ties in all of the range.
  bool ties_stay(const AngleTies& ties, const Eigen::VectorXd& start) {
    bool stay = false;
    try {
      const Problem there = follower_.problem_at(to_);
      const auto others = find_angle_ties({there.system, there.parameters, there.scaling, there.cancel},
                                          start, follower_.workspace());
      stay = there.form == KktForm::dense && others && tie_alike(ties, *others);
    } catch (const SceneError&) { // no mechanism can be made there
    }
    follower_.problem_at(from_);
    return stay;
  }

  // Newton-Raphson may have stopped at another state than the answer that solving gives, which has its
  // branch, too. Where torques drive that may be the one which the motion from the start comes to.
  void from_answer(const Eigen::VectorXd& start, double value) try {
    const Problem problem = follower_.problem_at(value);
    std::optional<Unknowns> z;
    if (problem.system.torques.empty()) {
      z = steady_state(problem, start, false);
    } else {
      SteadyState answer;
      answer.find(problem, start, start, {.seconds = SolveOptions{}.search});
      if (answer.holds) z = std::move(answer.found.z);
    }
    if (!z) return;
    const auto first = follower_.begin(*z, value, true);
    if (!first || known(*first)) return;
    if (value == from_)
      add(follower_.follow(*first, out_.branches.empty()), true);
    else if (const auto back = follower_.begin(*z, value, false))
      add_both_ways(*first, *back, false, true);
    out_.message.clear();
  } catch (const SceneError&) { // no mechanism can be made there
    if (value == from_) throw;
  }

  // Where loops are singular the balance does not tell where another branch leaves, as those of a governor
  // whose arms hang on its axis: what solving gives from the drawn pose at some values there has its branch.
  void beside_singular_loops() {
    std::vector<double> values;
    for (const FollowedBranch& branch : followed_) {
      std::vector<double> singular;
      for (const ResponsePoint& point : branch.points)
        if (point.singular_loops) singular.push_back(point.parameter);
      if (singular.empty()) continue;
      for (const double value : {singular.back(), singular[singular.size() / 2], singular.front()})
        if (std::ranges::find(values, value) == values.end()) values.push_back(value);
    }
    for (const double value : values) {
      if (!going()) return;
      follower_.untie();
      const Problem problem = follower_.problem_at(value);
      Eigen::VectorXd start;
      drawn_configuration(problem.system, problem.parameters, start);
      const auto z = steady_state(problem, start, false);
      if (!z) continue;
      const auto forth = follower_.begin(*z, value, true), back = follower_.begin(*z, value, false);
      if (!forth || !back || known(*forth)) continue;
      add_both_ways(*forth, *back, false, false);
      const bool meets = std::ranges::any_of(crossings_, [&](const BranchState& crossing) {
        return std::ranges::any_of(std::array{off_crossing, -off_crossing}, [&](double length) {
          const auto state = follower_.off(crossing, length);
          return state && known(*state);
        });
      });
      out_.branches.back().connected = meets;
      off_crossings(true);
    }
  }

  // False where there is no steady state near it, or it is singular.
  bool from_state(const ResponsePoint& state) {
    report_progress(options_.progress, "solving at the present state");
    const Problem problem = follower_.problem_at(state.parameter);
    Workspace& w = follower_.workspace();
    Unknowns z{configuration_of(problem, state.coordinates), Eigen::VectorXd::Zero(problem.system.rows)};
    if (!newton(problem, z, w, {}, nullptr).converged) return false;
    if (!holds(problem, z)) return false;
    const auto forth = follower_.begin(z, state.parameter, true),
               back = follower_.begin(z, state.parameter, false);
    if (!forth || !back) return false;
    add_both_ways(*forth, *back, true, true);
    return true;
  }

  void add_both_ways(const BranchState& forth, const BranchState& back, bool tell_progress, bool connected) {
    add_both_ways(follower_.follow(forth, tell_progress), back, connected);
  }

  void add_both_ways(FollowedBranch ahead, const BranchState& back, bool connected) {
    if (ahead.closed) return add(std::move(ahead), connected);
    FollowedBranch behind = follower_.follow(back, false);
    std::string begin = behind.end;
    add(joined(std::move(behind), std::move(ahead)), connected, std::move(begin));
  }

  // A branch that turns back in the crossing itself, as the bent one of a fork does, has no fold of its own.
  void drop_folds_at_crossings() {
    const auto same_place = [&](const ResponsePoint& a, const ResponsePoint& b) {
      return std::abs(a.parameter - b.parameter) <= 1e-6 * std::abs(to_ - from_) &&
             scaled_distance(a.coordinates, b.coordinates) <= 1e-3;
    };
    std::erase_if(out_.special, [&, crossings = out_.special](const SpecialPoint& fold) {
      return fold.type == SpecialPointType::fold &&
             std::ranges::any_of(crossings, [&](const SpecialPoint& other) {
               return other.type == SpecialPointType::branch_point && same_place(fold.at, other.at);
             });
    });
  }

  // Bands of parametric instability may be narrower than the points lie apart.
  std::string bands() const {
    double widest = 0;
    for (const ResponseBranch& branch : out_.branches)
      for (std::size_t i = 1; i < branch.points.size(); ++i)
        if (branch.points[i].stability_reason == StabilityReason::floquet)
          widest = std::max(widest, std::abs(branch.points[i].parameter - branch.points[i - 1].parameter));
    if (!(widest > 0)) return "";
    return "Where Floquet's multipliers judge, points lie up to " + rounded_text(widest, 2) +
           " apart: narrower bands of instability between them go unseen, a smaller range shows them.";
  }

  void add(FollowedBranch branch, bool connected, std::string begin = {}) {
    const int index = static_cast<int>(followed_.size());
    for (auto& [type, point] : branch.special) {
      if (type != SpecialPointType::branch_point) out_.special.push_back({type, std::move(point), index});
    }
    std::size_t crossing = 0;
    for (auto& [type, point] : branch.special) {
      if (type != SpecialPointType::branch_point) continue;
      const BranchState& at = branch.crossings[crossing++];
      if (std::ranges::any_of(found_, [&](const BranchState& other) { return follower_.same(at, other); }))
        continue;
      found_.push_back(at);
      crossings_.push_back(at);
      out_.special.push_back({type, std::move(point), index});
    }
    out_.branches.push_back({branch.points, branch.end, std::move(begin), connected});
    followed_.push_back(std::move(branch));
  }

  bool known(const BranchState& state) {
    const std::vector<BranchState> family = follower_.family(state);
    return std::ranges::any_of(followed_,
                               [&](const FollowedBranch& b) { return follower_.lies_on(family, b); });
  }

  // Both ways off every crossing that is left.
  void off_crossings(bool connected) {
    while (options_.switch_branches && !crossings_.empty() && going()) {
      const BranchState at = std::move(crossings_.back());
      crossings_.pop_back();
      for (double length : {off_crossing, -off_crossing}) {
        if (!going()) return;
        const auto first = follower_.off(at, length);
        if (!first) continue;
        // Of a symmetry all that leave are one family.
        several_ = several_ || (at.twofold && first->still.cols() == at.still.cols());
        if (known(*first)) continue;
        FollowedBranch branch = follower_.follow(*first, false);
        branch.points.insert(branch.points.begin(), follower_.point(at));
        branch.lead = off_crossing;
        add(std::move(branch), connected);
      }
    }
  }

  std::vector<double> values_to_search() const {
    if (!options_.all_at.empty()) return options_.all_at;
    std::vector<double> values{first_value(), to_};
    const double present = get_parameter(mechanism_, address_);
    if (present > std::min(from_, to_) && present < std::max(from_, to_))
      values.insert(values.begin(), present);
    return values;
  }

  // Each value has its share of the room, so that the branches of the first leave some; then what is left is
  // for all.
  void from_all_equilibria() {
    const std::vector<double> values = values_to_search();
    std::vector<std::vector<Unknowns>> left;
    const int before = static_cast<int>(followed_.size());
    for (std::size_t i = 0; i < values.size() && before < options_.max_branches; ++i) {
      const auto part = static_cast<double>(i + 1) / static_cast<double>(values.size());
      room_ = before + static_cast<int>(part * (options_.max_branches - before));
      if (options_.publish && !out_.branches.empty()) options_.publish(so_far());
      left.push_back(follow_from(equilibria_at(values[i]), values[i]));
    }
    room_ = options_.max_branches;
    for (std::size_t i = 0; i < left.size(); ++i)
      crowded_ = !follow_from(std::move(left[i]), values[i]).empty() || crowded_;
  }

  // None where no mechanism can be made.
  std::vector<Unknowns> equilibria_at(double value) try {
    if (follower_.cancelled()) return {};
    follower_.untie();
    report_progress(options_.progress, "looking for other branches");
    Workspace& w = follower_.workspace();
    const Problem problem = follower_.problem_at(value);
    Eigen::VectorXd drawn;
    drawn_configuration(problem.system, problem.parameters, drawn);
    EquilibriumList list = find_all_equilibria(problem, drawn, {}, w);
    out_.searched.push_back(value);
    out_.starts += list.report.starts;
    return std::move(list.states);
  } catch (const SceneError&) {
    if (mechanism_.parameters.empty() && mechanism_.points.empty()) throw;
    return {};
  }

  // Both ways from each of these states at a value that is on no branch yet. Returns those for which there is
  // no room.
  std::vector<Unknowns> follow_from(std::vector<Unknowns> states, double value) try {
    for (std::size_t i = 0; i < states.size() && !follower_.cancelled(); ++i) {
      const Unknowns& z = states[i];
      const Problem problem = follower_.problem_at(value);
      if (!holds(problem, z)) continue;
      const auto forth = follower_.begin(z, value, true), back = follower_.begin(z, value, false);
      // Of a family that is not kept still all would have to be known.
      if (!forth || !back || forth->drifts || known(*forth)) continue;
      if (!room()) {
        states.erase(states.begin(), states.begin() + static_cast<std::ptrdiff_t>(i));
        return states;
      }
      FollowedBranch ahead = follower_.follow(*forth, false);
      if (ahead.drifts && forth->still.cols() > 0) continue; // as it was found to be
      add_both_ways(std::move(ahead), *back, false);
      if (out_.status != Status::converged) {
        out_.message = "Nothing is followed from the drawn pose. " + out_.message;
        out_.status = Status::converged;
      }
      off_crossings(false);
    }
    return {};
  } catch (const SceneError&) {
    if (mechanism_.parameters.empty() && mechanism_.points.empty()) throw;
    return {};
  }

  // One branch of the two ways from one state.
  static FollowedBranch joined(FollowedBranch behind, FollowedBranch ahead) {
    FollowedBranch out;
    const auto join = [](auto& to, auto& first, auto& second, std::ptrdiff_t skip) {
      to.assign(first.rbegin(), first.rend() - skip);
      to.insert(to.end(), second.begin(), second.end());
    };
    join(out.points, behind.points, ahead.points, 1);
    for (BranchState& s : behind.states)
      s.tangent = -s.tangent;
    join(out.states, behind.states, ahead.states, 1);
    join(out.special, behind.special, ahead.special, 0);
    join(out.crossings, behind.crossings, ahead.crossings, 0);
    out.end = std::move(ahead.end);
    return out;
  }

  ResponseDiagram so_far() {
    ResponseDiagram part = out_;
    if (part.message.empty()) part.message = summary();
    return part;
  }

  std::string summary() {
    const auto counted = [](std::size_t n, const char* one, const char* many) {
      return std::to_string(n) + (n == 1 ? one : many);
    };
    std::string text = counted(out_.branches.size(), " branch", " branches");
    if (!out_.searched.empty()) {
      const auto apart =
          static_cast<std::size_t>(std::ranges::count(out_.branches, false, &ResponseBranch::connected));
      if (apart > 0) text += ", " + std::to_string(apart) + " of them not connected with the drawn pose's";
      text += ", by a bounded search at " + counted(out_.searched.size(), " value", " values") +
              " of the parameter; there " + (crowded_ ? "are more, which are not followed" : "may be more");
    }
    if (follower_.cancelled()) text += "; cancelled";
    text += ".";
    if (several_) text += " Where two eigenvalues vanish at once, more branches may leave than are followed.";
    if (follower_.met_drifting())
      text += " Nothing resists some direction: folds and crossings were not looked for.";
    return text;
  }

  const Mechanism& mechanism_;
  const std::string& address_;
  double from_, to_;
  const BranchOptions& options_;
  BranchFollower follower_;
  int room_ = options_.max_branches; // for branches, so far
  bool beside_ = false;              // branches begin beside the beginning of the range
  bool several_ = false;             // branches may leave one crossing, of which one is followed
  bool crowded_ = false;             // there are more than that
  std::vector<FollowedBranch> followed_;
  std::vector<BranchState> crossings_, found_;
  ResponseDiagram out_;
  std::string begun_; // where the drawn pose leads to no steady state
};

} // namespace

std::string_view word(SpecialPointType type) {
  switch (type) {
  case SpecialPointType::fold: return "fold";
  case SpecialPointType::branch_point: return "branch_point";
  case SpecialPointType::hopf: return "hopf";
  case SpecialPointType::flutter: return "flutter";
  case SpecialPointType::parametric: return "parametric";
  case SpecialPointType::slip: return "slip";
  }
  return "";
}

ResponseDiagram follow_branches(const Mechanism& mechanism, const std::string& address, double from,
                                double to, const BranchOptions& options) {
  expect_no_found_speed(mechanism, address);
  return Diagram(mechanism, address, from, to, options).from_drawn();
}

std::optional<ResponseDiagram> follow_branches_through(const Mechanism& mechanism, const std::string& address,
                                                       double from, double to, const ResponsePoint& state,
                                                       const BranchOptions& options) {
  if ((state.parameter - from) * (state.parameter - to) > 0) return std::nullopt;
  return Diagram(mechanism, address, from, to, options).through(state);
}

} // namespace flyball
