#include "engine/equilibrium/branches.hpp"

#include "engine/equilibrium/all_equilibria.hpp"
#include "engine/equilibrium/continuation.hpp"
#include "engine/equilibrium/drive_cuts.hpp"
#include "engine/equilibrium/existence.hpp"
#include "engine/equilibrium/find_equilibrium.hpp"
#include "engine/equilibrium/report.hpp"
#include "engine/equilibrium/stability.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

constexpr double special_accuracy = 1e-11; // of the parameter's range

class Follower {
 public:
  Follower(const Mechanism& mechanism, const std::string& address, double from, double to,
           const BranchOptions& options)
      : options_(options), system_(compile_for_drives(start_mechanism(mechanism, address, from), notes_)),
        family_(system_, start_mechanism(mechanism, address, from), address, std::abs(to - from)),
        continuation_(family_), from_(from), to_(to) {}

  ResponseDiagram run() {
    const auto begin = std::chrono::steady_clock::now();
    family_.set(from_);
    const Problem problem = problem_now();
    Eigen::VectorXd start;
    drawn_configuration(system_, problem.parameters, start);
    Found found;
    std::vector<double> history;
    find_equilibrium(problem, start, true, false, w_, history, found);
    Existence existence;
    if (found.status == Status::converged)
      existence = check_existence(problem, found.z.q, sample_phases(system_, problem.parameters), w_);
    const Stability none;
    if (found.status != Status::converged || !existence.holds) {
      out_.status = found.status == Status::converged ? Status::no_steady_state : found.status;
      out_.message = failure_message({family_.mechanism(), problem, found, existence, none}, w_);
    } else {
      out_.status = Status::converged;
      BranchState first{found.z, from_, {}, 0, 0};
      if (continuation_.start(first, to_ > from_ ? 1 : -1))
        follow(std::move(first));
      else
        out_.message = "The start is a singular state; begin beside it.";
      while (options_.switch_branches && !crossings_.empty() && !cancelled() &&
             static_cast<int>(out_.branches.size()) < options_.max_branches) {
        const BranchState at = std::move(crossings_.back());
        crossings_.pop_back();
        branch_off(at);
      }
      if (out_.message.empty())
        out_.message =
            std::to_string(out_.branches.size()) + (out_.branches.size() == 1 ? " branch." : " branches.");
    }
    out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(out_);
  }

 private:
  static Mechanism start_mechanism(const Mechanism& mechanism, const std::string& address, double from) {
    Mechanism m = mechanism;
    set_parameter(m, address, from);
    validate(m);
    return m;
  }

  Problem problem_now() const {
    Problem p = family_.problem();
    return {p.system, p.parameters, p.scaling, options_.cancel};
  }
  bool cancelled() const { return options_.cancel && options_.cancel->load(std::memory_order_relaxed); }

  double position(double parameter) const { return (parameter - from_) / (to_ - from_); }

  struct Described {
    ResponsePoint point;
    int right = 0; // eigenvalues to the right of the axis
    bool damped = false;
  };

  Described describe(const BranchState& state) {
    family_.set(state.parameter);
    const Problem problem = problem_now();
    Described d;
    d.point.parameter = state.parameter;
    const Stability stability = find_stability(problem, state.z, options_.eigenvalues, w_);
    d.point.stable = stability.stable;
    d.point.stability_reason = stability.reason;
    if (stability.eigenvalues) {
      d.point.eigenvalues = *stability.eigenvalues;
      double largest = 0;
      for (const auto& e : d.point.eigenvalues)
        largest = std::max(largest, std::abs(e));
      for (const auto& e : d.point.eigenvalues) {
        if (e.real() > 1e-7 * std::abs(e) + 1e-9 * largest) ++d.right;
        if (e.real() < -1e-7 * std::abs(e) - 1e-9 * largest && e.imag() != 0) d.damped = true;
      }
    }
    Found found;
    found.z = state.z;
    Solution s;
    const Existence existence;
    Eigen::VectorXd error = Eigen::VectorXd::Zero(system_.nv);
    report({family_.mechanism(), problem, found, existence, stability}, error, false, w_, s);
    d.point.coordinates = std::move(s.coordinates);
    return d;
  }

