// Damping from none to overdamped: it moves no steady state in which parts stand still against each other.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

namespace flyball::stress {

void add_damping_cases(const CaseChoice& choice, Cases& cases) {
  std::vector<double> factors{0, 1e-12, 1e-6, 1e-3, 1e3, 1e6, 1e12};
  if (choice.thinned) factors = {0, 1e-6, 1e12};
  for (const NamedScene& scene : shipped_scenes()) {
    const Mechanism& of = scene.mechanism;
    if (!has_dampers(of) || (finds_speeds(of) && !has_springs(of))) continue; // there they decide the speed
    for (const double factor : factors) {
      Mechanism m = scene.mechanism;
      each_damping(m, [&](double& x) { x *= factor; });
      cases.push_back(solve_case("damping", scene.name + " " + digits(factor) + " times", m, {.must = true}));
    }
  }
}

} // namespace flyball::stress
