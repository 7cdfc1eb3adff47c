#include "app/panels/response_follow.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace flyball {

namespace {

constexpr double off_crossing = 0.01; // scaled: how far from a crossing a branch off it is looked for

class Gathering {
 public:
  Gathering(const Mechanism& mechanism, const std::string& address, double from, double to,
            const BranchOptions& options)
      : options_(options), follower_(mechanism, address, from, to, options), range_(std::abs(to - from)) {}

  bool through(const ResponsePoint& state) {
    report_progress(options_.progress, "solving at the present state");
    const Problem problem = follower_.problem_at(state.parameter);
    Workspace& w = follower_.workspace();
    Unknowns z;
    z.q = configuration_of(problem, state.coordinates);
    z.lambda.setZero(problem.system.rows);
    if (!newton(problem, z, w, {}, nullptr).converged) return false;
    if (!check_existence(problem, z.q, sample_phases(problem.system, problem.parameters), w).holds)
      return false;
    if (!find_stability(factor_at(problem, z, w), false).neutral.empty()) follower_.expect_families();
    const auto forth = follower_.begin(z, state.parameter, true),
               back = follower_.begin(z, state.parameter, false);
    if (!forth || !back) return false;
    FollowedBranch ahead = follower_.follow(*forth, true);
    if (!ahead.closed) {
      FollowedBranch behind = follower_.follow(*back, false);
      std::string begin = behind.end;
      add(joined(std::move(behind), std::move(ahead)), std::move(begin));
    } else {
      add(std::move(ahead), {});
    }
    off_crossings();
    return true;
  }

  bool empty() const { return out_.branches.empty(); }

  ResponseDiagram take() {
    // A branch that turns back in the crossing itself, as the bent one of a fork does, has no fold of its
    // own.
    const auto crossed = [&](const SpecialPoint& fold) {
      return fold.type == SpecialPointType::fold &&
             std::ranges::any_of(out_.special, [&](const SpecialPoint& other) {
               return other.type == SpecialPointType::branch_point && same_place(fold.at, other.at);
             });
    };
    std::vector<SpecialPoint> kept;
    for (const SpecialPoint& special : out_.special)
      if (!crossed(special)) kept.push_back(special);
    out_.special = std::move(kept);
    out_.status = Status::converged;
    out_.message = std::to_string(out_.branches.size()) +
                   (out_.branches.size() == 1 ? " branch" : " branches") + " through the present state" +
                   (follower_.cancelled() ? "; cancelled." : ".");
    if (const std::string limits = follower_.limits(); !limits.empty()) out_.message += " " + limits;
    return std::move(out_);
  }

 private:
  bool same_place(const ResponsePoint& a, const ResponsePoint& b) const {
    if (std::abs(a.parameter - b.parameter) > 1e-6 * range_) return false;
    for (std::size_t i = 0; i < a.coordinates.size(); ++i)
      if (std::abs(a.coordinates[i].value - b.coordinates[i].value) > 1e-3) return false; // rad, m
    return true;
  }

  // One branch of the two ways from one state.
  static FollowedBranch joined(FollowedBranch behind, FollowedBranch ahead) {
    for (BranchState& s : behind.states)
      s.tangent = -s.tangent;
    const auto join = [](auto& first, auto& second, std::ptrdiff_t shared) {
      std::ranges::reverse(first);
      first.insert(first.end(), second.begin() + std::min(shared, std::ssize(second)), second.end());
    };
    join(behind.points, ahead.points, 1);
    join(behind.states, ahead.states, 1);
    join(behind.special, ahead.special, 0);
    join(behind.crossings, ahead.crossings, 0);
    behind.end = std::move(ahead.end);
    return behind;
  }

  void add(FollowedBranch branch, std::string begin) {
    const int index = static_cast<int>(followed_.size());
    std::size_t crossing = 0;
    for (auto& [type, point] : branch.special) {
      if (type == SpecialPointType::branch_point) {
        const BranchState& at = branch.crossings[crossing++];
        const auto same = [&](const BranchState& other) { return follower_.same(at, other); };
        if (std::ranges::any_of(met_, same)) continue;
        met_.push_back(at);
        waiting_.push_back(at);
      }
      out_.special.push_back({type, std::move(point), index});
    }
    out_.branches.push_back({branch.points, branch.end, std::move(begin), true});
    followed_.push_back(std::move(branch));
  }

  bool going() const {
    return static_cast<int>(followed_.size()) < options_.max_branches && !follower_.cancelled();
  }

  // Both ways off every crossing.
  void off_crossings() {
    while (!waiting_.empty()) {
      const BranchState at = std::move(waiting_.back());
      waiting_.pop_back();
      for (const double length : {off_crossing, -off_crossing}) {
        if (!going()) return;
        const auto first = follower_.off(at, length);
        const auto on = [&](const FollowedBranch& b) { return follower_.lies_on(*first, b); };
        if (!first || std::ranges::any_of(followed_, on)) continue;
        FollowedBranch branch = follower_.follow(*first, false);
        branch.points.insert(branch.points.begin(), follower_.point(at));
        branch.lead = off_crossing;
        add(std::move(branch), {});
      }
    }
  }

  const BranchOptions& options_;
  BranchFollower follower_;
  double range_;
  std::vector<FollowedBranch> followed_;
  std::vector<BranchState> met_, waiting_; // crossings
  ResponseDiagram out_;
};

} // namespace

std::optional<ResponseDiagram> follow_through(const Mechanism& mechanism, const std::string& address,
                                              double from, double to, const ResponsePoint& state,
                                              const BranchOptions& options) {
  if ((state.parameter - from) * (state.parameter - to) > 0) return std::nullopt;
  const auto begin = std::chrono::steady_clock::now();
  const Interruptible scope(options.cancel);
  Gathering gathering(mechanism, address, from, to, options);
  try {
    if (!gathering.through(state)) return std::nullopt;
  } catch (const Interrupted&) {
    if (gathering.empty()) throw;
  }
  ResponseDiagram diagram = gathering.take();
  diagram.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return diagram;
}

} // namespace flyball
