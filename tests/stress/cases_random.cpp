// Random mechanisms of all types with every kind of number extreme at once.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/mechanisms.hpp"

namespace flyball::stress {

void add_random_cases(const CaseChoice& choice, Cases& cases) {
  // Estimates once fell short here: by axes not quite of unit length, by loops far away, by a metric that
  // held a soft direction, along one that double precision hardly tells from none, and along one that bends.
  for (const int i : seeds(12 * choice.seeds, {37, 89, 165, 414, 671})) {
    const auto seed = static_cast<std::uint32_t>(9000 + i);
    reference::RandomOptions options;
    options.loops = i % 3;
    options.drives = i % 2 == 0 ? reference::RandomDrives::root : reference::RandomDrives::none;
    options.conservative = i % 4 < 2;
    options.spring_share = 1;
    Mechanism m = reference::random_mechanism(seed, options);
    // How wild: from a few decades to all of them.
    const double wild = (i % 4 + 1) / 4.;
    Dice dice(seed);
    m = test::resized(m, dice.decade(-6 * wild, 6 * wild));
    for (Body& b : m.bodies) {
      const double factor = dice.decade(-12 * wild, 12 * wild);
      b.mass *= factor;
      for (double& x : b.inertia)
        x *= factor;
    }
    each_stiffness(m, [&](double& x) { x = dice.decade(-9 * wild, 15 * wild); });
    each_damping(m, [&](double& x) { x *= dice.decade(-6 * wild, 6 * wild); });
    each_speed(m, [&](double& x) { x = std::copysign(dice.decade(-3 * wild, 6 * wild), x); });
    cases.push_back(
        solve_case("random", "seed " + std::to_string(seed) + " over " + digits(24 * wild) + " decades", m));
  }
}

} // namespace flyball::stress
