// Masses from 1e-12 to 1e12, side by side in one mechanism.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

namespace flyball::stress {
namespace {

// Bodies light and heavy by turns.
Mechanism uneven(Mechanism m, double even, double odd) {
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    const double factor = i % 2 == 0 ? even : odd;
    m.bodies[i].mass *= factor;
    for (double& x : m.bodies[i].inertia)
      x *= factor;
  }
  return m;
}

} // namespace

void add_mass_cases(const CaseChoice& choice, Cases& cases) {
  const std::vector<double> few = decades(-12, 12, 4, choice.thinned);
  for (const NamedScene& scene : shipped_scenes())
    for (const double even : few)
      for (const double odd : few) {
        if (even != 1 && odd != 1 && even * odd != 1) continue;
        if (choice.thinned && even == 1 && odd == 1) continue; // a case of the scenes
        // It sinks by 2e9 m, five billion times its reach: there the last digit of its place times its weight
        // is 1500 times the stiffness against its tilt, and the matrix that steps and estimates rest on is
        // rounding.
        if (scene.name == "rotor_oil_whip" && odd == 1e12) continue;
        cases.push_back(solve_case("mass", scene.name + " " + digits(even) + " beside " + digits(odd),
                                   uneven(scene.mechanism, even, odd), {.must = must_rest(scene.mechanism)}));
      }
  for (const double even : few)
    for (const double odd : few) {
      Mechanism m = uneven(test::hanging_chain(4, 4), even, odd);
      m.joints[1] = test::sprung(m.joints[1], 2, 0.4);
      cases.push_back(
          solve_case("mass", "chain " + digits(even) + " beside " + digits(odd), m, {.must = true}));
    }
}

} // namespace flyball::stress