  // The point between two states where `differs` starts to hold, by halving the arclength.
  template <class Differs>
  BranchState locate(const BranchState& from, double length, const BranchState& beyond, Differs differs) {
    double low = 0, high = length;
    BranchState at = beyond, probe;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      int iterations = 0;
      if (!continuation_.step(from, middle, probe, iterations)) break;
      if (differs(probe)) {
        high = middle;
        at = probe;
      } else {
        low = middle;
      }
      if (high - low < special_accuracy) break;
    }
    return at;
  }

  bool known(const BranchState& state, const std::vector<BranchState>& list) const {
    return std::ranges::any_of(list, [&](const BranchState& other) {
      return std::abs(other.parameter - state.parameter) < 1e-6 * family_.scale() &&
             same_pose(family_.problem(), other.z.q, state.z.q, 1e-5);
    });
  }

  void add_special(SpecialPointType type, const BranchState& at, int branch) {
    out_.special.push_back({type, describe(at).point, branch});
  }

  void follow(BranchState state) {
    const int branch = static_cast<int>(out_.branches.size());
    out_.branches.emplace_back();
    double length = options_.largest_step / 4;
    const BranchState origin = state;
    Described now = describe(state);
    out_.branches.back().points.push_back(now.point);
    const auto end = [&](const char* why) { out_.branches[static_cast<std::size_t>(branch)].end = why; };
    for (int i = 1; i < options_.max_points; ++i) {
      if (cancelled()) return end("cancelled");
      BranchState next;
      int iterations = 0;
      const bool stepped = continuation_.step(state, length, next, iterations);
      if (!stepped || next.tangent.dot(state.tangent) < 0.97) {
        length /= 2;
        if (length > 1e-9) continue;
        return end("the corrector fails: the loops lock or a part of the mechanism becomes singular");
      }
      const double p = position(next.parameter);
      if (p > 1 || p < 0) {
        land_on_border(state, p > 1 ? to_ : from_, branch);
        return end(p > 1 ? "the end of the range" : "the beginning of the range");
      }
      const Described then = describe(next);
      find_specials(state, next, length, now, then, branch);
      out_.branches[static_cast<std::size_t>(branch)].points.push_back(then.point);
      if (branch == 0 && options_.progress) options_.progress(p);
      if (i > 5 && std::abs(next.parameter - origin.parameter) < length * family_.scale() &&
          same_pose(family_.problem(), next.z.q, origin.z.q, length) &&
          next.tangent.dot(origin.tangent) > 0.9)
        return end("closed");
      if (out_of_reach(next)) return end("a coordinate leaves all bounds");
      state = std::move(next);
      now = then;
      length = std::min(options_.largest_step, length * (iterations <= 3 ? 1.5 : iterations > 5 ? 0.6 : 1.));
    }
    end("the largest number of points");
  }

  bool out_of_reach(const BranchState& s) const {
    for (const Link& link : system_.links)
      if (link.type == LinkType::prismatic && link.q >= 0 &&
          std::abs(s.z.q[link.q]) > 100 * family_.problem().parameters.length)
        return true;
    return false;
  }

  void land_on_border(const BranchState& state, double border, int branch) {
    BranchState last = state;
    last.parameter = border;
    if (!continuation_.land(last) || !same_pose(family_.problem(), last.z.q, state.z.q, 0.2)) return;
    out_.branches[static_cast<std::size_t>(branch)].points.push_back(describe(last).point);
  }

  void find_specials(const BranchState& state, const BranchState& next, double length, const Described& now,
                     const Described& then, int branch) {
    bool explained = false;
    if (state.turning * next.turning < 0) {
      const double sign = state.turning;
      const BranchState at =
          locate(state, length, next, [&](const BranchState& s) { return s.turning * sign < 0; });
      // At a crossing the tangent can jump; a fold's own balance stays regular.
      add_special(SpecialPointType::fold, at, branch);
      explained = true;
    }
    if (state.determinant * next.determinant < 0) {
      const double sign = state.determinant;
      const BranchState at =
          locate(state, length, next, [&](const BranchState& s) { return s.determinant * sign < 0; });
      if (!known(at, found_)) {
        found_.push_back(at);
        // At the crossing itself the balance has two tangents; this is the branch's own.
        crossings_.push_back(at);
        crossings_.back().tangent = state.tangent;
        add_special(SpecialPointType::branch_point, at, branch);
      }
      explained = true;
    }
    if (!explained && now.right != then.right && options_.eigenvalues) {
      const int before = now.right;
      const BranchState at =
          locate(state, length, next, [&](const BranchState& s) { return describe(s).right != before; });
      add_special(now.damped || then.damped ? SpecialPointType::hopf : SpecialPointType::flutter, at, branch);
    }
  }

  // Both ways off a crossing.
  void branch_off(const BranchState& at) {
    for (double length : {0.01, -0.01}) {
      if (static_cast<int>(out_.branches.size()) >= options_.max_branches) return;
      BranchState first;
      if (!continuation_.switch_branch(at, length, first)) continue;
      if (position(first.parameter) < 0 || position(first.parameter) > 1) continue;
      follow_from_crossing(at, std::move(first));
    }
  }

  void follow_from_crossing(const BranchState& at, BranchState first) {
    const std::size_t branch = out_.branches.size();
    follow(std::move(first));
    auto& points = out_.branches[branch].points;
    points.insert(points.begin(), describe(at).point);
  }

  BranchOptions options_;
  std::vector<std::string> notes_;
  System system_;
  Family family_;
  Continuation continuation_;
  double from_, to_;
  Workspace w_;
  std::vector<BranchState> crossings_, found_;
  ResponseDiagram out_;
};

} // namespace

std::string_view word(SpecialPointType type) {
  switch (type) {
  case SpecialPointType::fold: return "fold";
  case SpecialPointType::branch_point: return "branch_point";
  case SpecialPointType::hopf: return "hopf";
  case SpecialPointType::flutter: return "flutter";
  }
  return "";
}

ResponseDiagram follow_branches(const Mechanism& mechanism, const std::string& address, double from,
                                double to, const BranchOptions& options) {
  return Follower(mechanism, address, from, to, options).run();
}

} // namespace flyball
