// The shipped scenes as they are, and from starts anywhere in their range.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

namespace flyball::stress {

void add_scene_cases(const CaseChoice&, Cases& cases) {
  for (const NamedScene& scene : shipped_scenes()) {
    cases.push_back(solve_case("scenes", scene.name, scene.mechanism, {.must = true}));
    SolveOptions nearest;
    nearest.nearest = true;
    cases.push_back(solve_case("scenes", scene.name + " nearest", scene.mechanism, {.must = true}, nearest));
  }
}

void add_far_start_cases(const CaseChoice& choice, Cases& cases) {
  for (const NamedScene& scene : shipped_scenes()) {
    const Analysis analysis(scene.mechanism);
    // Where the governor's arm ends at a dead centre, and two rows once cancelled in the estimate.
    for (const int seed : seeds(2 * choice.seeds, {61})) {
      Dice dice(static_cast<std::uint32_t>(100 + seed));
      SolveOptions options;
      options.start = random_start(analysis, scene.mechanism, dice);
      options.nearest = seed % 4 == 3;
      const bool must = !options.nearest && must_rest(scene.mechanism);
      cases.push_back(solve_case(
          "far starts", scene.name + (options.nearest ? " nearest" : "") + " seed " + std::to_string(seed),
          scene.mechanism, {.must = must}, options));
    }
  }
}

} // namespace flyball::stress
