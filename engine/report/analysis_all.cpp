#include "engine/report/analysis_state.hpp"

#include "engine/linear/largest.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/found_speeds.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/report/kink_message.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/report/verdict.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

// Where the coordinates that are free were looked for.
std::vector<AllSolutions::Bound> bounds_of(const System& system, std::span<const SearchRange> ranges) {
  std::vector<AllSolutions::Bound> out;
  for (std::size_t c = 0; c < system.coordinates.size(); ++c) {
    const CoordinateInfo& info = system.coordinates[c];
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(info.tree_joint)];
    const Link& link = system.links[static_cast<std::size_t>(info.link)];
    if (link.drive >= 0 && !finds_speed(link)) continue;
    out.push_back({joint.name, info.index, coordinate_count(joint.type), info.angle, ranges[c].lower,
                   ranges[c].upper, finds_speed(link)});
  }
  return out;
}

} // namespace

AllSolutions Analysis::solve_all_through(const SolveOptions& options) {
  State& s = *state_;
  const Problem problem = s.prepare(options);
  SearchOptions search;
  search.seconds = options.search_time;
  search.starts = options.search_starts;
  search.progress = options.progress;
  const bool rubs = rubbing_link(s.system, s.parameters) >= 0; // then friction has a part in all there is
  if (rubs) search.starts = 1;
  EquilibriumList list = find_all_equilibria(problem, s.drawn, search, s.steady.elsewhere());
  AllSolutions out;
  out.starts = list.report.starts;
  out.unseen = list.report.unseen;
  out.end = rubs ? SearchEnd::settled : list.report.end;
  out.bounds = bounds_of(s.system, list.report.ranges);
  struct Entry {
    Potential potential;
    Solution solution;
    Eigen::VectorXd q, error; // the error scaled
    std::vector<int> neutral;
    std::string kinks;
  };
  std::vector<Entry> entries;
  std::string unknown; // why what was found is none that is told: nothing determines a speed, or not a digit
  SteadyState steady;
  for (std::size_t i = 0; i < list.states.size() && !problem.cancelled(); ++i) {
    report_progress(options.progress, "classifying what was found",
                    static_cast<double>(i) / static_cast<double>(list.states.size()));
    Found& found = steady.found;
    found = {};
    found.status = Status::converged;
    found.z = list.states[i];
    found.newton = list.outcomes[i];
    found.iterations = list.outcomes[i].iterations;
    const auto begin = std::chrono::steady_clock::now();
    steady.complete(problem);
    if (!steady.holds) {
      out.passing += !rubs;
      continue;
    }
    const bool many = s.system.nv > largest_for_eigenvalues && options.modes == 0;
    const bool by_pivots = pivots_decide(problem);
    const Problem classified = by_pivots ? problem : by_matrices(problem);
    Stability stability = find_stability(steady.factored(classified), !many);
    if (std::string why = undetermined_speed_message(*s.mechanism, s.system, stability.neutral);
        !why.empty()) {
      unknown = std::move(why);
      continue;
    }
    const bool varies = stability.floquet || stability.floquet_failure;
    if (sign_may_change(problem, steady, stability)) leave_verdict_open(steady, stability);
    if (!stability.neutral.empty() && is_pushed_where_soft(steady.factored(classified))) {
      ++out.lost;
      continue;
    }
    // Nearer than their errors two are one: that which is known better.
    const Eigen::VectorXd error = steady.error.solution.cwiseQuotient(s.scaling.column);
    const auto is_same = [&](const Entry& e) {
      const Eigen::VectorXd apart = scaled_difference(problem, e.q, found.z.q).cwiseAbs();
      return e.solution.stable == stability.stable && (apart.array() <= (e.error + error).array()).all();
    };
    if (std::ranges::any_of(entries,
                            [&](const Entry& e) { return is_same(e) && e.error.norm() <= error.norm(); }))
      continue;
    std::erase_if(entries, is_same);
    std::string without_modes;
    if (by_pivots && options.modes > 0 && options.details && !varies)
      without_modes = add_lowest_eigenvalues(problem, found.z, options.modes, steady.elsewhere(), stability);
    if (!varies) keep_asked_for(problem, options.modes, stability);
    // A family along a direction that nothing resists is one entry.
    Potential potential;
    if (s.system.conservative)
      potential =
          amended_potential(s.system, s.parameters, found.z.q, steady.factored(classified).w.kinematics);
    if (!stability.neutral.empty() && std::ranges::any_of(entries, [&](const Entry& e) {
          return e.neutral == stability.neutral && same_potential(e.potential, potential) &&
                 same_pose(problem, e.q, found.z.q, 1e-6, stability.neutral);
        }))
      continue;
    const auto end = std::chrono::steady_clock::now();
    Entry entry{.potential = potential,
                .solution = {},
                .q = found.z.q,
                .error = error,
                .neutral = stability.neutral,
                .kinks = kink_message(s.system, *s.mechanism, stability)};
    entry.solution.status = Status::converged;
    entry.solution.iterations = found.iterations;
    entry.solution.run_time_s = std::chrono::duration<double>(end - begin).count();
    if (options.details) add_condition(problem, steady, entry.solution);
    s.conclude(problem, steady, std::move(stability), without_modes, options, entry.solution);
    if (s.system.conservative) entry.solution.potential = potential.value;
    if (!is_finite(entry.solution)) continue;
    if (std::string why = unknown_coordinate_message(entry.solution.coordinates); !why.empty()) {
      unknown = std::move(why);
      continue;
    }
    entries.push_back(std::move(entry));
  }
  std::ranges::stable_sort(entries, {}, [](const Entry& e) { return e.potential.value; });
  for (Entry& e : entries)
    out.equilibria.push_back(std::move(e.solution));
  if (options.friction && has_friction(*s.mechanism) && !problem.cancelled())
    for (Solution& state : find_friction_states(*s.mechanism, options)) {
      const bool slips = std::ranges::any_of(state.frictions, &FrictionForce::slips);
      if (slips || entries.empty()) out.equilibria.push_back(std::move(state)); // else bands tell of it
    }
  // What stands turned against the drawn pose is looked for where nothing holds as drawn.
  const bool may_turn = !s.system.torques.empty() && !options.nearest;
  if (out.equilibria.empty() && may_turn && !problem.cancelled()) {
    SolveOptions turned = options;
    turned.search = 0; // looked for above
    turned.friction = false;
    Solution solution = solve_through(turned);
    if (solution.status == Status::converged && s.turned) out.equilibria.push_back(std::move(solution));
  }
  out.message = out.equilibria.empty() && !unknown.empty() ? unknown : message(out);
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (!entries[i].kinks.empty()) out.message += " In " + std::to_string(i + 1) + ": " + entries[i].kinks;
  return out;
}

} // namespace flyball
