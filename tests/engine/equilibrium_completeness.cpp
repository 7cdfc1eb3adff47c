// How much of what there is the search for all equilibria finds: measured against a search a hundred times as
// long from other starts. Takes minutes: equilibrium_tests "[completeness]" prints the table that
// tests/stress/README.md keeps.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/search/all_equilibria.hpp"
#include "engine/solve/drive_cuts.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

struct Group {
  std::string name;
  std::vector<Mechanism> mechanisms;
};

struct Compiled {
  explicit Compiled(const Mechanism& m) : system(compile_for_drives(m)) {
    bind(system, m, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, drawn);
  }
  Problem problem() const { return {system, parameters, scaling}; }

  System system;
  Parameters parameters;
  Scaling scaling;
  Eigen::VectorXd drawn;
};

double seconds_of(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Equilibria of `other` that `list` lacks.
int missing(const Problem& problem, const EquilibriumList& list, const EquilibriumList& other) {
  return static_cast<int>(std::ranges::count_if(other.states, [&](const Unknowns& z) {
    return std::ranges::none_of(
        list.states, [&](const Unknowns& known) { return same_but_for_turns(problem, known.q, z.q, 1e-4); });
  }));
}

// Mechanisms with a family of equilibria have no list to be complete.
bool has_family(const Problem& problem, const EquilibriumList& list, Workspace& w) {
  return std::ranges::any_of(list.states, [&](const Unknowns& z) {
    evaluate(problem, z, 0, w);
    factor(problem, z, w);
    return w.kkt(problem).singular();
  });
}

std::vector<Group> groups() {
  std::vector<Group> out;
  out.push_back({"cases kept", {}});
  for (const char* name : {"triple_pendulum_turning", "soft_spirals", "soft_spirals_of_two"})
    out.back().mechanisms.push_back(stored_case(name));
  out.push_back({"shipped scenes", {}});
  for (const char* name : {"governor", "pendulum", "watt_governor", "fourbar_turntable", "rate_gyro",
                           "conical_pendulum", "governor_bearing"})
    out.back().mechanisms.push_back(shipped(name));
  for (const int links : {2, 3, 4}) {
    out.push_back({"turning chain of " + std::to_string(links), {}});
    for (const double speed : {6., 12., 25.})
      out.back().mechanisms.push_back(hanging_chain(links, speed));
  }
  const auto random = [&](const std::string& name, int count, ref::RandomOptions options,
                          std::uint32_t seed) {
    Group group{name, {}};
    options.massless = options.stops = false;
    for (int i = 0; i < count; ++i)
      group.mechanisms.push_back(ref::random_mechanism(seed + static_cast<std::uint32_t>(i), options));
    out.push_back(std::move(group));
  };
  ref::RandomOptions revolute;
  revolute.tree_types = {JointType::revolute};
  revolute.spring_share = 0;
  for (const int bodies : {3, 4, 5, 7}) {
    revolute.bodies = bodies;
    random("random tree of " + std::to_string(bodies - 1) + " hinges", bodies < 7 ? 6 : 3, revolute,
           100 * static_cast<std::uint32_t>(bodies));
  }
  revolute.spring_share = 1;
  revolute.bodies = 4;
  random("random tree of 3 sprung hinges", 6, revolute, 1000);
  ref::RandomOptions any;
  any.bodies = 3;
  any.spring_share = 1;
  random("random tree of 2 joints of any type", 6, any, 2000);
  ref::RandomOptions plane;
  plane.parallel_axes = true;
  plane.tree_types = {JointType::revolute};
  plane.loop_types = {JointType::revolute, JointType::distance};
  plane.bodies = 5;
  plane.loops = 1;
  random("random plane loop of 5 bodies", 6, plane, 3000);
  return out;
}

} // namespace

TEST_CASE("completeness of the search for all equilibria", "[.][completeness]") {
  const char* only = std::getenv("FLYBALL_GROUP");
  const char* scale = std::getenv("FLYBALL_TIMES");
  const double times = scale ? std::atof(scale) : 100;
  std::printf(
      "| mechanisms | of them | coordinates | equilibria | found | share | starts (median) | longest |\n"
      "|---|---|---|---|---|---|---|---|\n");
  int all_known = 0, all_found = 0;
  for (const Group& group : groups()) {
    if (only && group.name.find(only) == std::string::npos) continue;
    int count = 0, known = 0, found = 0, coordinates = 0;
    double longest = 0;
    std::vector<int> starts;
    std::string detail;
    for (const Mechanism& m : group.mechanisms) {
      const Compiled c(m);
      const Problem problem = c.problem();
      Workspace w;
      EquilibriumList list, more;
      const double taken = seconds_of([&] { list = find_all_equilibria(problem, c.drawn, {}, w); });
      if (problem.system.nv == 0 || list.states.empty() || has_family(problem, list, w)) continue;
      SearchOptions longer;
      longer.seconds = 1e6;
      longer.unseen = 0;
      longer.seed = 7;
      longer.starts = static_cast<int>(times) * std::max(list.report.starts, 1);
      more = find_all_equilibria(problem, c.drawn, longer, w);
      const int lacks = missing(problem, list, more);
      const int unknown = missing(problem, more, list);
      const int here = static_cast<int>(list.states.size());
      detail += "    " + m.name + ": " + std::to_string(here) + " of " + std::to_string(here + lacks) +
                (unknown > 0 ? ", the long one lacks " + std::to_string(unknown) : "") + ", " +
                std::string(word(list.report.end)) + ", " + std::to_string(list.report.starts) + " starts, " +
                std::to_string(taken) + " s\n";
      ++count;
      known += here + lacks;
      found += here;
      coordinates = std::max(coordinates, problem.system.nv);
      longest = std::max(longest, taken);
      starts.push_back(list.report.starts);
    }
    if (count == 0) continue;
    std::ranges::sort(starts);
    std::printf("| %s | %d | %d | %d | %d | %.2f %% | %d | %.2f s |\n", group.name.c_str(), count,
                coordinates, known, found, 100. * found / known, starts[starts.size() / 2], longest);
    if (std::getenv("FLYBALL_DETAIL")) std::printf("%s", detail.c_str());
    std::fflush(stdout);
    all_known += known;
    all_found += found;
  }
  std::printf("| together | | | %d | %d | %.2f %% | | |\n", all_known, all_found,
              100. * all_found / std::max(1, all_known));
  CHECK(all_found >= 0.98 * all_known);
}
