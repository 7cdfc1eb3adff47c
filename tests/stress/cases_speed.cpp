// Drives from rest to a million radians a second.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

namespace flyball::stress {

void add_speed_cases(const CaseChoice& choice, Cases& cases) {
  std::vector<double> speeds{0, 1e-6, 1e-3, 1, 3, 10, 30, 100, 1e3, 1e4, 1e5, 1e6};
  if (choice.thinned) speeds = {0, 1e-3, 10, 100, 1e3, 1e6};
  for (const NamedScene& scene : shipped_scenes())
    for (const double speed : speeds) {
      Mechanism m = scene.mechanism;
      each_speed(m, [&](double& x) { x = speed; });
      cases.push_back(solve_case("speed", scene.name + " at " + digits(speed), m, {.must = must_rest(m)}));
    }
  for (const double speed : speeds) {
    for (const double offset : {0., 0.1, -0.1})
      cases.push_back(solve_case("speed", "conical offset " + digits(offset) + " at " + digits(speed),
                                 test::conical(0.5, offset, speed, 0.1), {.must = true}));
    cases.push_back(solve_case("speed", "straight chain of 6 at " + digits(speed),
                               test::hanging_chain(6, speed), {.must = true}));
  }
}

} // namespace flyball::stress
