// Studies of mechanisms whose coordinates are all driven, or that have none.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/sweep.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE("studies of a mechanism without free coordinates answer, or say why not", "[nothing_free]") {
  for (const double string : {std::hypot(0.1, 0.2), 0.5}) {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {spindle(), body("arm", 1, {0.2, 0, 0})};
    m.joints = {spin(5), joint(JointType::fixed, "weld", "spindle", "arm", {0.1, 0, 0}),
                distance("string", "spindle", "arm", {0, 0.1, 0}, {0.2, 0, 0}, string)};
    const bool closed = string < 0.4;
    const Variation speed{"joints.spin.drive.speed", 0, 10, 5};
    for (const SweepPoint& p : sweep(m, {&speed, 1}, 1)) {
      CHECK((p.solution.status == Status::converged) == closed);
      CHECK_FALSE(p.solution.message.empty());
    }
    CHECK_THROWS_AS(design(m, "joints.spin.drive.speed", 0, 10, "spin", 1), SceneError);
    CompareOptions options;
    options.repeats = 1;
    options.durations = {0.01};
    options.tolerances = {1e-4};
    const Comparison c = compare(m, options);
    CHECK((c.status == Status::converged) == closed);
    CHECK_FALSE(c.message.empty());
  }
}
